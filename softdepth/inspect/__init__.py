"""What is wrong with a pair: measured on a reduced copy, judged, and said with figure and remedy."""
