"""Motion Script: from the text of a script to a plan, and to the motion played by it."""
