"""The fixed-point model: what the gateware computes, bit for bit. This file is its specification.

For every pixel and candidate d, in exact integer arithmetic:

1. Criteria ``s_1 .. s_n``, one to three of them (three with fuzzy costs): how unlike the pixels around the
   pixel and its partner are, as each kind sums it up (`costs.sad`, `costs.census`, `costs.gradient`).
2. Compensating rule, if it is on and fires: all ``s_i`` are replaced (`criteria.compensate`).
3. Memberships, labels at 0, T and 2T with ``T = 2**label_bits``, and ``one = 2**membership_bits``:
   ``u = min(s, 2T) >> (label_bits - membership_bits)``,
   ``A1 = max(one - u, 0)``, ``A2 = one - |u - one|``, ``A3 = max(u - one, 0)``.
4. Conclusions ``Y_k = max over the rules of conclusion k of Theta(A_a1, Theta(A_b2, A_c3))``
   (`fixed_operators`; soft-min II joins rules before the outer Theta). With ``firing = "cell"`` the
   maximum is over those rules whose labels are next to the criteria: of each criterion low and middle
   where ``u < one``, middle and high elsewhere. A conclusion without such a rule is 0.
5. Cost ``N / S`` with ``N = sum Y_k * M_k`` and ``S = sum Y_k``; it is never divided.
   Where S is not above zero, the cost is infinite: N / S = 1 / 0, which no candidate with S > 0
   loses against.
6. Disparity: the d of the smallest cost, the smallest such d on a tie. A candidate beats the best
   so far when ``N * S_best < N_best * S``.

`borders.validity_codes` and `candidates.Band` decide which candidates and pixels take part. Candidates are
counted from `Config.min_disparity` on (`front.overlap`). What follows the winners is in `post.stages`.
With ``cost = "sum"`` steps 2 to 4 fall away: N is the sum of all criteria, S is 1.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softdepth.golden.costs.candidates import band
from softdepth.golden.costs.criteria import Values, compensate
from softdepth.golden.costs.fuzzy.fixed_operators import conclude
from softdepth.golden.costs.fuzzy.inference import Memberships
from softdepth.golden.front.borders import validity_codes
from softdepth.golden.front.overlap import first_column, from_zero, overlap
from softdepth.golden.front.pair import Image, check_pair, check_pixel
from softdepth.golden.front.views import column_in_core_view, to_core_view
from softdepth.golden.maps import DisparityMap, Result
from softdepth.golden.post.maps import stage_maps
from softdepth.golden.winners.cost import Comparison, Cost, less, less_fraction
from softdepth.golden.winners.frame import Winners, winners
from softdepth.spec.config import LITERAL_INPUT, QUOTIENT_BITS, AnyCriterion, Config
from softdepth.spec.errors import InputError
from softdepth.spec.rules import CONCLUSIONS, weight
from softdepth.spec.validity import Validity

Integers = NDArray[np.signedinteger[Any]]

NEVER = 1 << 30
"""More than any cost: marks a candidate that does not take part."""


def disparity(left: Image, right: Image, config: Config) -> DisparityMap:
    """The gateware's result for one frame: images of one shape in (`front.pair.Image`), an HxW map out.

    Raises `InputError` for unusable images, or images wider than `config.max_width`.
    """
    return stages(left, right, config).result


@dataclass(frozen=True, eq=False)
class Stages:
    """A frame, stage by stage.

    Members
    -------
    winners : of both views, with the costs around the left one; in the core's view, as `front.overlap`
        makes it.
    maps : by name, the map after each stage of `post.stages`, in the user's reference view.
    """

    winners: Winners
    maps: dict[str, DisparityMap]

    @property
    def result(self) -> DisparityMap:
        """The map after the last."""
        return list(self.maps.values())[-1]


def stages(left: Image, right: Image, config: Config) -> Stages:
    """What `disparity` returns, and everything it comes from. Errors as there."""
    _check(left, right, config)
    reference, other = overlap(*to_core_view(left, right, config), config)
    inner = from_zero(config)
    found = winners(
        reference, other, inner, lambda d, criteria: cost_of(inner, d, criteria), comparison(inner)
    )
    return Stages(found, stage_maps(config, found, reference, left.shape[1]))


def cost_of(config: Config, d: int, criteria: list[Values]) -> Cost:
    """Steps 2 to 5: what a candidate costs, as the winners compare it."""
    return (total(criteria),) if config.cost == "sum" else fraction(config, d, criteria)


def comparison(config: Config) -> Comparison:
    """How costs compare, and what number each is (`Config.number_range`)."""
    if config.cost == "sum":
        return Comparison(less, lambda cost: cost[0], NEVER)
    low, high = config.number_range

    def number(cost: Cost) -> Integers:
        n, s = (part.astype(np.int64) for part in cost)
        quotient = (n << QUOTIENT_BITS) // np.maximum(s, 1)
        return np.where(s > 0, np.clip(quotient, low, high), high)

    return Comparison(less_fraction, number, NEVER)


@dataclass(frozen=True, eq=False)
class Trace:
    """The core's values while it judges one pixel; row k of every array is candidate ``first + k``.

    Members
    -------
    first : the disparity of row 0.
    criteria : candidates x criteria, as measured.
    inputs : the same after the compensating rule.
    memberships : candidates x criteria x 3, low to high.
    conclusions : candidates x 11, ``Y_1`` first.
    numerator, denominator : one per candidate, N and S.
    winner : the row of least cost.
    right : that of the right winner of its partner, where the configuration checks it.
    around : costs, as numbers, of the candidates beside the winner and of the runner-up, as `Winners` has
        them; None where no candidate takes part. Empty where the configuration asks for none.
    stages : the result after each stage of `post.stages`.
    disparity, code, confidence : the pixel's result.

    Excluded candidates have no row: a border pixel has none at all. With ``cost = "sum"``
    memberships and conclusions are empty.
    """

    first: int
    criteria: NDArray[np.int64]
    inputs: NDArray[np.int64]
    memberships: NDArray[np.int64]
    conclusions: NDArray[np.int64]
    numerator: NDArray[np.int64]
    denominator: NDArray[np.int64]
    winner: int
    right: int | None
    around: dict[str, int | None]
    stages: dict[str, Result]
    disparity: int
    code: Validity
    confidence: int | None

    def __str__(self) -> str:
        """A table: one line per candidate, then one per stage."""
        lines = [f"disparity {self.disparity} ({self.code.name})", "d: criteria -> inputs | Y_1..Y_11 | N/S"]
        rows = zip(
            self.criteria, self.inputs, self.conclusions, self.numerator, self.denominator, strict=True
        )
        lines += [f"{d}: {c} -> {i} | {y} | {n}/{s}" for d, (c, i, y, n, s) in enumerate(rows, self.first)]
        if self.right is not None:
            lines.append(f"right winner at x - {self.first + self.winner}: {self.first + self.right}")
        lines += [f"{name}: {'none' if cost is None else cost}" for name, cost in self.around.items()]
        if len(self.stages) > 1:
            lines += [f"after {name}: {result}" for name, result in self.stages.items()]
        return "\n".join(lines)


def trace(left: Image, right: Image, config: Config, x: int, y: int, frame: Stages | None = None) -> Trace:
    """Every intermediate value of the pixel (x, y) of the reference view, for debugging gateware.

    `frame` are the pair's `stages`, if they are known already: post-processing needs the whole frame.
    Errors as in `disparity`; `InputError` also for a pixel outside the image.
    """
    _check(left, right, config)
    check_pixel(left, x, y)
    reference, other = overlap(*to_core_view(left, right, config), config)
    height, width, _ = reference.shape
    user_x, asked, first = x, config, config.min_disparity
    x = column_in_core_view(x, left.shape[1], config) - first_column(config)
    config = from_zero(config)
    rows: dict[str, list[Any]] = {name: [] for name in _BY_CANDIDATE}
    winner, code = 0, int(Validity.BORDER)
    if 0 <= x < width:
        code = int(validity_codes(height, width, config)[y, x])
    if code < Validity.BORDER:
        column = x - config.reach_left
        for d, block in band(reference, other, config, y, y + 1).candidates():
            if d > column:
                break
            criteria = [values[:, column - d : column - d + 1] for values in block]
            inputs = compensated(config, d, criteria)
            fuzzy = config.cost == "fuzzy"
            degrees = (
                [memberships(c, v, config) for c, v in zip(config.criteria, inputs, strict=True)]
                if fuzzy
                else []
            )
            y_k = conclude(config, degrees) if fuzzy else ()
            n, s = fraction(config, d, criteria)
            rows["criteria"].append([v.item() for v in criteria])
            rows["inputs"].append([v.item() for v in inputs])
            rows["memberships"].append([[a.item() for a in triple] for triple in degrees])
            rows["conclusions"].append([value.item() for _, value in y_k])
            rows["numerator"].append(n.item())
            rows["denominator"].append(s.item())
            if n.item() * rows["denominator"][winner] < rows["numerator"][winner] * s.item():
                winner = d
    disparity_there = winner + first if code < Validity.BORDER else 0
    after, around, other_winner = {"winner": Result(disparity_there, code)}, {}, None
    if config.post.any:
        frame = frame or stages(left, right, asked)
        after = {name: found.at(user_x, y) for name, found in frame.maps.items()}
        found = frame.winners
        inside = 0 <= x < width
        if config.post.check and inside:
            other_winner = int(found.right[y, max(x - winner, 0)])
        if inside and (config.post.fraction_bits or config.post.confidence):
            for name in ("below", "at", "above", "runner_up"):
                number = int(getattr(found, name)[y, x])
                around[name] = None if number == found.never else number
    result = list(after.values())[-1]
    return Trace(
        first=first,
        **{name: np.array(v, np.int64) for name, v in rows.items()},
        winner=winner,
        right=other_winner,
        around=around,
        stages=after,
        disparity=result.disparity,
        code=Validity(result.code),
        confidence=result.confidence,
    )


_BY_CANDIDATE = ("criteria", "inputs", "memberships", "conclusions", "numerator", "denominator")
"""Members of `Trace` that have a row a candidate."""


def fraction(config: Config, d: int, criteria: list[Values]) -> tuple[Integers, Integers]:
    """Steps 2 to 5: numerator N and denominator S of a candidate's cost; S > 0, or N / S = 1 / 0.

    Both come in a type that holds the products of any two candidates.
    """
    if config.cost == "sum":
        n = total(criteria)
        return n, np.ones_like(n)
    # No strength exceeds 3 * one (the mean's sum), nor falls below minus that.
    n_max = 3 * config.one * sum(abs(weight(k)) for k in range(1, CONCLUSIONS + 1))
    s_max = 3 * config.one * CONCLUSIONS
    n = np.zeros(criteria[0].shape, integer(n_max * s_max))
    s = np.zeros_like(n)
    inputs = compensated(config, d, criteria)
    degrees = [memberships(c, v, config) for c, v in zip(config.criteria, inputs, strict=True)]
    for k, y_k in conclude(config, degrees):
        n += np.multiply(y_k, weight(k), dtype=n.dtype)
        s += y_k
    worst = s <= 0
    if worst.any():  # soft-min I alone can do that
        n[worst], s[worst] = 1, 0
    return n, s


def total(criteria: list[Values]) -> Values:
    """The sum of the criteria."""
    return sum(criteria[1:], start=criteria[0])


def compensated(config: Config, d: int, criteria: list[Values]) -> list[Values]:
    """Step 2: replaced criteria become 2T, their own top label, or 1000 in the literal reading."""
    literal = config.compensation.reading == "literal"
    return compensate(
        config, d, criteria, [LITERAL_INPUT if literal else 2 << c.label_bits for c in config.criteria]
    )


def memberships(criterion: AnyCriterion, values: Values, config: Config) -> Memberships:
    """Step 3: low, middle and high membership, each ``0 .. one``; their sum is `one`."""
    one = config.one
    shift = criterion.label_bits - config.membership_bits
    u = np.minimum(values, 2 << criterion.label_bits) >> shift
    u = u.astype(integer(3 * one))  # u ends at 2*one; the operator `mean` sums to 3*one
    return np.maximum(one - u, 0), one - np.abs(u - one), np.maximum(u - one, 0)


def integer(maximum: int) -> np.dtype[Any]:
    """The smallest signed type that holds ``-maximum .. maximum``."""
    return np.min_scalar_type(-maximum - 1)


def _check(left: Image, right: Image, config: Config) -> None:
    check_pair(left, right, config.pixel)
    width = left.shape[1]
    if width > config.max_width:
        raise InputError(
            f"the images are {width} pixels wide, the core is built for max_width = {config.max_width}",
            f"use max_width = {width} or more, or smaller images",
        )
