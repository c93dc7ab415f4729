"""What a map is worth: metrics and pictures."""
