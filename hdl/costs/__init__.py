"""Lanes: criteria, then one cost per candidate."""
