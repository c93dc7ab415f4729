"""How far the hardware is from the float model, and which number formats are enough."""
