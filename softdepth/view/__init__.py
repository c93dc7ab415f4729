"""A page to look at a result with."""
