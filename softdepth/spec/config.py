"""The one configuration of a core: what is computed, and how much hardware computes it.

A `Config` is frozen and validated. Presets come by name, files are TOML, and single keys can be
overridden (``lanes=8``, ``compensation.reading=off``, ``criteria.0.window=5``). Every width, range
and reach that the models and the gateware need is a property here, derived from these fields.
"""

from functools import cached_property
from typing import Any, Literal, Self

from pydantic import Field, field_validator, model_validator

from softdepth.spec import consistency, ranges, stored_rows
from softdepth.spec.compensation import LITERAL_INPUT, Compensation
from softdepth.spec.criteria import AnyCriterion, Census, Criterion, Gradient, Sad
from softdepth.spec.operators import REGISTRY
from softdepth.spec.pixel import PixelFormat
from softdepth.spec.post import Post
from softdepth.spec.presets import PRESETS
from softdepth.spec.ranges import MULTIPLIER_BITS, QUOTIENT_BITS
from softdepth.spec.rules import Firing, RuleBaseName
from softdepth.spec.settings import Settings

__all__ = [
    "LITERAL_INPUT",
    "MULTIPLIER_BITS",
    "OPERATORS",
    "PRESETS",
    "QUOTIENT_BITS",
    "AnyCriterion",
    "Census",
    "Compensation",
    "Config",
    "Criterion",
    "Gradient",
    "Operator",
    "PixelFormat",
    "Post",
    "Sad",
]

Operator = str
"""The name of a registered operator."""

OPERATORS: tuple[Operator, ...] = ("min", "prod", "mean", "soft_min_1", "soft_min_2")
"""The paper's operators, in its order; `softdepth.spec.operators.REGISTRY` has all."""

NARROWEST = 4
"""Pixels of the shortest line that the memories of lines can follow."""
CONFIDENCE_BITS = 8


