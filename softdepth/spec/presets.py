"""Configurations by name."""

from typing import Any

PRESETS: dict[str, dict[str, Any]] = {
    "paper": {"stored_rows": 2},
    # The rules of the cell, in the corrected table: for MEAN, a fifth of the logic of all 27.
    "compact": {"firing": "cell", "rules": "corrected", "stored_rows": 2},
    # 3x3 sums are small: labels at 2**9 fit them better than the paper's, and 5 bits are then enough.
    "lite": {
        "firing": "cell",
        "rules": "corrected",
        "membership_bits": 5,
        "stored_rows": 2,
        "criteria": [{"window": 3, "dx": dx, "label_bits": 9} for dx in (-2, 0, 2)],
    },
    "sad": {"cost": "sad", "criteria": [{"window": 3}], "stored_rows": 2},
}
"""What each preset changes in the defaults: the paper's nest, the same in less logic, a small
core, and the plain baseline."""
