"""The compensating rule (Bobyr et al. 2021)."""

from collections.abc import Sequence
from typing import Literal

from pydantic import Field

from softdepth.spec.criteria import AnyCriterion, Sad
from softdepth.spec.frozen import Frozen

Reading = Literal["off", "top", "literal"]

LITERAL_INPUT = 1000
"""The value that the compensating rule's literal reading gives every criterion."""


class Compensation(Frozen):
    """The compensating rule against false near objects (paper, section 4, step 3).

    Candidates with ``d >= from_disparity`` whose SAD exceeds ``threshold`` have all criteria
    replaced: by the top label 2T (``top``) or by 1000 (``literal``). ``criterion`` says which SAD is
    looked at: 0 is the centred 3x3 one of eq. 7, 1 to 3 the criterion of that number. The paper's
    Fig. 4 is met by ``top`` looking at criterion 3.
    """

    reading: Reading = "off"
    threshold: int = Field(default=1200, ge=0)
    from_disparity: int = Field(default=32, ge=-256)
    criterion: int = Field(default=0, ge=0, le=3)

    def judged(self, criteria: Sequence[AnyCriterion]) -> int | None:
        """Index of the criterion whose SAD is looked at, if there is such a one."""
        if self.criterion:
            return self.criterion - 1
        found = [
            i
            for i, c in enumerate(criteria)
            if isinstance(c, Sad) and (c.window, c.dx, c.source) == (3, 0, "colour")
        ]
        return found[0] if found else None
