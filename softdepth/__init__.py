"""softdepth: a fuzzy stereo-depth core for FPGAs, with its models, tests and tools."""
