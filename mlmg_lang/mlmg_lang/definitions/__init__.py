"""Definitions: where they come from, and what stands where one is used."""
