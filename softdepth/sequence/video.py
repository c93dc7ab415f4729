"""Videos, read and written with OpenCV's FFmpeg."""

import math
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from softdepth.files import write_atomically
from softdepth.golden.data.decode import quiet
from softdepth.spec.errors import InputError

SUFFIX = ".webm"
CODEC = "VP80"
"""VP8: the codec in OpenCV's wheels that browsers play too."""


@dataclass(frozen=True)
class Video:
    """A video file.

    Members
    -------
    path : the file.
    rate : frames a second, or None where it does not say.
    expected : frames, as its head says: an estimate in some formats.
    """

    path: Path
    rate: float | None
    expected: int

    @classmethod
    def opened(cls, path: Path) -> "Video":
        """A video that can be read; raises `InputError` if OpenCV cannot."""
        capture = _capture(path)
        rate, count = capture.get(cv2.CAP_PROP_FPS), capture.get(cv2.CAP_PROP_FRAME_COUNT)
        capture.release()
        usable = math.isfinite(rate) and 0 < rate <= 1000
        return cls(path, rate if usable else None, max(int(count), 0) if math.isfinite(count) else 0)

    def read(self) -> Iterator[np.ndarray]:
        """Its frames as RGB, H x W x 3 uint8, not turned: that would undo the rectification."""
        capture = _capture(self.path)
        capture.set(cv2.CAP_PROP_ORIENTATION_AUTO, 0)
        try:
            while True:
                with quiet():
                    good, frame = capture.read()
                if not good:
                    return
                yield cv2.cvtColor(frame, cv2.COLOR_BGR2RGB)
        finally:
            capture.release()


def write(path: Path, pictures: Iterable[np.ndarray], rate: float) -> None:
    """Write RGB pictures of one size (H x W x 3 uint8) as a video, complete or not at all.

    An odd size loses its last row or column, which the codec cannot hold. Raises `InputError` for a place
    that cannot be written.
    """
    with tempfile.TemporaryDirectory(prefix="softdepth-video-") as name:
        made = Path(name) / f"video{SUFFIX}"
        writer: cv2.VideoWriter | None = None
        try:
            for picture in pictures:
                height, width = (length - length % 2 for length in picture.shape[:2])
                with quiet():
                    if writer is None:
                        code = cv2.VideoWriter.fourcc(*CODEC)
                        writer = cv2.VideoWriter(str(made), cv2.CAP_FFMPEG, code, rate, (width, height))
                    writer.write(cv2.cvtColor(picture[:height, :width], cv2.COLOR_RGB2BGR))
        finally:
            if writer is not None:
                with quiet():
                    writer.release()
        with suppress(FileNotFoundError):
            write_atomically(path, made.read_bytes())
            return
    raise InputError(
        f"this OpenCV cannot write '{path.name}'", "install the opencv wheel that the lock names"
    )


def _capture(path: Path) -> cv2.VideoCapture:
    with quiet():
        capture = cv2.VideoCapture(str(path), cv2.CAP_FFMPEG)
    if not capture.isOpened():
        capture.release()
        raise InputError(
            f"'{path}' is not a video that OpenCV can open",
            "convert it, for example: ffmpeg -i FILE video.mp4",
        )
    return capture
