"""Images, ground truth and data sets, in and out."""
