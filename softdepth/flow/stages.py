"""Which stage of a build runs, and how long each took this time and last time."""

import json
import time
from collections.abc import Iterator
from contextlib import contextmanager

from softdepth import screen
from softdepth.files import cache_folder


class Stages:
    """Announces the stages of a build on standard error, and keeps their seconds for the next time.

    Parameters
    ----------
    what : names the build; stages are compared with those of the last build of this name.

    Members
    -------
    seconds : wall-clock time of each finished stage.
    """

    def __init__(self, what: str) -> None:
        self._what = what
        self._path = cache_folder() / "flow" / "seconds.json"
        self.seconds: dict[str, float] = {}

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Run the body as the stage called `name`. A stage that fails leaves no time."""
        last = self._known().get(self._what, {}).get(name)
        expected = "" if last is None else f" (last time {last:.0f} s)"
        screen.note(f"{self._what}: {name}{expected} ...")
        start = time.monotonic()
        yield
        self.seconds[name] = round(time.monotonic() - start, 1)
        self._remember(name)

    def _known(self) -> dict[str, dict[str, float]]:
        try:
            return json.loads(self._path.read_text())
        except (OSError, ValueError):
            return {}  # nothing was built yet; a lost file costs a line's end, no more

    def _remember(self, name: str) -> None:
        known = self._known()
        known.setdefault(self._what, {})[name] = self.seconds[name]
        try:
            self._path.parent.mkdir(parents=True, exist_ok=True)
            self._path.write_text(json.dumps(known, indent=1))
        except OSError:
            return  # a cache that cannot be written must not stop a build
