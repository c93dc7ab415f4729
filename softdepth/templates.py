"""Pages in Markdown and HTML, rendered from template files."""

import re
from functools import cache
from typing import Any

import jinja2
from markupsafe import Markup, escape


def render(package: str, template: str, **values: Any) -> str:
    """A page, without a final line feed.

    Parameters
    ----------
    package : the package with the folder ``templates``, in dotted form.
    template : the file in it. In a file called ``.html`` every value is escaped, in others none.
    values : the values of the template's names. A missing one is an error.
    """
    return _environment(package).get_template(template).render(values).rstrip("\n")


@cache
def _environment(package: str) -> jinja2.Environment:
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader(package, "templates"),
        autoescape=jinja2.select_autoescape(("html",), default=False, default_for_string=False),
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["number"] = format  # {{ 1234.56 | number(",.1f") }}
    environment.filters["bold"] = _bold
    return environment


def _bold(text: str) -> Markup:
    """Text in HTML, in which ``**`` marks what is bold."""
    return Markup(re.sub(r"\*\*(.+?)\*\*", r"<strong>\1</strong>", str(escape(text))))
