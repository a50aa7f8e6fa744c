"""Scripts in their one canonical form (docs/formatting.md says what it is)."""
