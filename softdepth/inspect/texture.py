"""How much of an image has nothing that a matcher could hold on to."""

import cv2
import numpy as np

AROUND = 9
"""Pixels a side of the window that has texture or none."""
LEAST = 1.5
"""Root mean square of the change along a row, in gray levels a pixel, that counts as texture: above the noise
of a daylight picture, below a visible pattern."""


def bare(view: np.ndarray) -> float:
    """Share of a gray view (uint8 H x W) whose rows hardly change: a matcher searches along them."""
    if view.shape[1] < 3:
        return 1.0
    values = view.astype(np.float32)
    change = cv2.Sobel(values, cv2.CV_32F, 1, 0, ksize=1, scale=0.5)
    return float((cv2.blur(change * change, (AROUND, AROUND)) < LEAST**2).mean())
