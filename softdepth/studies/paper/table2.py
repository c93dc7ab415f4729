"""Table 2: published, float, fixed and gateware side by side, and what they sum up to."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from pydantic import BaseModel

from softdepth.spec.config import OPERATORS, Operator
from softdepth.studies.paper import published, readings, scenes
from softdepth.studies.paper.cells import Cell, Engine, rmse
from softdepth.studies.paper.readings import Reading
from softdepth.studies.paper.work import Maps

Figure = float | None
"""A measured or printed figure, if there is one."""


class Row(BaseModel):
    """A cell of Table 2, in the paper's RMSE (eq. 1: gray levels).

    `published` is None where the paper has no such row; a figure is None where it was not measured.
    `deviation` is float minus published.
    """

    scene: str
    method: str
    operator: Operator | None
    reading: str
    published: Figure
    float: Figure
    fixed: Figure
    rtl: Figure
    deviation: Figure
    rtl_mismatches: int | None = None


class Summary(BaseModel):
    """What the table amounts to; gray levels of the paper's RMSE, or per cent.

    Members
    -------
    sad_max_deviation : largest |float - published| of the SAD row; ``sad_own_truth_...`` the same
        maps scored against the truth of their own view instead.
    fmcdm_mean_deviation_14, fmcdm_mean_deviation_15 : mean |float - published| of the FMCDM rows,
        without and with Venus PROD; ``fixed_...`` the same in fixed point.
    readings : fmcdm_mean_deviation_14 of every reading that was tried here, by name.
    prototype_mean_deviation : the same for "[11]", 15 cells.
    fixed_float_max_difference : largest |fixed - float| of the FMCDM rows.
    gain_published, gain_two_views : how far FMCDM (mean of its operators) lies below SAD, mean of the
        scenes, as published and here: SAD in one view, FMCDM in the other.
    gain_one_view : the same against 3x3 SAD in FMCDM's own view.
    gain_over_wide_sad : the same against plain SAD over its largest window, in its own view.
    rtl_cells, rtl_mismatches : cells that went through the gateware, and pixels of them in which it
        departs from the fixed-point model.
    """

    sad_max_deviation: float
    sad_own_truth_max_deviation: float
    fmcdm_mean_deviation_14: float
    fmcdm_mean_deviation_15: float
    fixed_mean_deviation_14: float
    readings: dict[str, float]
    prototype_mean_deviation: float
    fixed_float_max_difference: float
    gain_published: float
    gain_two_views: float
    gain_one_view: float
    gain_over_wide_sad: float
    rtl_cells: int
    rtl_mismatches: int | None


def table(maps: Maps, reading: Reading) -> list[Row]:
    """Table 2 in the paper's order; `reading` is that of the FMCDM rows."""
    rows = []
    for scene in published.SCENES:
        rows.append(row(maps, "SAD", scene, readings.SAD, None, published.SAD[scene]))
        for method, plan, printed in (
            ("[11]", readings.PROTOTYPE, published.PROTOTYPE),
            ("FMCDM", reading, published.FMCDM),
        ):
            rows += [row(maps, method, scene, plan, o, printed[scene][o]) for o in OPERATORS]
    return rows


def one_view(maps: Maps, reading: Reading) -> list[Row]:
    """What the paper did not compare with: plain SAD in the view, truth and drawing of FMCDM."""
    return [
        row(maps, f"SAD {window}x{window}", scene, readings.one_view(reading, window), None, None)
        for scene in published.SCENES
        for window in (3, max(reading.windows))
    ]


def row(
    maps: Maps, method: str, scene: str, reading: Reading, operator: Operator | None, printed: float | None
) -> Row:
    """One row, from the maps that there are."""
    images = scenes.load(scene, reading.size)

    def score(engine: Engine) -> float | None:
        found = maps.get(Cell(scene, reading, operator, engine))
        return None if found is None else rmse(found, reading, images)

    model = score("float")
    return Row(
        scene=scene,
        method=method,
        operator=operator,
        reading=reading.name,
        published=printed,
        float=model,
        fixed=score("fixed"),
        rtl=score("rtl"),
        deviation=None if model is None or printed is None else model - printed,
        rtl_mismatches=_mismatches(maps, scene, reading, operator),
    )


def sad_against_its_own_truth(maps: Maps) -> dict[str, float]:
    """The SAD row's maps, scored against the truth of the view that they are of; by scene."""
    own = replace(readings.SAD, truth=readings.SAD.view)
    return {
        scene: rmse(maps[Cell(scene, readings.SAD, None, "float")], own, scenes.load(scene, own.size))
        for scene in published.SCENES
    }


def summarise(
    rows: Sequence[Row], plain: Sequence[Row], tried: Mapping[str, Sequence[Row]], own: dict[str, float]
) -> Summary:
    """Sum up the table `rows`, the `one_view` rows, the FMCDM rows of every reading `tried`, and `own`:
    `sad_against_its_own_truth`."""
    fmcdm = [r for r in rows if r.method == "FMCDM"]
    wide = plain[-1].method
    ran = [r.rtl_mismatches for r in rows if r.rtl_mismatches is not None]
    baselines = {m: {r.scene: r for r in (*rows, *plain) if r.method == m} for m in ("SAD", "SAD 3x3", wide)}

    def gain(baseline: str, column: str) -> float:
        shares = []
        for scene in published.SCENES:
            values = [getattr(r, column) for r in fmcdm if r.scene == scene]
            shares.append(1 - _mean(values) / getattr(baselines[baseline][scene], column))
        return 100 * _mean(shares)

    return Summary(
        sad_max_deviation=max(abs(r.deviation or 0) for r in rows if r.method == "SAD"),
        sad_own_truth_max_deviation=max(abs(v - published.SAD[scene]) for scene, v in own.items()),
        fmcdm_mean_deviation_14=mean_deviation(fmcdm),
        fmcdm_mean_deviation_15=mean_deviation(fmcdm, everything=True),
        fixed_mean_deviation_14=mean_deviation(fmcdm, "fixed"),
        readings={name: mean_deviation(each) for name, each in tried.items()},
        prototype_mean_deviation=mean_deviation([r for r in rows if r.method == "[11]"], everything=True),
        fixed_float_max_difference=max(abs(r.fixed - r.float) for r in fmcdm if r.fixed and r.float),
        gain_published=gain("SAD", "published"),
        gain_two_views=gain("SAD", "float"),
        gain_one_view=gain("SAD 3x3", "float"),
        gain_over_wide_sad=gain(wide, "float"),
        rtl_cells=len(ran),
        rtl_mismatches=sum(ran) if ran else None,
    )


def mean_deviation(rows: Sequence[Row], column: str = "float", *, everything: bool = False) -> float:
    """Mean of |figure - published|; Venus PROD of FMCDM only counts with `everything`."""
    counted = [r for r in rows if everything or (r.scene, r.operator) != published.OUTLIER]
    return _mean([abs(getattr(r, column) - r.published) for r in counted])


def _mismatches(maps: Maps, scene: str, reading: Reading, operator: Operator | None) -> int | None:
    got = maps.get(Cell(scene, reading, operator, "rtl"))
    expected = maps.get(Cell(scene, reading, operator, "fixed"))
    if got is None or expected is None:
        return None
    return int(((got.disparity != expected.disparity) | (got.valid != expected.valid)).sum())


def _mean(values: Sequence[float]) -> float:
    return sum(values) / len(values)
