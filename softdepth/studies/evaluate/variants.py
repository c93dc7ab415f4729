"""The configurations that the question "fuzzy or not?" compares, over the same criteria."""

from softdepth.spec.config import OPERATORS, Config

_CRITERIA = [
    {"kind": "census", "label_bits": 8},
    {"kind": "gradient", "label_bits": 8},
    {"kind": "gradient", "rows": 9, "columns": 9, "label_bits": 9},
]
"""Those of `robust`, and that of `robust-small`: the fuzzy stage takes three."""

_GRADIENT_NEST = [{"window": w, "source": "gradient", "label_bits": 10} for w in (3, 5, 7)]


def compared() -> dict[str, Config]:
    """All of them."""
    return {**fuzzy_or_not(), **paper_on_gradient()}


def fuzzy_or_not() -> dict[str, Config]:
    """By name: the sum, and fuzzy inference with each operator, of the same criteria and post-processing."""
    base = Config.preset("robust").model_dump(mode="json") | {"criteria": _CRITERIA, "max_multipliers": 9999}
    found = {"sum of three": Config.from_dict(base | {"name": "sum of three"})}
    for operator in OPERATORS:
        name = f"fuzzy {operator}"
        found[name] = Config.from_dict(base | {"name": name, "cost": "fuzzy", "operator": operator})
    return found


def paper_on_gradient() -> dict[str, Config]:
    """The preset `paper` as it is, and with SADs of the gradient in place of the colours."""
    filled = {"post": {"fill": True}}
    paper = Config.preset("paper").model_dump(mode="json")
    return {
        name: Config.from_dict(paper | filled | {"name": name} | changes)
        for name, changes in (
            ("paper, filled", {}),
            ("paper on gradient, filled", {"criteria": _GRADIENT_NEST}),
        )
    }
