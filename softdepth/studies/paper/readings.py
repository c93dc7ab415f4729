"""Readings of the paper: everything about a row of Table 2 that the paper leaves open, decided.

The paper names neither the view, nor the border, nor the numbering of the candidates, nor its three
fuzzy inputs. A `Reading` is one way to fill these in; ``docs/paper.md`` says how these were found.
"""

from dataclasses import asdict, dataclass, replace
from typing import Any, Literal

from softdepth.golden.data.truth import View
from softdepth.spec.compensation import Reading as Rule
from softdepth.spec.config import Config, Operator

Method = Literal["sad", "fmcdm", "prototype", "stereobm", "stereosgbm"]

MULTIPLIERS = Config.model_fields["max_multipliers"].default


@dataclass(frozen=True)
class Reading:
    """How the maps of a row are computed, drawn and scored.

    Parameters
    ----------
    name : what reports call it.
    method : the algorithm. ``prototype`` has one criterion per colour channel.
    view : the reference view.
    truth : the view whose published truth the paper's RMSE compares with; not always `view`.
    windows : sizes of the criteria's windows, in pixels.
    candidates : displacements ``0 .. candidates - 1`` are compared.
    leaving : what a candidate reads beyond the other image: its ``replicated`` edge, or nothing,
        because it is ``excluded`` as soon as its window leaves.
    first : the map is drawn as ``4 * (d + first)`` in a byte.
    blank : this many pixels along each edge have no result.
    size : width and height to which images and truth are brought, or None.
    label : T of the float memberships (eq. 9).
    why : the reason for this reading, one sentence.
    """

    name: str
    method: Method
    view: View
    truth: View
    windows: tuple[int, ...]
    why: str
    candidates: int = 64
    leaving: Literal["replicated", "excluded"] = "replicated"
    first: int = 0
    blank: int = 0
    size: tuple[int, int] | None = None
    label: float = 5000.0

    def config(
        self, operator: Operator = "mean", rule: Rule = "off", judge: int = 1, lanes: int = 16
    ) -> Config:
        """The core of this reading, with as many lanes up to `lanes` as its multipliers allow.

        The compensating rule `rule` looks at criterion number `judge`, from one.
        """
        cost = "sum" if self.method == "sad" else "fuzzy"
        base: dict[str, Any] = {
            "name": self.name,
            "disparities": self.candidates,
            "reference": self.view,
            "cost": cost,
            "operator": operator,
            "criteria": [{"window": w} for w in self.windows],
            "compensation": {"reading": rule, "criterion": 0 if rule == "off" else judge},
        }
        widest = 1
        for n in range(2, lanes + 1):
            if self.candidates % n == 0:
                unchecked = Config.from_dict({**base, "lanes": n, "max_multipliers": 10**9})
                widest = n if unchecked.multipliers <= MULTIPLIERS else widest
        return Config.from_dict({**base, "lanes": widest})

    def describe(self) -> dict[str, str]:
        """The reading as label and text, for people."""
        windows = "/".join(map(str, self.windows))
        channels = "per channel: R, G, B" if self.method == "prototype" else "RGB"
        outside = "read its replicated edge" if self.leaving == "replicated" else "are excluded"
        border = "images replicated at the edges"
        if self.leaving == "excluded":
            border += ", except where candidates leave"
        if self.blank:
            border += f"; {self.blank} px along each edge set to 0"
        shift = f" + {self.first}" if self.first else ""
        facts = {
            "view": f"{self.view} image is the reference",
            "truth": f"of the {self.truth} view, all pixels; Venus (x8) as it is",
            "windows": f"{windows}, SAD {channels}",
            "candidates": f"d = 0..{self.candidates - 1}; those that leave the other image {outside}",
            "border": border,
            "index": f"drawn as 4*(d{shift}) in a byte" if shift else "drawn as 4*d in a byte",
            "size": "native" if self.size is None else f"all scenes at {self.size[0]}x{self.size[1]}",
        }
        if self.method in ("fmcdm", "prototype"):
            facts["labels"] = f"T = {self.label:g} float, 2^k fixed; delta 0.05, k = -100"
        return facts

    def plain(self) -> dict[str, Any]:
        """The fields as plain data, for reports and cache keys."""
        return asdict(self)


SAD = Reading(
    "sad",
    "sad",
    view="left",
    truth="right",
    windows=(3,),
    candidates=65,
    blank=1,
    why="meets the published row: the left view's map, scored against the right view's truth",
)

NEST_357 = Reading(
    "nest-357",
    "fmcdm",
    view="right",
    truth="right",
    windows=(3, 5, 7),
    first=2,
    why="keeps eq. 7's 3x3 sum as its first input, needs no resizing, and is the preset's nest",
)

NEST_579 = Reading(
    "nest-579",
    "fmcdm",
    view="right",
    truth="right",
    windows=(5, 7, 9),
    leaving="excluded",
    first=1,
    size=(450, 375),
    why="index counted from one, all scenes at the size that the paper states; its inputs lack eq. 7's sum",
)

FMCDM: dict[str, Reading] = {reading.name: reading for reading in (NEST_357, NEST_579)}
"""The readings of the proposed method; the first is the default."""

PROTOTYPE = Reading(
    "channels",
    "prototype",
    view="right",
    truth="right",
    windows=(7, 7, 7),
    candidates=65,
    blank=1,
    label=300.0,
    why="the nearest of those tried; it does not reproduce the published rows",
)

MATCHERS: tuple[Method, Method] = ("stereobm", "stereosgbm")


def one_view(reading: Reading, window: int) -> Reading:
    """Plain SAD in the view, truth, border and drawing of `reading`: the like-for-like baseline."""
    return replace(
        reading,
        name=f"sad-{window}x{window}-one-view",
        method="sad",
        windows=(window,),
        why=f"SAD over {window}x{window}, all else as in {reading.name}",
    )


def matcher(reading: Reading, method: Method) -> Reading:
    """An OpenCV matcher in the view of `reading`, drawn and scored like it."""
    return replace(reading, name=method, method=method, windows=(), why="for scale")
