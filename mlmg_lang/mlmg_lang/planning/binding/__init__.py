"""What the names of an expression mean in a library and a script; what is wrong with those that mean nothing."""
