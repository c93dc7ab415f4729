"""What the package's bench sends, and what must come back, by the fixed-point model."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from softdepth.golden import fixed_model
from softdepth.golden.data import synthetic
from softdepth.golden.front.pair import Image
from softdepth.hdl.axi.tdata import CHANNELS, DISPARITY_BITS, outcome_layout, pair_bits
from softdepth.spec.config import Config

FRAMES = 2
EXTRA_WIDTH, EXTRA_HEIGHT = 32, 12
"""How much wider and higher than the least that gives a measurement a frame is, where the core allows."""

Words = NDArray[np.object_]
"""Words of any number of bits."""


@dataclass(frozen=True)
class BenchFrames:
    """Frames as words, one a line and first to last: ``{tlast, tuser, tdata}`` from the highest bit on.

    Members
    -------
    width, height : of each frame.
    sent, expected : hexadecimal, as Verilog's ``$readmemh`` reads it.
    """

    width: int
    height: int
    sent: str
    expected: str


def bench_frames(config: Config, *, left: bool = False) -> BenchFrames:
    """Textured frames with true disparities, and their results with the registers as after reset.

    With `left`, results carry their pixel of the left view. A missing disparity is 0 in the model, and so is
    ``INVALID`` after reset.
    """
    width = min(config.max_width, max(config.min_width, config.disparities) + EXTRA_WIDTH)
    height = min(config.max_height, config.min_height + EXTRA_HEIGHT)
    disparities = max(synthetic.MIN_DISPARITIES, min(config.disparities, synthetic.MAX_DISPARITIES, width))
    sent, expected = [], []
    for seed in range(FRAMES):
        scene = synthetic.generate("random", width=width, height=height, disparities=disparities, seed=seed)
        pair = scene.as_format(config.pixel)
        sent += _marked(_pixels(pair.left, pair.right, config), pair_bits(config.pixel))
        words = _outcomes(pair.left, pair.right, config)
        layout = outcome_layout(config, left=left)
        if left:
            words |= _packed(pair.left, config) << layout["left"].offset
        expected += _marked(words, layout.size)
    return BenchFrames(width, height, _hex(sent), _hex(expected))


def _pixels(left: Image, right: Image, config: Config) -> Words:
    """``s_axis_tdata`` of each pixel."""
    return _packed(left, config) | _packed(right, config) << config.pixel.size


def _packed(image: Image, config: Config) -> Words:
    """A view's pixels in UG934's order."""
    pixel = config.pixel
    channels = image.reshape(*image.shape[:2], pixel.channels).astype(object)
    words = np.zeros(image.shape[:2], object)
    for place, channel in enumerate(CHANNELS[pixel.channels]):
        words |= channels[..., channel] << place * pixel.bits
    return words


def _outcomes(left: Image, right: Image, config: Config) -> Words:
    """``m_axis_tdata`` of each result."""
    result = fixed_model.disparity(left, right, config)
    layout = outcome_layout(config)
    values = {
        "disparity": result.disparity.astype(object) % (1 << DISPARITY_BITS),
        "code": result.code,
        **({"confidence": result.confidence} if result.confidence is not None else {}),
    }
    words = np.zeros(left.shape[:2], object)
    for name, value in values.items():
        words |= value.astype(object) << layout[name].offset
    return words


def _marked(words: Words, bits: int) -> list[int]:
    """A frame's words with their markers above `bits`."""
    words[0, 0] |= 1 << bits
    words[:, -1] |= 2 << bits
    return words.ravel().tolist()


def _hex(words: list[int]) -> str:
    return "".join(f"{word:x}\n" for word in words)
