"""The criteria of a configuration, and what each says about itself."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, Self

from pydantic import Field, PlainValidator, SerializeAsAny, model_validator
from pydantic_core import PydanticCustomError

from softdepth.spec.frozen import Frozen
from softdepth.spec.pixel import PixelFormat
from softdepth.spec.registry import Registry

GRADIENT_CAP = 31
"""Largest gradient that the SADs of gradients see."""
RECIPROCAL_BITS = 12
"""Fraction bits of the reciprocal of a support's number of columns."""
SUPPORT_SHIFT = 10
"""Bits that the mean of a support's columns drops: two fraction bits stay."""


class AnyCriterion(Frozen):
    """What every criterion says about itself; a new one is a subclass, registered in `CRITERIA`.

    Each has the fields ``kind``, its name, and ``label_bits``. Memberships have their labels at 0, T and 2T
    with ``T = 2**label_bits``; larger values saturate at 2T.

    With ``whole_frame``, the criterion itself says what lies outside the image, and has a value in every
    pixel. Other criteria have no value where their support leaves the image. The reaches say how far the
    support extends around the reference pixel; they are negative if it begins beyond it.
    """

    whole_frame: ClassVar[bool] = False
    kind: str
    if TYPE_CHECKING:  # each has its own default, and puts it last
        label_bits: int

    @property
    def reach_left(self) -> int:
        """Columns of the support left of the reference pixel."""
        return 0

    @property
    def reach_right(self) -> int:
        """Columns right of it."""
        return 0

    @property
    def reach_rows(self) -> int:
        """Rows above it, and below."""
        return 0

    @property
    def below(self) -> int:
        """Rows below the pixel that its value depends on."""
        return self.reach_rows

    @property
    def products(self) -> int:
        """Multiplications that a candidate's value takes."""
        return 0

    @property
    def reciprocals(self) -> tuple[int, ...]:
        """Factors that turn the sum of 1, 2, ... columns into their mean; several are a table in memory."""
        return ()

    @classmethod
    def rows_above(cls, criteria: Sequence[Self]) -> int:
        """Rows above the pixel's own that these, all of this kind, compare anew and do not remember."""
        return max(c.reach_rows for c in criteria)

    def maximum_of(self, pixel: PixelFormat) -> int:
        """The largest value of pixels of this format; the smallest is 0."""
        raise NotImplementedError


CRITERIA: Registry[type[AnyCriterion]] = Registry("criterion")
"""The criteria by `kind`."""


class Sad(AnyCriterion):
    """Criterion: sum of absolute differences over ``window x window`` pixels and channels (eq. 7).

    The window is centred ``dx`` pixels right of the reference pixel. ``source = "gradient"`` compares the
    luma's horizontal gradient, held within +-`GRADIENT_CAP`, instead of the colours. The costs of the
    window's upper `stored_rows` rows come from block RAM instead of being computed anew, which changes no
    value. All SADs of a lane share one column, and the largest `stored_rows` among them holds.
    """

    kind: Literal["sad"] = "sad"  # pyright: ignore[reportIncompatibleVariableOverride]
    source: Literal["colour", "gradient"] = "colour"
    window: int = Field(default=3, ge=1, le=15)
    dx: int = Field(default=0, ge=-16, le=16)
    stored_rows: int = Field(default=0, ge=0)
    label_bits: int = Field(default=12, ge=4, le=20)

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        check_odd(window=self.window)
        if self.stored_rows >= self.window:
            raise ValueError(
                f"stored_rows is {self.stored_rows}, but a window of {self.window} rows has"
                f" {self.window - 1} above its newest: use at most that many"
            )
        return self

    @property
    def radius(self) -> int:
        """Pixels from the window's centre to its edge."""
        return self.window // 2

    @property
    def reach_left(self) -> int:
        """Columns left of the reference pixel."""
        return self.radius - self.dx

    @property
    def reach_right(self) -> int:
        """Columns right of it."""
        return self.radius + self.dx

    @property
    def reach_rows(self) -> int:
        """Rows above it, and below."""
        return self.radius

    @classmethod
    def rows_above(cls, criteria: Sequence[Self]) -> int:
        """Those of the largest window, without the rows from memory: windows share their columns."""
        return max(c.radius for c in criteria) - max(c.stored_rows for c in criteria)

    def maximum_of(self, pixel: PixelFormat) -> int:
        """The sum where all pixels differ as much as they can."""
        most = pixel.channels * pixel.maximum if self.source == "colour" else 2 * GRADIENT_CAP
        return self.window**2 * most

    def __str__(self) -> str:
        of = " of gradient" if self.source == "gradient" else ""
        return f"sad({self.window}, {self.dx:+d}){of}"


