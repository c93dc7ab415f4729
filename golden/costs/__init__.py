"""Criteria, then one cost per candidate."""
