"""Functions of words that become part of the operation after them: choices and complements."""

from collections.abc import Callable

from amaranth.hdl import Cat, Mux, Value

from softdepth.hdl.arithmetic.word import Word


def wire(function: Callable[..., Value], *words: Word, minimum: int, maximum: int) -> Word:
    """A function of words, and the range of its value."""
    pipeline = words[0].pipeline
    words = pipeline.aligned(*words)
    value = function(*(word.value for word in words))
    name = "_".join(word.name for word in words)
    return Word(value, minimum, maximum, words[0].time, name, pipeline)


def flag(function: Callable[..., Value], *words: Word) -> Word:
    """A condition on words."""
    return wire(function, *words, minimum=0, maximum=1)


def choose(condition: Word, a: Word | int, b: Word | int) -> Word:
    """``a`` where the condition holds, else ``b``."""
    a, b = (
        word if isinstance(word, Word) else condition.pipeline.constant(word, condition.time)
        for word in (a, b)
    )
    low, high = min(a.minimum, b.minimum), max(a.maximum, b.maximum)
    return wire(Mux, condition, a, b, minimum=low, maximum=high).named(f"{a.name}_or_{b.name}")


def inverted_if(condition: Word, word: Word) -> Word:
    """The one's complement where the condition holds, else ``word``, which is not negative."""

    def invert(v: Value, c: Value) -> Value:
        return (Cat(v, 0) ^ c.replicate(len(v) + 1)).as_signed()

    inverted = wire(invert, word, condition, minimum=-word.maximum - 1, maximum=word.maximum)
    return inverted.named(word.name)
