"""A board as a stereo engine: which core it holds, and frames through it."""

import json
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING

import numpy as np

from softdepth.board.link import REBUILD, Link, Request
from softdepth.spec.config import Config
from softdepth.spec.errors import ConfigError, ToolError
from softdepth.spec.protocol import COUNTERS, ROW, SIZE, Counters, Type, result_bytes

if TYPE_CHECKING:
    from softdepth.golden.front.pair import Image
    from softdepth.golden.maps import DisparityMap

MAX_IDLE_FETCHES = 1000
"""How often a board may have no line of results ready, though all pixels are there."""


@dataclass(frozen=True)
class Description:
    """What a board says about itself.

    Members
    -------
    board : its name, as `softdepth.spec.boards` has it.
    revision : what the bitstream was built from.
    config : of its core.
    """

    board: str
    revision: str
    config: Config


class Device:
    """A board behind a link, in a session that begins here.

    Raises `ToolError` if the board does not answer or describes a core that this version does not know.
    """

    def __init__(self, link: Link) -> None:
        self._link = link
        self.description = _parse(link.hello())

    def check(self, wanted: Config) -> None:
        """Raise `ConfigError` unless the board's core is the one of `wanted`."""
        have = self.description.config
        if have.hash != wanted.hash:
            raise ConfigError(
                f"the board holds configuration {have.name} ({have.hash}), but"
                f" {wanted.name} ({wanted.hash}) is asked for",
                "leave the configuration out to use the board's, or build and load the other bitstream",
            )

    def disparity(
        self, left: "Image", right: "Image", progress: Callable[[int], None] | None = None
    ) -> "DisparityMap":
        """One frame through the core: images of the core's pixel format in, the map in the user's view out.

        `progress` is called with the number of results so far. Raises `ToolError` if the link fails or
        the core reports damage.
        """
        from softdepth.golden.front.pair import check_pair
        from softdepth.golden.front.views import from_core_view, to_core_view
        from softdepth.golden.maps import DisparityMap

        config = self.description.config
        check_pair(left, right, config.pixel)
        reference, other = to_core_view(left, right, config)
        height, width, _ = reference.shape
        words = np.zeros((height, width), np.uint32)
        for row, line in enumerate(self._lines(reference, other)):
            number, words[row] = _unpack(line, width, config)
            if number != row:
                raise ToolError(
                    f"line {number} of the results came in place of line {row}", "repeat the command"
                )
            if progress is not None:
                progress((row + 1) * width)
        damage = self.counters().core
        if any(damage):
            raise ToolError(f"the core on the board counts broken frames: {damage}", "repeat the command")
        disparities = (words & ((1 << config.result_bits) - 1)).astype(np.uint16)
        above = words >> config.result_bits
        codes = (above & ((1 << config.code_bits) - 1)).astype(np.uint8)
        confidence = (above >> config.code_bits).astype(np.uint8) if config.post.confidence else None
        if config.signed:
            sign = 1 << config.result_bits - 1
            disparities = ((disparities.astype(np.int32) ^ sign) - sign).astype(np.int16)
        found = DisparityMap(disparities, codes, config.post.fraction_bits, confidence)
        return from_core_view(found, config)

    def counters(self) -> Counters:
        """The board's own counters of this session."""
        return Counters(*COUNTERS.unpack(next(self._link.ask([(Type.STATUS, b"")]))))

    def link_counters(self) -> dict[str, int]:
        """Packets of this session, broken ones and repetitions, at both ends of the line."""
        at_board = self.counters()
        return {
            **asdict(self._link.counters),
            "board_broken": at_board.broken,
            "board_gaps": at_board.gaps,
            "board_overruns": at_board.overruns,
        }

    def _lines(self, reference: "Image", other: "Image") -> Iterator[bytes]:
        """The replies that hold lines of results, until there is one for each line sent."""
        height, width, _ = reference.shape
        next(self._link.ask([(Type.BEGIN, SIZE.pack(width, height))]))
        packed = np.concatenate([reference, other], axis=2)
        packed = packed.astype(packed.dtype.newbyteorder("<"))
        requests: Iterator[Request] = ((Type.LINE, line.tobytes()) for line in packed)
        came = 0
        for line in filter(None, self._link.ask(requests)):
            came += 1
            yield line
        idle = 0
        while came < height:
            line = next(self._link.ask([(Type.FETCH, b"")]))
            came += bool(line)
            idle = 0 if line else idle + 1
            if idle > MAX_IDLE_FETCHES:
                raise ToolError(
                    f"the board sent {came} of {height} lines and then nothing",
                    "reset it, repeat the command; if it happens again, the bitstream is not sound",
                )
            if line:
                yield line


def _unpack(line: bytes, width: int, config: Config) -> "tuple[int, np.ndarray]":
    """Row number and packed results of a line."""
    size = result_bytes(config)
    if len(line) != ROW.size + width * size:
        raise ToolError(f"a line of results has {len(line)} bytes for {width} pixels", REBUILD)
    return ROW.unpack_from(line)[0], np.frombuffer(line, f"<u{size}", offset=ROW.size).astype(np.uint32)


def _parse(text: bytes) -> Description:
    try:
        said = json.loads(text)
        config = Config.from_dict(said["config"])
        name, revision, digest = said["board"], said["revision"], said["hash"]
    except (ValueError, KeyError, TypeError, ConfigError) as error:
        raise ToolError("the board describes a core that this version does not know", REBUILD) from error
    if config.hash != digest:
        raise ToolError(
            f"the board's core {digest} was built by a version of softdepth ({revision}) that means"
            " something else by its configuration",
            REBUILD,
        )
    return Description(name, revision, config)
