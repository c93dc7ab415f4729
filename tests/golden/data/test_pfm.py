"""PFM as files really are: ends of lines, blanks, scales and byte orders; nonsense is refused."""

from itertools import product
from pathlib import Path

import numpy as np
import pytest

from softdepth.golden.data.pfm import read_pfm
from softdepth.golden.data.truth import read_truth
from softdepth.spec.errors import InputError

VALUES = np.array([[1.5, -6, np.inf], [0, 62.25, 3]], np.float32)


def pfm(header: bytes, order: str = "<f4", values: np.ndarray = VALUES) -> bytes:
    return header + values[::-1].astype(order).tobytes()


@pytest.mark.parametrize(
    ("end", "blanks"), list(product([b"\n", b"\r\n", b"\r"], [b"", b" ", b"\t ", b"   "]))
)
@pytest.mark.parametrize("first", [1.5, None])
def test_ends_of_lines_and_blanks(end: bytes, blanks: bytes, first: float | None) -> None:
    """Also where the first value begins with a byte that looks like the end of a line, or a blank."""
    values = VALUES.copy()
    for looks in [b""] if first else [b"\n", b"\r", b" ", b"\t"]:
        if looks:
            values[1, 0] = np.frombuffer(looks + b"\x00\x80\x3f", "<f4")[0]
        header = b"Pf" + end + b"3 2" + blanks + end + b"-1.0" + blanks + end
        np.testing.assert_array_equal(read_pfm(pfm(header, values=values), "x.pfm"), values)


@pytest.mark.parametrize("size", [b"1", b"0.003922", b"1e-3", b"255", b"+2.5", b"1000000.0"])
@pytest.mark.parametrize(("sign", "order"), [(b"-", "<f4"), (b"", ">f4")])
def test_scale_gives_the_byte_order_alone(size: bytes, sign: bytes, order: str) -> None:
    header = b"Pf\n3 2\n" + sign + size.lstrip(b"+" if sign else b"") + b"\n"
    np.testing.assert_array_equal(read_pfm(pfm(header, order), "x.pfm"), VALUES)


@pytest.mark.parametrize(
    ("header", "problem"),
    [
        (b"Pf\n3 2\n0\n", "its scale is '0'"),
        (b"Pf\n3 2\n-0.0\n", "its scale is '-0.0'"),
        (b"Pf\n3 2\nnan\n", "its scale is 'nan'"),
        (b"Pf\n3 2\n-inf\n", "its scale is '-inf'"),
        (b"Pf\n3 2\n1.2.3\n", "its scale is '1.2.3'"),
        (b"Pf\n3 2\n-\n", "its scale is '-'"),
        (b"Pf\n3 2\nee\n", "its scale is 'ee'"),
        (b"Pf\n-3 2\n-1\n", "a side of '-3'"),
        (b"Pf\n3.0 2\n-1\n", "a side of '3.0'"),
        (b"Pf\n0 2\n-1\n", "a side of '0'"),
        (b"Pf\n3 99999999\n-1\n", "a side of 99999999"),
        (b"PF\n3 2\n-1\n", "three-channel"),
        (b"Pf\n3 1\n-1\n", "holds 24 bytes after its header, but 3x1 values take 12"),
        (b"Pf\n3 3\n-1\n", "cut short"),
        (b"Pf\n", "broken PFM header"),
    ],
)
def test_headers_that_make_no_sense(header: bytes, problem: str) -> None:
    with pytest.raises(InputError, match=r"'x\.pfm'") as caught:
        read_pfm(pfm(header), "x.pfm")
    assert problem in caught.value.problem


def test_a_line_feed_after_the_values_is_no_harm() -> None:
    np.testing.assert_array_equal(read_pfm(pfm(b"Pf\n3 2\n-1\n") + b"\n", "x.pfm"), VALUES)


@pytest.mark.parametrize("order", ["<f4", ">f4"])
def test_the_wrong_byte_order_is_told(tmp_path: Path, order: str) -> None:
    """Bytes in the order that the sign denies are huge or tiny numbers: no disparities."""
    values = np.linspace(3, 60, 12, dtype=np.float32).reshape(3, 4)
    sign = b"1" if order == "<f4" else b"-1"
    (path := tmp_path / "d.pfm").write_bytes(pfm(b"Pf\n4 3\n" + sign + b"\n", order, values))
    with pytest.raises(InputError, match="byte order"):
        read_truth(path)
