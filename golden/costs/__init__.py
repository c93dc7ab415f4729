"""Criteria, then one cost a candidate."""
