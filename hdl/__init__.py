"""Amaranth gateware: a stereo pair streams in, one disparity per pixel streams out."""
