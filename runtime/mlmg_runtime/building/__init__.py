"""Building a library, offline: clips and a configuration become motion graphs in a database."""