class Census(AnyCriterion):
    """Criterion: census bits that differ, summed down a column and over columns of similar colour.

    The 24 bits of a pixel say which of the black squares of a 7x7 chessboard around it are darker
    (luma) than the pixel. The Hamming distance between the bits of both views, or `neutral` if the partner
    lies left of the right image, is summed over `rows` rows. There are `taps` such columns, `spacing` apart
    and centred on the pixel. A column counts if it lies in the image and if its pixel (in the reference view
    and the same row) differs from the centre by less than `like` in every channel. With n such columns and
    their sum s, the value is ``s * round(4096 / n) >> 10``, four times their mean. With a single tap, the
    centre, it is four times that column.

    What lies outside the image counts 0, and every pixel has a value. `like` is in units of 8-bit
    values; with 256, every column counts.

    With `running_sums`, the sums down the columns are kept in block RAM, and one row enters and one leaves.
    Without, all rows are compared anew, which takes more logic and less memory, and changes no value.
    """

    whole_frame: ClassVar[bool] = True
    bits: ClassVar[int] = 24
    kind: Literal["census"] = "census"  # pyright: ignore[reportIncompatibleVariableOverride]
    window: Literal[7] = 7
    rows: int = Field(default=9, ge=1, le=15)
    taps: int = Field(default=7, ge=1, le=15)
    spacing: int = Field(default=4, ge=1, le=8)
    like: int = Field(default=32, ge=1, le=256)
    neutral: int = Field(default=6, ge=0, le=24)
    running_sums: bool = True
    label_bits: int = Field(default=8, ge=4, le=20)

    @model_validator(mode="after")
    def _odd(self) -> Self:
        check_odd(rows=self.rows, taps=self.taps)
        return self

    @property
    def offsets(self) -> tuple[int, ...]:
        """The columns of the support, relative to the pixel's own, ascending."""
        reach = self.taps // 2
        return tuple(self.spacing * k for k in range(-reach, reach + 1))

    @property
    def reciprocals(self) -> tuple[int, ...]:
        """``round(2**RECIPROCAL_BITS / n)``, halves upwards, for n = 1 .. taps columns."""
        return tuple(((2 << RECIPROCAL_BITS) // n + 1) // 2 for n in range(1, self.taps + 1))

    @property
    def column_maximum(self) -> int:
        """The largest sum down a column."""
        return self.bits * self.rows

    def maximum_of(self, pixel: PixelFormat) -> int:
        """`maximum`, for any pixels."""
        return self.maximum

    @property
    def maximum(self) -> int:
        """The largest value."""
        counts = enumerate(self.reciprocals, start=1)
        return max(n * self.column_maximum * r >> SUPPORT_SHIFT for n, r in counts)

    @property
    def below(self) -> int:
        """Rows below the pixel that its value depends on."""
        return self.rows // 2 + self.window // 2

    @property
    def products(self) -> int:
        """One, by the reciprocal, if there is a support."""
        return int(self.taps > 1)

    @property
    def beside(self) -> int:
        """Columns to the right of the pixel (and to its left) that its value depends on."""
        return self.offsets[-1] + self.window // 2

    def __str__(self) -> str:
        return f"census({self.rows}, {self.taps} x {self.spacing})"


class Gradient(AnyCriterion):
    """Criterion: differences of the horizontal gradient, summed over ``rows x columns`` pixels.

    The gradient is the luma's Sobel, edges replicated, held within +-`cap`. A pixel's difference is at
    most `truncation`, and `neutral` if the partner lies left of the right image. What lies outside the
    image counts 0, and every pixel has a value. `running_sums` as in `Census`.
    """

    whole_frame: ClassVar[bool] = True
    kind: Literal["gradient"] = "gradient"  # pyright: ignore[reportIncompatibleVariableOverride]
    rows: int = Field(default=5, ge=1, le=15)
    columns: int = Field(default=5, ge=1, le=15)
    cap: int = Field(default=31, ge=1, le=127)
    truncation: int = Field(default=16, ge=1, le=254)
    neutral: int = Field(default=2, ge=0, le=254)
    running_sums: bool = True
    label_bits: int = Field(default=8, ge=4, le=20)

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        check_odd(rows=self.rows, columns=self.columns)
        if self.neutral > self.truncation:
            raise ValueError(
                f"neutral is {self.neutral}, more than any difference: use at most truncation ="
                f" {self.truncation}"
            )
        return self

    def maximum_of(self, pixel: PixelFormat) -> int:
        """`maximum`, for any pixels."""
        return self.maximum

    @property
    def maximum(self) -> int:
        """The largest value."""
        return self.rows * self.columns * max(min(self.truncation, 2 * self.cap), self.neutral)

    @property
    def below(self) -> int:
        """Rows below the pixel that its value depends on."""
        return self.rows // 2 + 1

    @property
    def beside(self) -> int:
        """Columns to the right of the pixel (and to its left) that its value depends on."""
        return self.columns // 2 + 1

    def __str__(self) -> str:
        return f"gradient({self.rows} x {self.columns})"


def check_odd(**sizes: int) -> None:
    """Raise `ValueError` for a size that has no centre."""
    for name, size in sizes.items():
        if size % 2 == 0:
            raise ValueError(f"{name} is {size}, but a window has a centre: use an odd size")


CRITERIA.register("sad", Sad)
CRITERIA.register("census", Census)
CRITERIA.register("gradient", Gradient)


UNKNOWN_KIND = "unknown_kind"
"""The type of the error for a criterion of an unknown kind."""


def criterion_of(data: Any) -> AnyCriterion:
    """The criterion that plain data describe: a SAD if they have no `kind`."""
    if isinstance(data, AnyCriterion):
        return data
    kind = data.get("kind", "sad") if isinstance(data, dict) else "sad"
    if kind not in CRITERIA:
        raise PydanticCustomError(UNKNOWN_KIND, "{kind}", {"kind": kind})
    return CRITERIA[kind].model_validate(data)


Criterion = Annotated[SerializeAsAny[AnyCriterion], PlainValidator(criterion_of)]
"""A field that takes any registered criterion."""
