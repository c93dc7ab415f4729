"""Numbers by their key, and errors that name the key that is missing."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from softdepth.rig.camera import Matrix
from softdepth.spec.errors import InputError


def text(path: Path) -> str:
    """A calibration file's text; raises `InputError` if there is none."""
    try:
        return path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "it is not text"
        raise InputError(f"'{path}' cannot be read: {reason}", "name a calibration file") from error


def parse_yaml(path: Path) -> dict[str, Any]:
    """A YAML file that holds keys and values; raises `InputError` for any other."""
    import yaml

    try:
        found = yaml.safe_load(text(path))
    except yaml.YAMLError as error:
        raise InputError(f"'{path}' is not YAML: {error}", "name a calibration file") from error
    if not isinstance(found, dict):
        raise InputError(f"'{path}' holds no keys", "name a calibration file")
    return found


def value(found: Mapping[str, Any], key: str, path: Path) -> Any:
    """The value of `key`, whose parts dots separate; raises `InputError` that names a missing one."""
    inner: Any = found
    for part in key.split("."):
        if not isinstance(inner, Mapping) or part not in inner:
            raise InputError(f"'{path}' has no key '{key}'", "give a whole calibration")
        inner = inner[part]
    return inner


def numbers(found: Mapping[str, Any], key: str, path: Path, shape: tuple[int, ...]) -> Matrix:
    """The value of `key` as float64 of a shape (-1: any length); raises `InputError` if it is none."""
    given = value(found, key, path)
    try:
        array = np.array(given, np.float64).reshape(shape)
    except (TypeError, ValueError) as error:
        size = " x ".join("N" if side < 0 else str(side) for side in shape)
        raise InputError(f"'{key}' in '{path}' is not {size} numbers", "check that key") from error
    if not np.isfinite(array).all():
        raise InputError(f"'{key}' in '{path}' holds a number that is not finite", "check that key")
    return array


def lines(path: Path, separator: str) -> dict[str, str]:
    """``key SEPARATOR value`` lines as a mapping."""
    pairs = (line.partition(separator) for line in text(path).splitlines())
    return {key.strip(): rest.strip() for key, found, rest in pairs if found}


def floats(found: Mapping[str, str], key: str, path: Path, shape: tuple[int, ...]) -> Matrix:
    """`numbers` of a value that is text: blanks, commas, semicolons and brackets separate."""
    words = str(value(found, key, path)).translate(str.maketrans("[],;", "    ")).split()
    try:
        parsed = [float(word) for word in words]
    except ValueError as error:
        raise InputError(f"'{key}' in '{path}' is '{found[key]}'", "give numbers there") from error
    return numbers({key: parsed}, key, path, shape)
