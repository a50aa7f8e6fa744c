"""The face on a terminal: a prompt with colours, completion, history and a line that tells what is playing."""
