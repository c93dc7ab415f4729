"""Pages of results: one self-contained HTML file each, that loads nothing from anywhere."""

import re
from collections.abc import Iterable, Sequence
from html import escape

from softdepth.golden.score.pictures import ERROR_COLOURS

_STYLE = """
:root { color-scheme: light; }
body { font: 15px/1.5 system-ui, sans-serif; color: #1f2328; background: #fff; margin: 0 auto;
  max-width: 1180px; padding: 24px 28px 64px; }
h1 { font-size: 26px; margin: 8px 0 2px; } h2 { font-size: 19px; margin: 40px 0 8px;
  border-bottom: 1px solid #d1d9e0; padding-bottom: 4px; } h3 { font-size: 15px; margin: 22px 0 6px; }
p.lead { color: #59636e; margin-top: 0; } li { margin: 5px 0; max-width: 92ch; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: 13.5px; margin: 10px 0; font-variant-numeric: tabular-nums; }
th { text-align: left; font-weight: 600; background: #f6f8fa; }
th, td { padding: 4px 11px; border-bottom: 1px solid #e4e8ec; vertical-align: top; }
td.n, th.n { text-align: right; white-space: nowrap; } tr.first td { border-top: 2px solid #c4ccd4; }
td.best { font-weight: 650; } td.off { color: #b3261e; }
.pictures { display: grid; gap: 8px; align-items: start; }
figure { margin: 0; } figure img { width: 100%; display: block; border-radius: 3px; background: #26262a; }
figcaption { font-size: 12px; color: #59636e; padding: 2px 1px 6px; line-height: 1.35; }
.legend span { display: inline-block; margin-right: 18px; font-size: 12.5px; color: #59636e; }
.legend i { display: inline-block; width: 12px; height: 12px; border: 1px solid #8c959f; margin-right: 6px;
  vertical-align: -1px; }
.curve { width: 100%; }
"""


def page(title: str, parts: Sequence[str]) -> str:
    """The whole page as HTML text."""
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{escape(title)}</title><style>{_STYLE}</style></head>\n<body>\n"
        + "\n".join(parts)
        + "\n</body></html>\n"
    )


def section(title: str, body: str) -> str:
    """A heading and what is below it, in HTML."""
    return f"<h2>{escape(title)}</h2>\n{body}"


def bullets(lines: Iterable[str]) -> str:
    """A list of lines, in which ``**`` marks what is bold."""
    bold = (re.sub(r"\*\*(.+?)\*\*", r"<strong>\1</strong>", escape(line)) for line in lines)
    return "<ul>" + "".join(f"<li>{line}</li>" for line in bold) + "</ul>"


def cell(text: str, kind: str = "") -> str:
    """A cell of a table, of a class such as ``n`` for numbers."""
    return f'<td class="{kind}">{escape(text)}</td>' if kind else f"<td>{escape(text)}</td>"


def grid(head: Sequence[str], rows: Iterable[str], numbers: int) -> str:
    """A table; the columns from `numbers` on are right-aligned."""
    titles = "".join(
        f'<th class="{"n" if i >= numbers else ""}">{escape(title)}</th>' for i, title in enumerate(head)
    )
    return f'<div class="scroll"><table><tr>{titles}</tr>{"".join(rows)}</table></div>'


def row(cells: Iterable[str], first: bool = False) -> str:
    """A row of cells; with `first`, under a line."""
    return f'<tr class="first">{"".join(cells)}</tr>' if first else f"<tr>{''.join(cells)}</tr>"


def figure(source: str, caption: str) -> str:
    """A picture with its caption; `source` is a file or a data URL."""
    text = escape(caption)
    return f'<figure><img src="{source}" alt="{text}"><figcaption>{text}</figcaption></figure>'


def pictures(found: Sequence[str], columns: int) -> str:
    """Figures in a grid."""
    style = f"grid-template-columns: repeat({columns}, 1fr)"
    return f'<div class="pictures" style="{style}">{"".join(found)}</div>'


def legend() -> str:
    """The colours of error pictures."""
    keys = (
        f'<span><i style="background: rgb{rgb}"></i>{escape(name)}</span>'
        for name, rgb in ERROR_COLOURS.items()
    )
    return f'<p class="legend">{"".join(keys)}</p>'
