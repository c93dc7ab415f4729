"""The subcommands. They import what is heavy (OpenCV, Amaranth) only when they run."""
