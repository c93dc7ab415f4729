"""Configurations that are compared: fuzzy or not, and each saving of `robust-small` taken back."""

from softdepth.spec.config import OPERATORS, Config

_CRITERIA = [
    {"kind": "census", "label_bits": 8},
    {"kind": "gradient", "label_bits": 8},
    {"kind": "gradient", "rows": 9, "columns": 9, "label_bits": 9},
]
"""Those of `robust`, and that of `robust-small`: the fuzzy stage takes three."""

_GRADIENT_NEST = [{"window": w, "source": "gradient", "label_bits": 10} for w in (3, 5, 7)]


SMALL = "robust-small"
"""The preset whose savings are taken back."""
_SAVINGS = {
    "sums over 9x9": ["criteria.0.rows=9", "criteria.0.columns=9"],
    "island test over 5x5": ["post.island_rows=5", "post.island_columns=5"],
    "with a median of 5x5": ["post.median=5"],
    "every pixel of the row": ["post.masked_spacing=1"],
    "masked medians over 19 and 19": [
        *("post.masked_median=9", "post.masked_spacing=1", "post.masked_rows=15"),
    ],
    "colours of 8 bits": ["post.colour_bits=12"],
}
ABLATIONS = {**_SAVINGS, "all of these": [key for keys in _SAVINGS.values() for key in keys]}
"""What takes back each saving, and all of them: the filters are then those of `robust`."""


def ablations() -> dict[str, Config]:
    """`robust-small` with each of them taken back, and with all, by name."""
    base = Config.preset(SMALL)
    return {name: base.override([f"name={name}", *changes]) for name, changes in ABLATIONS.items()}


def compared() -> dict[str, Config]:
    """Those of "fuzzy or not?"."""
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
