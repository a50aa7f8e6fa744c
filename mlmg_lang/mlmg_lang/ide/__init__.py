"""What an editor and a conversation ask of a text: plain data, from what is known of it and a place in it."""
