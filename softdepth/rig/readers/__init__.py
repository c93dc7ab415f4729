"""Calibrations as the field's tools write them, one reader each."""
