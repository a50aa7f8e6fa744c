"""A conversation with a character, without a terminal: what was asked of it, what it did, where it is now."""
