"""From a configuration to a bitstream, with open tools: synthesis, place and route, packing."""
