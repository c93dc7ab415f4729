"""Pipelined arithmetic that keeps its widths and time."""
