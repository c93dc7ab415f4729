"""The best of all candidates."""
