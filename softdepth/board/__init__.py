"""The host's end of a board's serial port."""
