"""Functions of words that are part of the operation that follows: choices, masks and complements."""

from collections.abc import Callable

from amaranth.hdl import Cat, Const, Mux, Shape, Value

from softdepth.hdl.arithmetic.pipeline import Pipeline, Word


def wire(
    pipeline: Pipeline, function: Callable[..., Value], *words: Word, minimum: int, maximum: int
) -> Word:
    """A function of words, and the range of its value."""
    words = pipeline.aligned(*words)
    return Word(function(*(word.value for word in words)), minimum, maximum, words[0].time)


def constant(value: int, beside: Word) -> Word:
    """A constant of the time of a word."""
    return Word(Const(value, Shape.cast(range(min(value, 0), max(value, 1) + 1))), value, value, beside.time)


def flag(pipeline: Pipeline, function: Callable[..., Value], *words: Word) -> Word:
    """A condition on words."""
    return wire(pipeline, function, *words, minimum=0, maximum=1)


def choose(pipeline: Pipeline, condition: Word, a: Word, b: Word) -> Word:
    """``a`` where the condition holds, else ``b``."""
    low, high = min(a.minimum, b.minimum), max(a.maximum, b.maximum)
    return wire(pipeline, Mux, condition, a, b, minimum=low, maximum=high)


def masked(pipeline: Pipeline, word: Word, condition: Word, keep: int = 1) -> Word:
    """``word`` where the condition is ``keep``, else 0."""
    low, high = min(word.minimum, 0), max(word.maximum, 0)
    return wire(
        pipeline,
        lambda value, kept: Mux(kept if keep else ~kept, value, 0),
        word,
        condition,
        minimum=low,
        maximum=high,
    )


def inverted(pipeline: Pipeline, word: Word) -> Word:
    """The one's complement, ``-word - 1``."""
    return wire(pipeline, lambda v: ~_signed(v), word, minimum=-word.maximum - 1, maximum=-word.minimum - 1)


def inverted_if(pipeline: Pipeline, condition: Word, word: Word) -> Word:
    """The one's complement where the condition holds, else ``word``, which is not negative."""

    def invert(v: Value, c: Value) -> Value:
        return (Cat(v, 0) ^ c.replicate(len(v) + 1)).as_signed()

    return wire(pipeline, invert, word, condition, minimum=-word.maximum - 1, maximum=word.maximum)


def _signed(value: Value) -> Value:
    return value if value.shape().signed else Cat(value, 0).as_signed()
