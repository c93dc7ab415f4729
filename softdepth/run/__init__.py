"""Running pairs through gateware and models, and what is written about it."""
