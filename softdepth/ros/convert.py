"""A bag of images into a bag of depth."""

import shutil
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from rosbags.rosbag2 import StoragePlugin, Writer

from softdepth.metric.scene import Bytes, Choice, Scene
from softdepth.ros import messages
from softdepth.ros.bag import TYPES, BagPair, Topics, opened, pairs
from softdepth.spec.errors import InputError

STORAGE = {"db3": StoragePlugin.SQLITE3, "mcap": StoragePlugin.MCAP}
VERSION = 8
"""Of the bag's metadata: the newest that ROS 2 Humble reads."""


@dataclass(frozen=True, eq=False)
class Disparities:
    """What a core finds for a pair: H x W disparities in pixels, codes, and confidence where it has one."""

    disparity: NDArray[np.floating]
    code: Bytes
    confidence: Bytes | None = None


@dataclass(frozen=True)
class Further:
    """What is written beside depth.

    Members
    -------
    confidence : the core's, which it must have.
    disparity_error : standard error of a disparity in pixels, from which each depth gets its own; or None.
    """

    confidence: bool = False
    disparity_error: float | None = None


NOTHING_FURTHER = Further()

Compute = Callable[[BagPair], Disparities]


@dataclass(frozen=True)
class RigTopics:
    """A rig in a bag: the topics that it is read from, and the namespace that its results go to."""

    topics: Topics
    namespace: str

    def outputs(self, further: Further = NOTHING_FURTHER) -> dict[str, str]:
        """The topics of the results, each with its message type."""
        root = self.namespace.rstrip("/")
        more = {}
        if further.confidence:
            more[f"{root}/confidence"] = messages.IMAGE
        if further.disparity_error is not None:
            more[f"{root}/depth/uncertainty"] = messages.IMAGE
        return {
            f"{root}/disparity": messages.DISPARITY,
            f"{root}/depth/image_raw": messages.IMAGE,
            f"{root}/depth/image": messages.IMAGE,
            f"{root}/points2": messages.CLOUD,
            **more,
        }


@dataclass
class Converted:
    """How many pairs of each rig were written, by namespace."""

    pairs: dict[str, int] = field(default_factory=dict)


def convert(
    source: Path,
    target: Path,
    rigs: Sequence[RigTopics],
    compute: Compute,
    search: messages.Search,
    *,
    storage: str = "mcap",
    tolerance: float = 0.0,
    choice: Choice | None = None,
    further: Further = NOTHING_FURTHER,
    progress: Callable[[int], None] = lambda done: None,
) -> Converted:
    """Write the depth of every rig's pairs into a new bag, which appears complete or not at all.

    Each result carries the header of its left image, and is stored at the time at which that image was.

    Parameters
    ----------
    source, target : folders of bags; `target` must not exist.
    rigs : read one after the other; their namespaces must differ.
    compute : the core: a pair into disparities.
    search : the core's candidates, for the messages.
    storage : ``mcap`` or ``db3``.
    tolerance : seconds that the stamps of a pair may differ by.
    choice : which results become depth; all of them by default.
    further : topics beside depth and points.
    progress : is called with the pairs done so far.

    Raises `InputError` for anything wrong with the bag, for a target that exists, and if no rig has a pair.
    """
    if target.exists():
        raise InputError(f"'{target}' exists already", "name a new folder: bags are not overwritten")
    if storage not in STORAGE:
        raise InputError(f"unknown storage '{storage}'", f"use one of {', '.join(STORAGE)}")
    if len({rig.namespace.rstrip("/") for rig in rigs}) < len(rigs):
        raise InputError("two rigs have the same namespace", "give each rig a namespace of its own")
    done = Converted({rig.namespace: 0 for rig in rigs})
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        work = Path(tempfile.mkdtemp(prefix=f".{target.name}-", dir=target.parent))
    except OSError as error:
        raise InputError(
            f"cannot write '{target}': {error.strerror}", "choose another place with -o"
        ) from error
    try:
        with (
            opened(source) as reader,
            Writer(work / target.name, version=VERSION, storage_plugin=STORAGE[storage]) as writer,
        ):
            for rig in rigs:
                outputs = [
                    writer.add_connection(topic, kind, typestore=TYPES)
                    for topic, kind in rig.outputs(further).items()
                ]
                for pair in pairs(reader, rig.topics, tolerance=tolerance):
                    results = _results(pair, compute(pair), search, choice or Choice(), further)
                    for connection, message in zip(outputs, results, strict=True):
                        raw = TYPES.serialize_cdr(message, connection.msgtype)
                        writer.write(connection, pair.received, raw)
                    done.pairs[rig.namespace] += 1
                    progress(sum(done.pairs.values()))
        for name, found in done.pairs.items():
            if not found:
                raise InputError(
                    f"no two images of '{name}' have stamps within {tolerance:g} s of each other",
                    "allow for more with --tolerance",
                )
        (work / target.name).rename(target)
    finally:
        shutil.rmtree(work, ignore_errors=True)
    return done


def _results(
    pair: BagPair, found: Disparities, search: messages.Search, choice: Choice, further: Further
) -> list[object]:
    """One message for each of `RigTopics.outputs`."""
    colour = pair.left if pair.left.ndim == 3 else np.repeat(pair.left[..., None], 3, axis=2)
    if colour.dtype != np.uint8:
        colour = (colour >> 8).astype(np.uint8)
    scene = Scene.of(
        pair.geometry, found.disparity, found.code, found.confidence, choice=choice, image=colour
    )
    valid = choice.of(found.code, found.confidence)
    more = []
    if further.confidence:
        if found.confidence is None:
            raise InputError("the core gives no confidence", "use a preset that has it, such as robust")
        more.append(messages.confidence(pair.header, found.confidence))
    if further.disparity_error is not None:
        more.append(messages.depth_uncertainty(pair.header, scene, further.disparity_error))
    return [
        messages.disparity_image(pair.header, pair.geometry, search, found.disparity, valid),
        messages.depth_millimetres(pair.header, scene),
        messages.depth_metres(pair.header, scene),
        messages.point_cloud(pair.header, scene),
        *more,
    ]
