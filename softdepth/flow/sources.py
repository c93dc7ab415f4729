"""What a netlist depends on in the project itself, as a hash: results of older sources are told apart."""

import hashlib
from pathlib import Path

import softdepth.hdl

PACKAGE = Path(__file__).resolve().parents[1]
HDL = Path(next(iter(softdepth.hdl.__path__)))
PROJECT = PACKAGE.parent

FILES = (
    "config.py",
    "criteria.py",
    "presets.py",
    "rules.py",
    "settings.py",
    "soft.py",
    "boards.py",
    "protocol.py",
    "validity.py",
    "errors.py",
    "flow",
)


def sources_hash(*further: Path) -> str:
    """Twenty hex digits that change with every source of the gateware and the flow, and `further` files."""
    digest = hashlib.sha256()
    for place in (HDL, *(PACKAGE / name for name in FILES), *further):
        for file in sorted(place.rglob("*.py")) if place.is_dir() else [place]:
            digest.update(str(file.relative_to(place.parent)).encode() + b"\0" + file.read_bytes())
    return digest.hexdigest()[:20]
