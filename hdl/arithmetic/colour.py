"""Likeness of two colours, and colours of fewer bits."""

from amaranth.hdl import Cat, Value


def coarse(colour: Value, channels: int, kept: int) -> Value:
    """The ``kept`` highest bits of each channel of a colour; all, where a channel has no more."""
    colour = Value.cast(colour)
    bits = len(colour) // channels
    dropped = max(bits - kept, 0)
    return Cat(colour[start + dropped : start + bits] for start in range(0, len(colour), bits))


def coarse_like(like: Value | int, dropped: int) -> Value | int:
    """``like`` as a limit for colours without their ``dropped`` lowest bits, rounded up."""
    return (like + (1 << dropped) - 1) >> dropped if dropped else like


def alike(a: Value, b: Value, channels: int, like: Value | int) -> Value:
    """Whether no channel of two colours differs by ``like`` or more, without a register.

    Where ``like`` is a power of two, the difference's upper bits tell, all alike, but for ``-like`` itself:
    half the logic of two comparisons.
    """
    a, b = Value.cast(a), Value.cast(b)
    bits = len(a) // channels
    low = like.bit_length() - 1 if isinstance(like, int) else 0
    near: list[Value] = []
    for start in range(0, len(a), bits):
        difference = a[start : start + bits] - b[start : start + bits]
        if not isinstance(like, int) or like != 1 << low:
            near.append((difference < like) & (difference > -like))
        elif low < bits:
            upper, lower = difference[low:], difference[:low]
            near.append(~upper.any() | (upper.all() & lower.any()))
    return Cat(*near).all() if near else Cat(1).all()
