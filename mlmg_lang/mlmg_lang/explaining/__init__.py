"""What a script will do and why: an analysis -> an explanation, as data; and that as text, JSON or a picture."""
