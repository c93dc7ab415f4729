"""Census, gradient and post-processing in a configuration: what is refused, and what is derived."""

import pytest

from softdepth.spec.config import Census, Config, Gradient, Sad
from softdepth.spec.errors import ConfigError
from softdepth.spec.pixel import PixelFormat


@pytest.mark.parametrize(
    ("changes", "error"),
    [
        (["criteria.0.kind=cencus"], "criteria.0.kind is cencus; use one of sad, census, gradient"),
        (["criteria.0.taps=2"], "criteria.0: taps is 2, but a window has a centre; use an odd size"),
        (["criteria.1.rows=4"], "criteria.1: rows is 4, but a window has a centre; use an odd size"),
        (["criteria.1.neutral=17"], "criteria.1: neutral is 17, more than any difference;"),
        (["criteria.1.foo=5"], "unknown key 'criteria.1.foo'; known keys: kind, rows, columns, cap"),
        (["post.foo=1"], "unknown key 'post.foo'; known keys: check, tolerance, island"),
        (["post.check=false", "post.tolerance=2"], "post: tolerance is 2 without a check;"),
        (["post.median=3"], "post.median = 3 is not valid"),
        (["post.island_columns=9"], "post: island_rows x island_columns is 45 pixels; use at most 31"),
        (["post.island_rows=1"], "post: island is 8, but there are 1 x 5 pixels around; use at most 5"),
        (["post.masked_spacing=5"], "post.masked_spacing = 5 is not valid"),
        (["cost=fuzzy"], "criteria has 2 entries, but cost = 'fuzzy' takes 3"),
        (["stored_rows=1"], "stored_rows is 1, but a window of 1 rows"),
        (["max_multipliers=31"], "takes 32 multipliers"),
    ],
)
def test_what_is_wrong_is_told_in_a_line(changes, error):
    with pytest.raises(ConfigError) as found:
        Config.preset("robust").override(changes)
    assert error in str(found.value)


def test_a_robust_core_has_a_result_in_every_pixel():
    config = Config.preset("robust")
    assert config.whole_frame
    assert (config.min_width, config.min_height) == (4, 1)
    assert (config.code_bits, config.result_bits) == (3, 10)
    kinds = [{"kind": "census"}, {"kind": "gradient"}, {"window": 5, "dx": 1}]
    mixed = Config.from_dict({"criteria": kinds})
    assert not mixed.whole_frame
    assert (mixed.reach_left, mixed.reach_right, mixed.reach_rows, mixed.code_bits) == (1, 3, 2, 3)
    assert Config.preset("paper").code_bits == 2


def test_files_keep_every_key(tmp_path):
    for name in ("robust", "robust-gray", "robust-small", "sad"):
        config = Config.preset(name).override(["post.like=9"])
        config.save(tmp_path / f"{name}.toml")
        assert Config.load(tmp_path / f"{name}.toml") == config


def test_windows_of_the_filters():
    def post(**changes):
        return (
            Config.preset("robust").override([f"post.{key}={value}" for key, value in changes.items()]).post
        )

    assert post().masked_along == post().masked_down == tuple(range(-9, 10))
    assert post(masked_median=5, masked_spacing=2, masked_rows=1).masked_along == (-4, -2, 0, 2, 4)
    assert post(masked_median=5, masked_rows=1).masked_down == (-1, 0, 1)
    assert post(masked_median=2, masked_spacing=4).masked_along == (-2, 0, 2)
    assert post(masked_median=0).masked_along == post(masked_median=0).masked_down == (0,)
    assert post(island=3, island_rows=1, masked_rows=4).below == 0 + 2 + 4
    small = Config.preset("robust-small")
    assert (small.colour_bits, small.override(["post.masked_median=0"]).colour_bits) == (5, 8)
    assert small.override(["pixel=gray12"]).colour_bits == 5


def test_keys_that_came_later_leave_hashes_as_they_were():
    assert Config.preset("robust").hash == "1c9f7235e0d4"
    assert Config.preset("robust").override(["post.colour_bits=7"]).hash != "1c9f7235e0d4"


def test_the_earlier_name_of_the_sum_is_read():
    assert Config.preset("sad").override(["cost=sad"]) == Config.preset("sad")


def test_the_largest_values():
    """Every bit unlike in every column that counts, for each number of columns."""
    for taps in (1, 3, 7, 15):
        census = Census(taps=taps, rows=5)
        sums = [24 * 5 * n for n in range(1, taps + 1)]
        assert census.maximum == max(s * r >> 10 for s, r in zip(sums, census.reciprocals, strict=True))
        assert len(census.offsets) == taps
        assert sum(census.offsets) == 0
    assert Census().reciprocals == (4096, 2048, 1365, 1024, 819, 683, 585)
    assert Census().maximum == 864
    assert Gradient(cap=3, truncation=16).maximum == 25 * 6
    assert Gradient().maximum == 25 * 16
    assert Sad(window=3, source="gradient").maximum_of(PixelFormat.RGB8) == 9 * 62
    assert Config.preset("robust").cost_range == ((0, 864 + 400), (1, 1))
