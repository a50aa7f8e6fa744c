"""The definition of Motion Script's syntax."""