class Config(Settings):
    """A stereo core, complete: method, ranges and parallelism.

    Throughput is one result per `steps` clocks. See ``docs/configuration.md`` for every key.
    """

    name: str = "custom"
    disparities: int = Field(default=64, ge=2, le=256)
    min_disparity: int = Field(default=0, ge=-256, le=256)
    lanes: int = Field(default=16, ge=1, le=256)
    max_width: int = Field(default=1280, ge=8, le=8192)
    max_height: int = Field(default=1080, ge=8, le=8192)
    pixel: PixelFormat = Field(default=PixelFormat.RGB8, strict=False)
    reference: Literal["left", "right"] = "left"
    cost: Literal["fuzzy", "sum"] = "fuzzy"
    operator: Operator = "mean"
    softness: float = Field(default=0.05, ge=0, le=1)
    sharpness: float = Field(default=-100.0, ge=-500, le=500)
    max_multipliers: int = Field(default=156, ge=0)
    rules: RuleBaseName = "printed"
    firing: Firing = "all"
    membership_bits: int = Field(default=8, ge=2, le=12)
    criteria: tuple[Criterion, ...] = Field(
        default=(Sad(window=3), Sad(window=5), Sad(window=7)), strict=False
    )
    compensation: Compensation = Compensation()
    post: Post = Post()

    @model_validator(mode="before")
    @classmethod
    def _stored_rows_of_all(cls, given: Any) -> Any:
        """``stored_rows`` beside the criteria sets it for the highest SAD window, which all SADs share."""
        if not isinstance(given, dict) or stored_rows.KEY not in given:
            return given
        return stored_rows.of_the_highest(given, cls.model_fields["criteria"].default)

    @field_validator("cost", mode="before")
    @classmethod
    def _earlier_name(cls, value: Any) -> Any:
        """``sad`` is the earlier name of the sum, when it was of one criterion."""
        return "sum" if value == "sad" else value

    @field_validator("operator")
    @classmethod
    def _known(cls, name: str) -> str:
        if name not in REGISTRY:
            raise ValueError(f"it is not an operator: use one of {REGISTRY.choices()}")
        return name

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        consistency.check(self)
        return self

    def shaping(self) -> dict[str, Any]:
        """As in `Settings`; rows in memory count as what all SADs share, whichever of them states it."""
        data = super().shaping()
        for criterion in data["criteria"]:
            criterion.pop(stored_rows.KEY, None)
            if criterion.get("running_sums"):  # as it always was: hashes of earlier cores stay
                del criterion["running_sums"]
        data["post"] = self.post.shaping()
        return data | {stored_rows.KEY: self.stored_rows}

    # -- derived: parallelism and ranges ---------------------------------------------------------

    @property
    def steps(self) -> int:
        """Clocks per pixel: each step evaluates `lanes` candidates."""
        return self.disparities // self.lanes

    @property
    def windows(self) -> tuple[int, ...]:
        """The distinct SAD window sizes, ascending."""
        return tuple(sorted({c.window for c in self.sads}))

    # -- derived: criteria by kind, and what their results look like ------------------------------

    @property
    def sads(self) -> tuple[Sad, ...]:
        """The SADs among the criteria."""
        return tuple(c for c in self.criteria if isinstance(c, Sad))

    @property
    def stored_rows(self) -> int:
        """Rows of the SADs' columns whose costs come from memory: the most that one of them states."""
        return max((c.stored_rows for c in self.sads), default=0)

    @property
    def gradient(self) -> Gradient | None:
        """The gradient among the criteria, where there is one and no more."""
        found = [c for c in self.criteria if isinstance(c, Gradient)]
        return found[0] if len(found) == 1 else None

    @property
    def whole_frame(self) -> bool:
        """Every pixel has a result: no criterion has a border band."""
        return all(c.whole_frame for c in self.criteria)

    @property
    def result_bits(self) -> int:
        """Bits of a result's disparity, `Post.fraction_bits` of them below one pixel.

        It is signed where there are negative candidates.
        """
        low, stop = (d << self.post.fraction_bits for d in (self.min_disparity, self.max_disparity + 1))
        return max((stop - 1).bit_length(), (~low).bit_length() if low < 0 else 0) + self.signed

    @property
    def signed(self) -> bool:
        """A result may be negative."""
        return self.min_disparity < 0

    @property
    def colour_bits(self) -> int:
        """Bits of each channel that travel with a result: what the stages after the winners compare."""
        return min(self.post.colour_bits, self.pixel.bits) if self.post.masked_median else self.pixel.bits

    @property
    def code_bits(self) -> int:
        """Bits of a result's `Validity` code."""
        return 3 if self.post.any or any(c.whole_frame for c in self.criteria) else 2

    # -- derived: reach of the support around the reference pixel, in pixels ---------------------
    # These speak of the border band: criteria that count what is outside as 0 have none.

    @property
    def reach_left(self) -> int:
        """Columns that a pixel with a result has to its left: its support, and where candidates begin."""
        return self.window_left + max(self.min_disparity, 0)

    @property
    def reach_right(self) -> int:
        """Columns that a pixel with a result has to its right: its support, and negative candidates."""
        return self.window_right + max(-self.min_disparity, 0)

    @property
    def window_left(self) -> int:
        """Columns the support extends left of the reference pixel."""
        return max(0, 0, *(c.reach_left for c in self.criteria))

    @property
    def window_right(self) -> int:
        """Columns the support extends right of the reference pixel."""
        return max(0, 0, *(c.reach_right for c in self.criteria))

    @property
    def max_disparity(self) -> int:
        """The last candidate."""
        return self.min_disparity + self.disparities - 1

    @property
    def reach_rows(self) -> int:
        """Rows the support extends above, and below, the reference pixel."""
        return max(0, 0, *(c.reach_rows for c in self.criteria))

    @property
    def min_width(self) -> int:
        """The narrowest legal frame: one full support, and the views overlap in no less than `NARROWEST`."""
        return max(self.reach_left + 1 + self.reach_right, NARROWEST + abs(self.min_disparity))

    @property
    def min_height(self) -> int:
        """The lowest frame with a result: one full support. Lower frames yield border codes only."""
        return 2 * self.reach_rows + 1

    @property
    def column_rows(self) -> int:
        """Rows that lanes get of a column, the newest last: as far up as any criterion compares anew."""
        kinds = {type(c) for c in self.criteria}
        above = max(kind.rows_above([c for c in self.criteria if type(c) is kind]) for kind in kinds)
        return self.reach_rows + 1 + above

    @property
    def places(self) -> int:
        """Steps of the longest line: the columns that a lane sees, candidates counted apart."""
        return self.max_width * self.steps

    # -- derived: numbers of the fuzzy stage -----------------------------------------------------

    @property
    def one(self) -> int:
        """The membership value that means 1.0."""
        return 1 << self.membership_bits

    @property
    def by_cell(self) -> bool:
        """Whether only the eight rules around the criteria can count, by choice or by the operator.

        The others have a membership of 0, and with MIN and PROD a strength of 0.
        """
        return self.firing == "cell" or REGISTRY[self.operator].zeroing

    @cached_property
    def maxima(self) -> tuple[int, ...]:
        """The largest value of each criterion."""
        return tuple(c.maximum_of(self.pixel) for c in self.criteria)

    @cached_property
    def strength_range(self) -> tuple[int, int]:
        """Smallest and largest firing strength of a rule, in the operator's own scale.

        The mean leaves out its 1/3 (it cancels in N/S); soft-min I goes below zero, as eq. 5 does.
        """
        return REGISTRY[self.operator].strength_range(self)

    @cached_property
    def cost_range(self) -> tuple[tuple[int, int], tuple[int, int]]:
        """Smallest and largest numerator, and the same of the denominator, of a candidate's cost."""
        return ranges.costs(self)

    @property
    def number_range(self) -> tuple[int, int]:
        """Smallest and largest cost as a whole number, as margins and fractions of a pixel take it.

        A sum is one. A fuzzy cost N / S, a mean of weights, is ``floor(N * 2**QUOTIENT_BITS / S)``, held
        within this range.
        """
        return ranges.numbers(self)

    @property
    def confidence_shift(self) -> int:
        """Bits that a margin drops to become a confidence."""
        low, high = self.number_range
        return max(0, (high - low).bit_length() - CONFIDENCE_BITS - 2)

    @property
    def multipliers(self) -> int:
        """Multipliers of `MULTIPLIER_BITS` that the core takes: exact comparisons of fractions, products
        of PROD, and the reciprocals of censuses with a support, one a lane.
        """
        return ranges.multipliers(self)

    @property
    def compensation_criterion(self) -> int | None:
        """Index of the criterion that the compensating rule looks at, if there is such a one."""
        return self.compensation.judged(self.criteria)
