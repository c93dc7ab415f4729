"""Whole stereo pairs through a simulated core."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import accumulate

import numpy as np
from numpy.typing import NDArray

from softdepth.golden.front.pair import Image, check_pair
from softdepth.golden.front.views import from_core_view, to_core_view
from softdepth.golden.maps import DisparityMap
from softdepth.sim.job import Job
from softdepth.sim.stalls import Stalls
from softdepth.sim.stream import Progress, StreamResult, run_stream
from softdepth.sim.transfers import pack_frame, split_frames, to_maps, unpack_results
from softdepth.spec.config import Config
from softdepth.spec.errors import InputError, ToolError

Pair = tuple[Image, Image]


@dataclass(frozen=True)
class FramesResult:
    """Maps of a run, in the user's view, and what it took.

    Members
    -------
    maps : one for each pair; none where they were handed over one by one.
    stream : the run itself: cycles, status, seconds.
    """

    maps: list[DisparityMap]
    stream: StreamResult

    @property
    def cycles_per_pixel(self) -> float:
        """Sustained clocks per pixel: from the first pixel taken to the last, over the pixels between.

        This includes stalls and gaps, but not the results that follow the last pixel.
        """
        taken = self.stream.taken
        return float(taken[-1] - taken[0]) / (len(taken) - 1)

    @property
    def latency(self) -> int:
        """Clocks from the first pixel taken to the first result."""
        return int(self.stream.cycles[0] - self.stream.taken[0])

    @property
    def pixels_per_second(self) -> float:
        """Results in a second of wall-clock time, which is the speed of the simulation."""
        return len(self.stream.cycles) / self.stream.seconds_sim


def run_frames(
    config: Config,
    pairs: Sequence[Pair],
    *,
    verilog: str | None = None,
    stalls: Stalls | None = None,
    gap: int = 0,
    progress: Progress | None = None,
    handed: Callable[[int, DisparityMap, float], None] | None = None,
    eof: bool = True,
) -> FramesResult:
    """Simulate the core of `config` on stereo pairs, one after the other.

    Parameters
    ----------
    pairs : left and right image each, of ``config.pixel``'s format (`softdepth.golden.front.pair.Image`).
    verilog : the core's text; by default it is made from `config`.
    stalls : pauses at both ends; none by default.
    gap : idle clocks between frames.
    progress : called with the number of results so far.
    handed : called from another thread with each pair's number, map and seconds of simulation while the next
        are simulated; the maps are not kept then.
    eof : whether the source marks a frame's last pixel. Without it, the core learns the height from two
        frames and needs it for the last one, so there must be at least three frames of the same height.

    Raises `InputError` for pairs that the core cannot take, before anything is built, and `ToolError`
    for a missing tool, a failed build, or a core that does not give every result in good order.
    """
    _check(config, pairs, eof)
    if verilog is None:
        from softdepth.hdl.verilog import to_verilog  # elaboration is slow to import

        verilog = to_verilog(config)
    packed = [
        pack_frame(*to_core_view(left, right, config), eof=eof, pixel=config.pixel) for left, right in pairs
    ]
    sizes = [len(frame) for frame in packed]
    starts = list(accumulate(sizes))[:-1] if gap else []
    ends = tuple(accumulate(sizes))
    job = Job(
        np.concatenate(packed),
        stalls or Stalls(),
        gaps=dict.fromkeys(starts, gap),
        cuts=ends if handed else (),
        expected=ends[-1],
    )
    shapes = [left.shape[:2] for left, _ in pairs]

    def hand_over(number: int, payloads: NDArray[np.uint64], seconds: float) -> None:
        assert handed is not None
        handed(number, _maps(payloads, config, shapes[number : number + 1], number)[0], seconds)

    stream = run_stream(verilog, job, progress=progress, parts=hand_over if handed else None)
    _check_run(stream, job)
    return FramesResult([] if handed else _maps(stream.payloads, config, shapes), stream)


def _maps(
    payloads: NDArray[np.uint64], config: Config, shapes: list[tuple[int, ...]], first: int = 0
) -> list[DisparityMap]:
    """The maps of frames of `shapes`, in the user's view; raises `ToolError` for others, or damaged ones."""
    frames = split_frames(unpack_results(payloads, config))
    if [frame.shape for frame in frames] != shapes:
        shown = [frame.shape for frame in frames]
        raise _fault(f"frames of {shown} came out where {shapes} went in", "sequencer (markers)")
    for number, frame in enumerate(frames, first):
        if frame["damaged"].any():
            raise _fault(f"frame {number} went in sound and came out marked as damaged", "frame guard")
    return [from_core_view(found, config) for found in to_maps(frames, config)]


def _check(config: Config, pairs: Sequence[Pair], eof: bool) -> None:
    if not pairs:
        raise InputError("there is no stereo pair to simulate", "give at least one")
    for left, right in pairs:
        check_pair(left, right, config.pixel)
        height, width = left.shape[:2]
        if not config.min_width <= width <= config.max_width:
            raise InputError(
                f"the pair is {width} pixels wide, the core takes {config.min_width} to {config.max_width}",
                "change max_width, or resize the images",
            )
        if height > config.max_height:
            raise InputError(
                f"the pair has {height} lines, the core takes {config.max_height}",
                "change max_height, or resize the images",
            )
    heights = {left.shape[0] for left, _ in pairs}
    if not eof and (len(pairs) < 3 or len(heights) > 1):
        raise InputError(
            f"without eof, the last of {len(pairs)} pairs of heights {sorted(heights)} has no certain end",
            "give three pairs of one height, or more",
        )


def _check_run(stream: StreamResult, job: Job) -> None:
    if stream.violations:
        raise _fault(f"{stream.violations[0].rule}, at clock {stream.violations[0].cycle}", "results")
    if not stream.complete:
        taken_all = len(stream.taken) == len(job.transfers)
        raise _fault(
            f"it took {len(stream.taken)} of {len(job.transfers)} pixels, gave {len(stream.cycles)} of"
            f" {job.expected} results, and then nothing for {job.patience} clocks",
            # A result that is lost keeps its place in the queue, so in the end no more pixels are admitted.
            "results or sequencer" if taken_all else "results, sequencer or frame guard",
        )
    if len(stream.cycles) != job.expected:
        raise _fault(f"it gave {len(stream.cycles)} results where {job.expected} were due", "sequencer")


def _fault(problem: str, stage: str) -> ToolError:
    return ToolError(
        f"the simulated core misbehaves: {problem}; stage: {stage}",
        "this is a fault of the gateware; please report it with the configuration",
    )
