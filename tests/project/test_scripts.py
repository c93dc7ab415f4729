"""The scripts that make the environment, on machines that lack something."""

import os
import shutil
import stat
import subprocess
import sys
from pathlib import Path

import pytest

DEBIAN = "sudo apt-get install -y python3 python3-venv libpython3-dev g++ make perl"
NEEDED = ("sh", "g++", "make", "perl")


@pytest.fixture
def tools(tmp_path) -> Path:
    """A folder with links to everything that preflight looks for, and nothing else."""
    folder = tmp_path / "bin"
    folder.mkdir()
    for name in NEEDED:
        found = shutil.which(name)
        assert found, f"this machine has no {name}"
        (folder / name).symlink_to(found)
    (folder / "python3").symlink_to(sys.executable)
    return folder


def preflight(project: Path, tools: Path, python: str = sys.executable) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [str(project / "scripts" / "preflight.sh"), python],
        env={**os.environ, "PATH": str(tools)},
        capture_output=True,
        text=True,
        check=False,
    )


def script(path: Path, text: str) -> Path:
    path.write_text(f"#!/bin/sh\n{text}\n")
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return path


def test_this_machine_passes(project, tools):
    done = preflight(project, tools)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


@pytest.mark.parametrize("name", ["g++", "make", "perl"])
def test_a_missing_tool_is_named_with_what_to_install(project, tools, name):
    (tools / name).unlink()
    done = preflight(project, tools)
    assert done.returncode != 0
    assert done.stderr == f"error: not found: {name}; on Debian or Ubuntu: {DEBIAN}\n"


def test_all_missing_tools_at_once(project, tools):
    for name in ("g++", "make", "python3"):
        (tools / name).unlink()
    assert "not found: python3 g++ make;" in preflight(project, tools, "python3").stderr


def test_an_old_python(project, tools):
    old = script(tools / "python3.9", 'case $1 in -V) echo "Python 3.9.2" ;; *) exit 1 ;; esac')
    done = preflight(project, tools, str(old))
    assert done.returncode != 0
    assert "is Python 3.9.2" in done.stderr
    assert "3.11" in done.stderr
    assert len(done.stderr.splitlines()) == 1


@pytest.mark.parametrize(
    ("lacks", "problem"),
    [("ensurepip", "cannot make virtual environments"), ("ctypes", "has no shared library")],
)
def test_a_python_without_its_parts(project, tools, lacks, problem):
    # Debian splits Python: a module or library may be missing though the interpreter is there.
    (tools / f"{lacks}.py").write_text("raise ImportError\n")
    python = script(tools / "python-less", f'PYTHONPATH={tools} exec {sys.executable} "$@"')
    done = preflight(project, tools, str(python))
    assert done.returncode != 0
    assert problem in done.stderr
    assert DEBIAN in done.stderr


def test_make_without_a_goal_explains_every_task(project):
    done = subprocess.run(["make", "-C", str(project)], capture_output=True, text=True, check=True)
    for task in ("demo", "test", "test-fast", "bench", "lint", "format", "types", "lock", "export", "clean"):
        assert f"  make {task} " in done.stdout


def test_ci_runs_the_commands_of_the_readme(project):
    lines = (project / ".ci" / "run").read_text().splitlines()
    assert lines[-1] == "make test"
    assert "make lint" in lines
    readme = (project / "README.md").read_text()
    assert "\nmake test " in readme
    assert "\nmake demo " in readme
    assert os.access(project / ".ci" / "run", os.X_OK)


@pytest.fixture
def integration(project, tmp_path) -> Path:
    """``.ci/run`` alone in a folder, with tools that say how they are called and nothing else on the path."""
    (tmp_path / ".ci").mkdir()
    shutil.copy(project / ".ci" / "run", tmp_path / ".ci" / "run")
    folder = tmp_path / "bin"
    folder.mkdir()
    for name in ("bash", "dirname", "env"):
        found = shutil.which(name)
        assert found
        (folder / name).symlink_to(found)
    script(folder / "make", f'echo "make $@" >> {tmp_path}/said')
    script(folder / "apt-get", f'echo "apt-get $@" >> {tmp_path}/said')
    script(folder / "timeout", 'shift; exec "$@"')
    script(folder / "id", "echo 0")
    return tmp_path


def ci(place: Path) -> tuple[int, list[str]]:
    """How it ends, and what it has called."""
    (place / "said").unlink(missing_ok=True)
    done = subprocess.run(
        ["bash", str(place / ".ci" / "run")],
        env={"PATH": str(place / "bin"), "HOME": str(place)},
        capture_output=True,
        check=False,
    )
    return done.returncode, (place / "said").read_text().splitlines()


def test_continuous_integration_installs_icarus_where_it_may(integration):
    every = ["make lint", "make types", "make docs", "make test"]
    code, said = ci(integration)
    assert code == 0
    assert any(line.startswith("apt-get install") and line.endswith(" iverilog") for line in said)
    assert [line for line in said if line.startswith("make")] == every
    script(integration / "bin" / "iverilog", "true")
    assert not any("iverilog" in line for line in ci(integration)[1]), "it is there already"
    (integration / "bin" / "iverilog").unlink()
    script(integration / "bin" / "id", "echo 1000")
    assert ci(integration) == (0, every), "only root may install"
    script(integration / "bin" / "id", "echo 0")
    script(integration / "bin" / "apt-get", "exit 100")
    assert ci(integration) == (0, every), "a network that is not there stops nothing"
    script(integration / "bin" / "make", f'echo "make $@" >> {integration}/said; [ "$1" != types ]')
    assert ci(integration) == (1, every[:2]), "what fails is told"
