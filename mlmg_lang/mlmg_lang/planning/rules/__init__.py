"""The rules that say what of the motions that a command finds it can take: one a file, in the order of `table`."""
