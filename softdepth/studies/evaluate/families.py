"""Which data set a scene belongs to, by its name: the groups of the tables."""

import re

_FAMILIES = {
    "Middlebury 2001": r"barn[12]|bull|map|poster|sawtooth|tsukuba|venus",
    "Middlebury 2003": r"teddy|cones",
    "Middlebury 2005": r"art|books|computer|dolls|drumsticks|dwarves|laundry|moebius|reindeer",
    "Middlebury 2006": r"aloe|baby\d|bowling\d|cloth\d|flowerpots|lampshade\d|midd\d|monopoly|plastic|rocks\d"
    r"|wood\d",
    "Middlebury v3": r"q[A-Z]\w*",
    "ETH3D": r"eth_?\w+",
    "KITTI": r"kitti\w*",
}

OTHER = "other"

EIGHTHS = "Middlebury 2001"
"""The family whose gray truth has 8 levels a pixel."""
LEVELS = 8


def family(name: str) -> str:
    """The data set that a scene's folder name belongs to, or `OTHER`."""
    for title, pattern in _FAMILIES.items():
        if re.fullmatch(pattern, name):
            return title
    return OTHER
