"""The work of an evaluation: a scene a task, in several processes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from softdepth import screen
from softdepth.golden import fixed_model
from softdepth.golden.data.pair import StereoPair
from softdepth.golden.maps import DisparityMap
from softdepth.golden.post.fill import fill
from softdepth.processes import workers
from softdepth.spec.config import Config, Post
from softdepth.spec.validity import Validity
from softdepth.studies.evaluate import opencv
from softdepth.studies.evaluate.degrade import degraded
from softdepth.studies.evaluate.document import CLEAN, SceneResult
from softdepth.studies.evaluate.pictures import scene_pictures
from softdepth.studies.evaluate.scenes import Scene
from softdepth.studies.evaluate.score import by_confidence, score, sparsification

Engine = Literal["fixed", "rtl"]
WITH_POST = ("sgbm", "hh")
"""OpenCV's matchers that are shown with our post-processing too."""
POST = Post(check=True, island=8, fill=True, median=5, masked_median=9, like=32)
"""... of which the left-right check is theirs."""


@dataclass(frozen=True)
class Plan:
    """What is done with every scene.

    Members
    -------
    configs : our configurations, by name.
    extra : names of those that are scored on clean pairs alone.
    ways : names of `degrade.WAYS` to try beside the clean pairs.
    shown : methods whose maps go onto the page, as pictures.
    """

    configs: Mapping[str, Config]
    extra: Sequence[str]
    ways: Sequence[str]
    engine: Engine
    shown: Sequence[str]


@dataclass
class SceneWork:
    """A scene's result, and the pictures of its clean pair: name to a JPEG's bytes."""

    result: SceneResult
    pictures: dict[str, bytes] = field(default_factory=dict)


def titles(configs: Mapping[str, Config]) -> dict[str, str]:
    """Every method by name, with its title."""
    post = {f"{name}+post": f"{opencv.TITLES[name]}, our filters" for name in WITH_POST}
    return {name: f"`{name}`" for name in configs} | opencv.TITLES | post


def run(scenes: Sequence[Scene], plan: Plan, processes: int) -> list[SceneWork]:
    """Every scene, in the order given, showing progress."""
    sizes = [_pixels(scene) for scene in scenes]
    done, works = 0, []
    with screen.progress("evaluating", sum(sizes)) as advance:
        if processes == 1:
            for scene, size in zip(scenes, sizes, strict=True):
                works.append(evaluate_scene(scene, plan))
                done += size
                advance(done)
            return works
        with workers(processes, "--processes") as pool:
            tasks = [pool.submit(evaluate_scene, scene, plan) for scene in scenes]
            for task, size in zip(tasks, sizes, strict=True):
                works.append(task.result())
                done += size
                advance(done)
    return works


def evaluate_scene(scene: Scene, plan: Plan) -> SceneWork:
    """All methods on one scene."""
    pair = scene.load()
    assert pair.truth is not None
    result = SceneResult(name=scene.name, group=scene.group, width=pair.width, height=pair.height, scores={})
    shown: dict[str, np.ndarray] = {}
    for way in (CLEAN, *plan.ways):
        made = pair if way == CLEAN else degraded(pair, way)
        scores = result.scores[way] = {}
        for name, config in plan.configs.items():
            if way != CLEAN and name in plan.extra:
                continue
            found, mismatches = _map(made, config, plan.engine)
            pixels = everywhere(found)
            scores[name] = score(pixels, pair.truth, found.valid)
            if way == CLEAN:
                if mismatches is not None:
                    result.mismatches[name] = mismatches
                if found.confidence is not None and name not in plan.extra:
                    _judge_confidence(result, name, pair, found)
                shown[name] = pixels
        for name, pixels in _opencv(made, next(iter(plan.configs.values())).disparities).items():
            scores[name] = score(pixels, pair.truth)
            if way == CLEAN:
                shown[name] = pixels
    return SceneWork(
        result, scene_pictures(pair, {name: shown[name] for name in plan.shown if name in shown})
    )


def everywhere(found: DisparityMap) -> np.ndarray:
    """A map in pixels with a value everywhere; pixels without one are filled as by `fill`."""
    if not (found.given | (found.code == Validity.NOTHING)).all():
        lowest = int(found.disparity.min())  # negative where candidates are
        above = fill((found.disparity.astype(np.int32) - lowest).astype(np.uint16), found.valid)
        return (above + np.float32(lowest)) / np.float32(1 << found.fraction_bits)
    return found.pixels


def _map(pair: StereoPair, config: Config, engine: Engine) -> tuple[DisparityMap, int | None]:
    """A configuration's map, and the pixels in which gateware and model differ, if the gateware was run."""
    views = pair.as_format(config.pixel)
    model = fixed_model.disparity(views.left, views.right, config)
    if engine == "fixed":
        return model, None
    from softdepth.sim.frames import run_frames

    found = run_frames(config, [(views.left, views.right)]).maps[0]
    return found, len(list(model.differences(found)))


def _opencv(pair: StereoPair, candidates: int) -> dict[str, np.ndarray]:
    maps = {}
    for name in opencv.TITLES:
        raw = opencv.match(name, pair.left, pair.right, candidates)
        maps[name] = opencv.filled(raw)
        if name in WITH_POST:
            maps[f"{name}+post"] = opencv.with_post(raw, pair.left, POST)
    return maps


def _judge_confidence(result: SceneResult, name: str, pair: StereoPair, found: DisparityMap) -> None:
    assert pair.truth is not None
    assert found.confidence is not None
    about = found.pixels, pair.truth, found.valid, found.confidence
    result.sparsification[name] = sparsification(*about)
    levels, bad = by_confidence(*about)
    result.levels[name], result.bad_levels[name] = levels.tolist(), bad.tolist()


def _pixels(scene: Scene) -> int:
    """The size of a scene, by its file: large pairs take longer."""
    return scene.left.stat().st_size
