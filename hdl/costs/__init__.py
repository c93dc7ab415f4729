"""Lanes: criteria, then one cost a candidate."""
