"""Sequences of stereo pairs: where they come from, their work in processes, and what is written of them."""
