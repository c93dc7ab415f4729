"""Pages of the documentation site that lie in the project's own folder: a hook of mkdocs."""

from pathlib import Path

from mkdocs.structure.files import File

PROJECT = Path(__file__).resolve().parent.parent
PAGES = {
    "README.md": "readme.md",
    "CONTRIBUTING.md": "contributing.md",
    "CHANGELOG.md": "changelog.md",
    "LICENSE": "license.md",
}
"""Files and what they are called in the site."""


def on_files(files, config):
    """Add the project's own pages, whose links start from its folder."""
    for name, page in PAGES.items():
        text = (PROJECT / name).read_text().replace("](docs/", "](")
        if not name.endswith(".md"):
            text = f"# {name.capitalize()}\n\n```text\n{text}```\n"
        files.append(File.generated(config, page, content=_renamed(text)))
    return files


def on_page_markdown(markdown, **_):
    """Lead links out of docs/ to the pages of this site."""
    return _renamed(markdown.replace("](../", "]("))


def _renamed(text):
    for name, page in PAGES.items():
        text = text.replace(f"]({name}", f"]({page}")
    return text
