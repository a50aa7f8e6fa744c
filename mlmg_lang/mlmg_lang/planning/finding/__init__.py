"""The rules that say which graphs and motions an expression stands for: one a file, in the order of `table`."""
