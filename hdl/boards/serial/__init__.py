"""Packets over a serial line: UART, framing and checksum."""
