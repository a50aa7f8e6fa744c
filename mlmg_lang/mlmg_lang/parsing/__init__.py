"""Text -> tokens -> the syntax tree, and what is wrong with a script whatever the library."""
