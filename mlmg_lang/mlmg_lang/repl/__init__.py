"""The interactive session: lines in, replies out; and the faces that it has on a terminal and elsewhere."""
