"""Stages between result streams: checks, filling and filters."""
