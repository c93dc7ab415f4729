"""Depth in metres: which results count, and the files that hold it."""
