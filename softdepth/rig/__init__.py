"""The two cameras: their geometry, and the calibrations that it is read from."""
