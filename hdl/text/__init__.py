"""The gateware as text, for other tools: RTLIL, and what is done to it and to the Verilog made of it."""
