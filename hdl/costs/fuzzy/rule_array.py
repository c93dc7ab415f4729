"""The rule base as hardware (Bobyr et al. 2021, step 3, table 1), factorised."""

from amaranth.hdl import Module
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.pipeline import Pipeline, clocks, start, tree_operations
from softdepth.hdl.arithmetic.word import Word
from softdepth.hdl.costs.fuzzy.membership import memberships_layout
from softdepth.hdl.costs.fuzzy.operators import OPERATORS
from softdepth.spec.config import Config
from softdepth.spec.rules import CONCLUSIONS, rule_base

LABELS = {1: "low", 2: "middle", 3: "high"}

Pairs = frozenset[tuple[int, int]]


class RuleArray(wiring.Component):
    """The eleven conclusions ``Y_1 .. Y_11`` of three criteria's memberships, one set a clock.

    Theta is monotone, so the maximum moves inside it: ``max(T(a, p), T(a, q)) = T(a, max(p, q))``.
    Rules that agree in criterion 1 are joined before Theta, and pairs of criteria 2 and 3 that
    several conclusions need are built once: for the printed table 22 Thetas and 8 maxima instead of
    54 and 16.

    Members
    -------
    i : the memberships of criteria 1, 2 and 3.
    o : ``y1 .. y11``, `latency` clocks later, each within `Config.strength_range`.
    """

    def __init__(self, config: Config) -> None:
        self._config = config
        self._operator = OPERATORS[config.operator](config)
        # What every conclusion needs: for each label of criterion 1, the pairs of the other two.
        self._needs: dict[int, dict[int, Pairs]] = {
            k: {a: frozenset((b, c) for a_, b, c in rules if a_ == a) for a in {rule[0] for rule in rules}}
            for k, rules in rule_base(config.rules).items()
        }
        widest = max(len(pairs) for by_label in self._needs.values() for pairs in by_label.values())
        pairs = self._operator.pair_operations + tree_operations(widest)
        most = max(len(by_label) for by_label in self._needs.values())
        operations = pairs + self._operator.fire_operations + tree_operations(most)
        self._start = start(operations)
        self._pairs_ready = self._start + pairs
        self._ready = self._start + operations
        self.latency = clocks(operations)
        low, high = config.strength_range
        strength = range(low, high + 1)
        super().__init__(
            {
                "i": In(data.ArrayLayout(memberships_layout(config), 3)),
                "o": Out(data.StructLayout({f"y{k}": strength for k in range(1, CONCLUSIONS + 1)})),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        pipeline = Pipeline(m)

        def membership(criterion: int, label: int) -> Word:
            return pipeline.input(
                self.i[criterion - 1][LABELS[label]],
                self._config.one,
                f"{LABELS[label]}_{criterion}",
                time=self._start,
            )

        joined: dict[Pairs, Word] = {}

        def join(pairs: Pairs) -> Word:
            """The maximum over ``pairs``, from parts that other conclusions need too."""
            if pairs not in joined:
                if len(pairs) == 1:
                    ((b, c),) = pairs
                    joined[pairs] = self._operator.pair(pipeline, membership(2, b), membership(3, c))
                else:
                    part = max(
                        (known for known in self._shared() if known < pairs),
                        key=len,
                        default=frozenset(sorted(pairs)[: len(pairs) // 2]),
                    )
                    joined[pairs] = pipeline.max(join(part), join(pairs - part))
            return joined[pairs]

        for k, by_label in self._needs.items():
            fired = [
                self._operator.fire(pipeline, membership(1, a), join(pairs).at(self._pairs_ready))
                for a, pairs in sorted(by_label.items())
            ]
            strength = pipeline.tree(pipeline.max, fired).at(self._ready)
            assert (strength.minimum, strength.maximum) == self._config.strength_range
            m.d.comb += self.o[f"y{k}"].eq(strength.value)
        return m

    def _shared(self) -> list[Pairs]:
        """The sets of pairs that conclusions need whole, in a fixed order."""
        needed = {pairs for by_label in self._needs.values() for pairs in by_label.values()}
        return sorted(needed, key=sorted)
