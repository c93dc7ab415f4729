"""What a proof is of, told where it is proven: the table of docs/verification.md is made from it."""

from dataclasses import dataclass

import pytest


@dataclass(frozen=True)
class Claim:
    """A property that tests prove, and that they refute of blocks with faults.

    Members
    -------
    what : the property, as a row of the table begins.
    sizes : of what it is proven.
    depth : ``every run``, ``structure``, or ``N clocks``; several where tests go to different depths. A test
        that goes to another one fails.
    """

    what: str
    sizes: str
    depth: str

    @property
    def proven(self) -> pytest.MarkDecorator:
        """The mark of a test that proves it."""
        return pytest.mark.proves(self)

    @property
    def refuted(self) -> pytest.MarkDecorator:
        """The mark of a test that refutes it of a block with a fault, which the test's name or case tells."""
        return pytest.mark.refutes(self)
