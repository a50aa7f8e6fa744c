"""Playing, online: positions in motion graphs become a timeline, and the timeline becomes frames."""
