"""Delays and memories that map well to block RAM."""
