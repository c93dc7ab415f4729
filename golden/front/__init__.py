"""Pairs, views and borders."""
