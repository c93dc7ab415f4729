"""Frames in, the columns that lanes compare out."""
