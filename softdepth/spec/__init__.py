"""What decides a result: the one configuration, and all that is derived from it."""
