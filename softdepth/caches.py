"""Where the libraries keep what they prepared, on a machine whose home cannot be written."""

import atexit
import os
import shutil
import sys
import tempfile
from pathlib import Path

import platformdirs

VARIABLES = {"XDG_CACHE_HOME": "", "YOWASP_CACHE_DIR": "yowasp", "MPLCONFIGDIR": "matplotlib"}
"""What tells the libraries their places: wasmtime's (and ours), the FPGA tools', matplotlib's."""


def settle() -> None:
    """Give the libraries' caches a place that can be written, where the user's own cannot.

    That is ``$SOFTDEPTH_CACHE``, or else a temporary folder, which costs the time to prepare everything
    again and is told in a line. What is set in the environment stays as it is.
    """
    if may_write(Path(platformdirs.user_cache_dir())) and may_write(Path(platformdirs.user_config_dir())):
        return
    named = os.environ.get("SOFTDEPTH_CACHE")
    if named and may_write(Path(named)):
        place = named
    else:
        place = tempfile.mkdtemp(prefix="softdepth-cache-")
        atexit.register(shutil.rmtree, place, ignore_errors=True)
        if not named:
            print(
                f"note: '{platformdirs.user_cache_dir()}' cannot be written, so that nothing is kept for the"
                " next run; set SOFTDEPTH_CACHE to a folder you may write to",
                file=sys.stderr,
            )
    for variable, folder in VARIABLES.items():
        os.environ.setdefault(variable, str(Path(place, folder)))


def may_write(folder: Path) -> bool:
    """Whether a folder, or the one it would be created in, can be written."""
    try:
        while not folder.exists():
            folder = folder.parent
        return folder.is_dir() and os.access(folder, os.W_OK | os.X_OK)
    except OSError:
        return False
