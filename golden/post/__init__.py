"""Checks, filling and filters of a frame's winners."""
