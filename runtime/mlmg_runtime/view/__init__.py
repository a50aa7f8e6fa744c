"""Looking at motions: a figure made of capsules, in an HTML player, a strip of stills or a small movie."""
