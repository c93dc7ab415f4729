"""Winners of both views, and what is wanted of the candidates around the left one."""
