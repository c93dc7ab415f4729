"""Winners of both views, and the costs around the left one."""
