"""The syntax tree -> the typed plan -> the resolved plan: what a script means in a library."""
