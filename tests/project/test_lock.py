"""requirements.lock: complete, hashed, and bound to no registry."""

import re
import tomllib

from packaging.requirements import Requirement

PIN = re.compile(r"^([a-z0-9-]+)==(\S+)")


def entries(text: str) -> list[str]:
    """Each pin with its hash lines."""
    body = "\n".join(line for line in text.splitlines() if not line.startswith("#"))
    return re.split(r"\n(?=[a-z])", body.strip())


def normal(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()


def test_every_entry_is_pinned_and_hashed(project):
    found = entries((project / "requirements.lock").read_text())
    assert len(found) > 30
    for entry in found:
        assert PIN.match(entry), entry
        assert re.search(r"--hash=sha256:[0-9a-f]{64}", entry), entry


def test_no_registry_is_named(project):
    text = (project / "requirements.lock").read_text()
    assert not re.search(r"https?:|file:|@ |--index|--extra|--find", text)


def test_every_declared_dependency_is_locked_within_its_bounds(project):
    declared = tomllib.loads((project / "pyproject.toml").read_text())
    groups = declared["dependency-groups"]
    texts = [*declared["project"]["dependencies"], *(text for group in groups.values() for text in group)]
    locked: dict[str, set[str]] = {}
    for entry in entries((project / "requirements.lock").read_text()):
        name, pinned = entry.split()[0].split("==")
        locked.setdefault(name, set()).add(pinned)
    for requirement in map(Requirement, texts):
        versions = locked[normal(requirement.name)]
        assert all(requirement.specifier.contains(v, prereleases=True) for v in versions), requirement
    build = [Requirement(text) for text in declared["build-system"]["requires"]]
    assert {normal(r.name) for r in build} <= locked.keys()


def test_every_dependency_has_its_reason(project):
    for line in (project / "pyproject.toml").read_text().splitlines():
        if re.match(r'  "[a-z][\w.\[\]-]*[~>=]=', line):
            assert re.search(r'",\s+# \w+', line), line
