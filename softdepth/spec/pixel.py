"""What a pixel is: gray or RGB, of 8, 10 or 12 bits a channel."""

from enum import StrEnum


class PixelFormat(StrEnum):
    """A pixel's channels and their bits, by name (``gray12``).

    Channels lie side by side in a word, red lowest. In files and on a link every channel takes
    `channel_bytes`, little endian.
    """

    RGB8 = "rgb8"
    RGB10 = "rgb10"
    RGB12 = "rgb12"
    GRAY8 = "gray8"
    GRAY10 = "gray10"
    GRAY12 = "gray12"

    @property
    def channels(self) -> int:
        """1 of gray pixels, 3 of red, green and blue."""
        return 1 if self.startswith("gray") else 3

    @property
    def bits(self) -> int:
        """Bits of a channel."""
        return int(self.removeprefix("gray").removeprefix("rgb"))

    @property
    def maximum(self) -> int:
        """The largest value of a channel."""
        return (1 << self.bits) - 1

    @property
    def size(self) -> int:
        """Bits of a pixel."""
        return self.channels * self.bits

    @property
    def channel_bytes(self) -> int:
        """Bytes of a channel in memory and on a link."""
        return -(-self.bits // 8)

    @property
    def bytes(self) -> int:
        """Bytes of a pixel in memory and on a link."""
        return self.channels * self.channel_bytes
