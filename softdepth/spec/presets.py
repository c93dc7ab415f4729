"""Configurations by name."""

from typing import Any

_ROBUST = {
    "check": True,
    "island": 8,
    "fraction_bits": 4,
    "fill": True,
    "median": 5,
    "masked_median": 9,
    "confidence": True,
}

_NEST = [{"window": 3}, {"window": 5}, {"window": 7, "stored_rows": 2}]
_ROW = [{"window": 3, "dx": dx, "label_bits": 9} for dx in (-2, 0, 2)]
_ROW[0]["stored_rows"] = 2  # all three share one column

PRESETS: dict[str, dict[str, Any]] = {
    "paper": {"criteria": _NEST},
    # The rules of the cell, in the corrected table: for MEAN, a fifth of the logic of all 27.
    "compact": {"firing": "cell", "rules": "corrected", "criteria": _NEST},
    # 3x3 sums are small: labels at 2**9 fit them better than the paper's, and 5 bits are then enough.
    "lite": {
        "firing": "cell",
        "rules": "corrected",
        "membership_bits": 5,
        "criteria": _ROW,
    },
    "sad": {"cost": "sum", "criteria": [{"window": 3, "stored_rows": 2}]},
    # Ground-truth accuracy on scenes that nobody tuned on, at other light: docs/accuracy.md.
    "robust": {
        "cost": "sum",
        "lanes": 32,
        "criteria": [{"kind": "census"}, {"kind": "gradient"}],
        "post": _ROBUST,
    },
    "robust-gray": {
        "pixel": "gray8",
        "cost": "sum",
        "lanes": 32,
        "criteria": [{"kind": "census", "like": 20}, {"kind": "gradient"}],
        "post": {**_ROBUST, "like": 16},
    },
    # A gradient alone and few rows of everything, as small parts have little memory.
    "robust-small": {
        "cost": "sum",
        "criteria": [{"kind": "gradient", "rows": 7, "columns": 13, "running_sums": False}],
        "post": {
            **_ROBUST,
            "island_rows": 3,
            "island_columns": 9,
            "median": 0,
            "masked_median": 12,
            "masked_spacing": 2,
            "masked_rows": 7,
            "colour_bits": 5,
        },
    },
}
"""What each preset changes in the defaults: the paper's nest, the same in less logic, a small
core, the plain baseline; and what holds on other scenes, in colour, gray, and small."""
