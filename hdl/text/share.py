"""Keeps one copy of equal modules in RTLIL text, so synthesis works on each of them only once.

Amaranth writes a module for every instance: a core of 16 lanes holds 16 equal lanes. Two modules are
equal when their bodies are, apart from the names of wires and cells.
"""

import re
from collections import Counter
from dataclasses import dataclass

from softdepth.spec.errors import ToolError

SMALLEST_KEPT = 50
"""The fewest cells, submodules included, with which it pays to synthesise a module on its own. Smaller ones
are flattened into their parents and optimised together with them."""

_MODULE = re.compile(r"^(?:attribute [^\n]*\n)*module (\S+)\n.*?^end\n", re.MULTILINE | re.DOTALL)
_TOP = re.compile(r"(?:attribute [^\n]*\n)*?attribute \\top 1\n")
_CELL = re.compile(r"^  cell (\S+) \S+\n(.*?)^  end\n", re.MULTILINE | re.DOTALL)
_WIRE = re.compile(r"^  wire (.*) ([\\$]\S+)$", re.MULTILINE)
_PORT = re.compile(r"^  wire .*\b(?:input|output|inout) \d+ .*?([\\$]\S+)$", re.MULTILINE)
_CONNECT = re.compile(r"^(    connect )(\S+)", re.MULTILINE)
_PLACE = re.compile(r"^ *attribute \\(?:src|generator) .*\n", re.MULTILINE)
_NAME = re.compile(r"[\\$]\S+")
_ELEMENT = re.compile(r"\\[^\s\"]*\[[^\s\"]*")


@dataclass(frozen=True)
class _Module:
    """A module that stands for all that equal it. Its text names such modules only."""

    name: str
    text: str
    ports: tuple[str, ...]
    children: Counter[str]


def share(rtlil: str, *, smallest: float = SMALLEST_KEPT) -> str:
    """RTLIL of the same design, with one copy of equal modules.

    The outermost modules with several instances get the attribute ``keep_hierarchy``: yosys then flattens
    everything inside them, and keeps the modules themselves until they are mapped.

    Parameters
    ----------
    rtlil : the text of a design as Amaranth writes it; its top module has the attribute ``top``.
    smallest : modules of fewer cells, submodules included, are left to be flattened; ``inf`` keeps none.
    """
    # In a module that is mapped by itself, yosys' ABC9 takes a wire called `a[3]` for bit 3 of port `a`.
    rtlil = _ELEMENT.sub(lambda name: name[0].replace("[", ":").replace("]", ""), rtlil)
    texts = {match[1]: match[0] for match in _MODULE.finditer(rtlil)}
    top = next((name for name, text in texts.items() if _TOP.match(text)), None)
    if top is None:
        raise ToolError("the design has no top module", "give RTLIL as Amaranth writes it")
    standing: dict[str, _Module] = {}  # by the name of each module that it stands for
    own_ports: dict[str, tuple[str, ...]] = {}
    known: dict[str, _Module] = {}  # by canonical body
    for name in _bottom_up(texts, top):
        text = _CELL.sub(lambda cell: _retarget(cell, standing, own_ports), texts[name])
        ports = own_ports[name] = tuple(_PORT.findall(text))
        children = Counter(cell[1] for cell in _CELL.finditer(text))
        standing[name] = known.setdefault(_canonical(text), _Module(name, text, ports, children))
    modules = {module.name: module for module in known.values()}
    kept = _outermost_repeated(modules, top, smallest)
    mark = "attribute \\keep_hierarchy 1\n"
    return "\n".join((mark if name in kept else "") + module.text for name, module in modules.items())


def _bottom_up(texts: dict[str, str], top: str) -> list[str]:
    """The names of all modules under `top`, each after those that it instantiates."""
    order: dict[str, None] = {}

    def visit(name: str) -> None:
        if name in order:
            return
        for cell in _CELL.finditer(texts[name]):
            if cell[1] in texts:
                visit(cell[1])
        order[name] = None

    visit(top)
    return list(order)


def _retarget(
    cell: re.Match[str], standing: dict[str, _Module], own_ports: dict[str, tuple[str, ...]]
) -> str:
    """A cell's text, turned into an instance of the module that stands for its own; ports match by order."""
    module = standing.get(cell[1])
    if module is None or module.name == cell[1]:
        return cell[0]
    renamed = dict(zip(own_ports[cell[1]], module.ports, strict=True))
    head, newline, body = cell[0].partition("\n")
    body = _CONNECT.sub(lambda line: line[1] + renamed[line[2]], body)
    return head.replace(cell[1], module.name, 1) + newline + body


def _canonical(text: str) -> str:
    """The body of a module without what may differ between equal ones: places in the source, and names."""
    names = {match[2]: f"${number}" for number, match in enumerate(_WIRE.finditer(text))}

    def line_of(line: str) -> str:
        if line.startswith(("module ", "attribute ")):
            return ""
        if line.startswith("  cell "):
            return line.rpartition(" ")[0]
        if line.startswith("  process "):
            return "  process"
        fixed = ""
        if line.startswith("    connect \\"):
            fixed, space, line = line[len("    connect ") :].partition(" ")
            fixed += space
        elif line.lstrip().startswith(("parameter ", "attribute ")):
            return line
        return fixed + _NAME.sub(lambda name: names.get(name[0], name[0]), line)

    return "\n".join(map(line_of, _PLACE.sub("", text).splitlines()))


def _outermost_repeated(modules: dict[str, _Module], top: str, smallest: float) -> set[str]:
    """Modules that are large enough, occur several times, and lie in no other such module."""
    sizes: dict[str, int] = {}

    def size(name: str) -> int:
        if name not in sizes:
            children = modules[name].children
            sizes[name] = sum(n * (size(c) if c in modules else 1) for c, n in children.items())
        return sizes[name]

    uses: Counter[str] = Counter({top: 1})
    for name in reversed(modules):  # parents before children: they were found bottom up
        for child, count in modules[name].children.items():
            if child in modules:
                uses[child] += uses[name] * count
    kept: set[str] = set()

    def visit(name: str) -> None:
        if name != top and uses[name] > 1 and size(name) >= smallest:
            kept.add(name)
            return
        for child in modules[name].children:
            if child in modules:
                visit(child)

    visit(top)
    return kept
