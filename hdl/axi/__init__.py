"""The core for use in other designs: AXI4-Stream Video in and out, and registers on a bus."""
