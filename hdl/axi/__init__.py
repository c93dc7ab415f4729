"""The core as others build it in: AXI4-Stream Video in and out, and registers on a bus."""
