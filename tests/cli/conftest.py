"""A pair on disk, and the command line as a function."""

import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Self

import cv2
import numpy as np
import pytest

from softdepth.cli.app import main
from softdepth.golden.data.pair import StereoPair
from softdepth.golden.data.synthetic import generate
from softdepth.golden.data.writers import write_pfm, write_picture
from tests.cli.recording import record
from tests.support.images import read_image


@dataclass(frozen=True)
class Outcome:
    """What a command left behind: exit code and both streams."""

    code: int
    out: str
    err: str

    @property
    def error(self) -> str:
        """The one line that tells the user; fails where there is more or less than one, or no remedy."""
        lines = [line for line in self.err.splitlines() if line.startswith("error: ")]
        assert len(lines) == 1, self.err
        assert "; " in lines[0], f"no remedy in '{lines[0]}'"
        assert "Traceback" not in self.err
        return lines[0]


@pytest.fixture
def softdepth(capfd: pytest.CaptureFixture[str]) -> Callable[..., Outcome]:
    """Run the command line in this process."""

    def command(*arguments: object) -> Outcome:
        capfd.readouterr()
        code = main([str(argument) for argument in arguments])
        out, err = capfd.readouterr()
        return Outcome(code, out, err)

    return command


@dataclass(frozen=True)
class Files:
    """A small pair and its truth, as files."""

    left: Path
    right: Path
    truth: Path
    folder: Path

    @classmethod
    def written(cls, pair: StereoPair, folder: Path) -> Self:
        """The files of a pair with known truth, in a new folder."""
        assert pair.truth is not None
        folder.mkdir()
        found = cls(folder / "left.png", folder / "right.png", folder / "truth.pfm", folder)
        write_picture(found.left, pair.left)
        write_picture(found.right, pair.right)
        write_pfm(found.truth, pair.truth.disparity)
        return found

    def gray_right(self) -> Path:
        """The right image without its colour."""
        path = self.folder / "gray.png"
        cv2.imwrite(str(path), read_image(self.right).pixels[:, :, 1])
        return path

    def cropped(self, path: Path, columns: int) -> Path:
        """A copy of an image with fewer columns."""
        target = self.folder / f"crop{columns}.png"
        write_picture(target, read_image(path).pixels[:, :columns])
        return target

    def cropped_truth(self, columns: int) -> Path:
        """The truth with fewer columns."""
        target = self.folder / "crop.pfm"
        write_pfm(target, np.full((30, columns), 3.0))
        return target


@pytest.fixture
def files(tmp_path: Path) -> Files:
    """A 48x30 scene with disparities below 16."""
    return Files.written(generate("random", width=48, height=30, disparities=16, seed=3), tmp_path / "input")


@pytest.fixture(scope="session")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A recorded sequence with its truth: ``left``, ``right`` and ``truth``."""
    folder = tmp_path_factory.mktemp("recorded")
    record(folder)
    return folder


@pytest.fixture
def scene(recorded: Path, tmp_path: Path) -> Path:
    """A copy of it, to spoil."""
    shutil.copytree(recorded, tmp_path / "in")
    return tmp_path / "in"
