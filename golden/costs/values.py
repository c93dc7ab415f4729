"""What criteria are made of."""

import numpy as np
from numpy.typing import NDArray

Values = NDArray[np.int32]
"""One criterion of one candidate: a number a pixel."""
