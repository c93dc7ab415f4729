"""A core for other people's flows: one Verilog file that says how to use it, and the same as JSON."""
