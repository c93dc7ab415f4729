"""How wide costs are behind the lanes."""


def cost_bits(maximum: int) -> int:
    """Bits of a cost and of one that is larger than any, all ones: it stands for none."""
    return (maximum + 1).bit_length()
