"""Images extended beyond their edges by repeating the edge pixels."""

from typing import Any

import numpy as np
from numpy.typing import NDArray


def replicated(plane: NDArray[Any], rows: int, columns: int) -> NDArray[Any]:
    """`plane` with `rows` more above and below, and `columns` more left and right: those at its edge."""
    return np.pad(plane, ((rows, rows), (columns, columns)), mode="edge")
