"""The counters of faults that a core shows."""

from softdepth.hdl.signatures import Status


def unpack_status(word: int) -> dict[str, int]:
    """Those of the packed `Status` port, by name."""
    counters = Status.from_bits(word)
    return {name: counters[name] for name in Status.members}
