"""How far a disparity map is from the truth: the field's metrics, and the paper's."""

from dataclasses import asdict, dataclass

import numpy as np

from softdepth.golden.data.inputs import size_text
from softdepth.golden.data.truth import GRAY_PER_PIXEL, Truth
from softdepth.spec.errors import InputError


@dataclass(frozen=True)
class Errors:
    """Errors over one set of pixels, all of known disparity.

    Parameters
    ----------
    bad1, bad2 : per cent of the pixels that are off by more than 1 and 2 px, or have no result.
    mae, rmse : mean absolute and root mean square error, in pixels; no result counts as disparity 0.
    """

    bad1: float
    bad2: float
    mae: float
    rmse: float


@dataclass(frozen=True)
class Metrics:
    """A disparity map's scores.

    Parameters
    ----------
    known : over every pixel of known disparity.
    nonocc : over those that both views see; None where the truth does not tell them.
    measured : over those that have a measured result; None where there is none.
    paper_rmse : the paper's RMSE (eq. 1), in gray levels; see `paper_rmse`.
    density : per cent of all pixels that have a measured result.
    """

    known: Errors
    nonocc: Errors | None
    measured: Errors | None
    paper_rmse: float
    density: float

    def as_dict(self) -> dict[str, float | None]:
        """Plain numbers under stable keys: ``bad1`` .. ``rmse`` over every known pixel, the same four
        with ``nonocc_`` and ``measured_``, then ``paper_rmse`` and ``density``."""
        flat: dict[str, float | None] = dict(asdict(self.known))
        for name, errors in (("nonocc", self.nonocc), ("measured", self.measured)):
            for key in asdict(self.known):
                flat[f"{name}_{key}"] = None if errors is None else getattr(errors, key)
        return {**flat, "paper_rmse": self.paper_rmse, "density": self.density}


@dataclass(frozen=True)
class Coverage:
    """What of a frame is scored, and what of it no candidate can reach.

    Parameters
    ----------
    scored : pixels of known disparity: these are scored.
    scored_percent : per cent of the frame that they are.
    outside : those of them whose disparity lies below the first candidate or above the last. They are
        scored like the others, and so are wrong by as much as they lie outside.
    outside_percent : per cent of the scored pixels that they are.
    first, last : the candidates' range, in pixels of disparity.
    """

    scored: int
    scored_percent: float
    outside: int
    outside_percent: float
    first: int
    last: int

    def __str__(self) -> str:
        text = f"scored: {self.scored} pixels of known disparity, {self.scored_percent:.2f} % of the frame"
        if not self.outside:
            return text
        return (
            f"{text}; {self.outside_percent:.2f} % of them lie outside {self.first} .. {self.last},"
            " and count as wrong, not as absent"
        )


def coverage(truth: Truth, first: int, last: int) -> Coverage:
    """How much of a frame is scored with this truth, for candidates `first` to `last`."""
    known = truth.known
    scored = int(known.sum())
    outside = int(np.sum(known & ((truth.disparity < first) | (truth.disparity > last))))
    return Coverage(
        scored,
        100 * scored / max(known.size, 1),
        outside,
        100 * outside / max(scored, 1),
        first,
        last,
    )


def density(valid: np.ndarray) -> float:
    """Per cent of a map's pixels that are measured: `valid` is bool H x W."""
    return float(100 * valid.mean())


def evaluate(
    disparity: np.ndarray,
    truth: Truth,
    *,
    valid: np.ndarray | None = None,
    measured: np.ndarray | None = None,
) -> Metrics:
    """Score a map of disparities, in pixels, against the truth of the same view.

    A pixel that is not `valid` (bool H x W, default: all are), or not finite, has no result. It
    stays in every figure but ``measured``, as disparity 0 and as bad: no core scores better by not
    answering, and a border costs what it hides. `measured` (bool H x W, default: those with a result)
    tells which pixels ``measured`` and the density are about: a filled pixel has a result, but nobody
    measured it.

    Raises
    ------
    InputError : shapes that differ, or a truth without a known pixel.
    """
    disparity, valid = _prepare(disparity, valid, truth.disparity)
    measured = valid if measured is None else _prepare(disparity, measured, truth.disparity)[1] & valid
    known = truth.known
    if not known.any():
        raise InputError("the truth holds no known disparity", "give one that does")
    error = np.abs(disparity - np.where(known, truth.disparity, 0).astype(np.float64))

    def over(pixels: np.ndarray) -> Errors | None:
        if not pixels.any():
            return None
        e, lost = error[pixels], ~valid[pixels]
        bad1, bad2 = (float(100 * np.mean((e > limit) | lost)) for limit in (1, 2))
        return Errors(bad1, bad2, float(e.mean()), float(np.sqrt(np.mean(e**2))))

    everywhere = over(known)
    assert everywhere is not None
    return Metrics(
        known=everywhere,
        nonocc=None if truth.nonoccluded is None else over(known & truth.nonoccluded),
        measured=over(known & measured),
        paper_rmse=paper_rmse(disparity, truth.gray, valid=valid),
        density=density(measured),
    )


def paper_rmse(
    disparity: np.ndarray, gray: np.ndarray, *, valid: np.ndarray | None = None, first: int = 0
) -> float:
    """The paper's RMSE (Bobyr et al. 2021, eq. 1) between gray pictures.

    The map is drawn as the paper draws it: ``4 * (d + first)`` in a byte, so 64 wraps round to 0
    (`first` = 1 numbers the candidates from one); no result is 0. Every pixel counts, those of
    unknown truth as gray 0. So a perfect map does not score 0: for Venus, whose truth has 8 gray
    levels per pixel, it scores 39.

    Raises
    ------
    InputError : shapes that differ.
    """
    disparity, valid = _prepare(disparity, valid, gray)
    drawn = np.where(valid, np.rint(GRAY_PER_PIXEL * (disparity + first)) % 256, 0)
    return float(np.sqrt(np.mean((drawn - gray.astype(np.float64)) ** 2)))


def _prepare(
    disparity: np.ndarray, valid: np.ndarray | None, truth: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Disparities as float64 with 0 where there is no result, and where there is one."""
    for what, array in (("truth", truth), ("valid mask", disparity if valid is None else valid)):
        if array.shape != disparity.shape or disparity.ndim != 2:
            raise InputError(
                f"the disparity map is {size_text(disparity)}, but the {what} is {size_text(array)}",
                "score a map against the truth of the same images",
            )
    disparity = disparity.astype(np.float64)
    valid = np.isfinite(disparity) if valid is None else valid.astype(bool) & np.isfinite(disparity)
    return np.where(valid, disparity, 0), valid
