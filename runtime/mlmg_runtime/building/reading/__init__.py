"""From a library's TOML file to its configuration; every value that is taken is checked."""
