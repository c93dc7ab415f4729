"""How commands end: the documented codes, one line, and nothing left behind."""

import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest

from softdepth import ending
from softdepth.cli import listing

PROGRAM = (sys.executable, "-m", "softdepth")
SMALL = ("--disparities", "4", "--lanes", "2", "--set", "max_width=16")
PARENT = """
import subprocess, sys, time
from softdepth.ending import ended
def work():
    subprocess.run(["sh", "-c", "sleep 60 & echo $!; sleep 60"], check=False)
sys.exit(ended(work))
"""


def run(*arguments: object, **options) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [*PROGRAM, *map(str, arguments)], stderr=subprocess.PIPE, text=True, check=False, **options
    )


def one_line(done: subprocess.CompletedProcess[str]) -> str:
    """The error, which has to be all that is said, and to name a remedy."""
    assert done.returncode == ending.USER, done.stderr
    (line,) = done.stderr.splitlines()
    assert line.startswith("error: ")
    assert "; " in line
    return line


def test_standard_output_on_a_full_disk():
    with open("/dev/full", "w") as full:
        assert "no space left on device" in one_line(run("presets", stdout=full))


def test_a_reader_that_has_gone():
    reader, writer = os.pipe()
    os.close(reader)
    try:
        assert "what was to read the output has ended" in one_line(run("presets", stdout=writer))
    finally:
        os.close(writer)


@pytest.mark.parametrize("stream", ["<&-", ">&-", "2>&-", "2>/dev/full"])
def test_streams_that_are_not_there(stream):
    done = subprocess.run(["sh", "-c", f'"$@" {stream}', "sh", *PROGRAM, "frobnicate"], check=False)
    assert done.returncode == ending.USER
    done = subprocess.run(
        ["sh", "-c", f'"$@" {stream}', "sh", *PROGRAM, "presets"], check=False, capture_output=True
    )
    assert (done.returncode, done.stderr) == (ending.DONE, b"")


@pytest.mark.slow
def test_a_home_that_cannot_be_written():
    environment = {k: v for k, v in os.environ.items() if k not in ("SOFTDEPTH_CACHE", "XDG_CACHE_HOME")}
    environment["HOME"] = "/dev/null/home"
    done = run("export", *SMALL, "-o", "-", env=environment, stdout=subprocess.PIPE)
    assert done.returncode == ending.DONE
    assert "module softdepth_core(" in done.stdout
    (note,) = done.stderr.splitlines()
    assert note.startswith("note: ")
    assert "SOFTDEPTH_CACHE" in note


def test_a_cache_that_cannot_be_written(files, softdepth, tmp_path, monkeypatch):
    monkeypatch.setenv("SOFTDEPTH_CACHE", "/dev/null/cache")
    out = tmp_path / "out"
    outcome = softdepth(
        "run", files.left, files.right, *SMALL, "--set", "max_width=64", "-o", tmp_path / "out"
    )
    assert outcome.code == ending.USER
    assert "/dev/null/cache" in outcome.error
    assert "SOFTDEPTH_CACHE" in outcome.error
    assert not out.exists()


def test_the_tools_caches_go_where_ours_goes(tmp_path, monkeypatch):
    for name in ("XDG_CACHE_HOME", "XDG_CONFIG_HOME", "YOWASP_CACHE_DIR", "MPLCONFIGDIR"):
        monkeypatch.setenv(name, "")  # so that it is taken back afterwards, too
        monkeypatch.delenv(name)
    monkeypatch.setenv("HOME", "/dev/null/home")
    monkeypatch.setenv("SOFTDEPTH_CACHE", str(tmp_path))
    assert ending.ended(lambda: None) == ending.DONE
    assert os.environ["YOWASP_CACHE_DIR"] == str(tmp_path / "yowasp")
    assert Path(os.environ["XDG_CACHE_HOME"]) == tmp_path


def test_a_fault_of_the_program_says_so(softdepth, monkeypatch):
    def broken(*_: object, **__: object) -> None:
        raise KeyError("lanes")

    monkeypatch.setattr(listing, "Table", broken)
    outcome = softdepth("presets")
    assert outcome.code == ending.BUG
    assert "Traceback" in outcome.err
    assert outcome.err.splitlines()[-1].startswith("error: a fault of softdepth (KeyError: 'lanes'); ")


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (PermissionError(13, "Permission denied", "/x"), "cannot use '/x' (permission denied)"),
        (OSError(28, "No space left on device"), "no space left on device"),
        (MemoryError(), "not enough memory"),
    ],
)
def test_what_the_machine_refuses_is_the_users_to_mend(capsys, error, words):
    def work() -> None:
        raise error

    assert ending.ended(work) == ending.USER
    assert words in capsys.readouterr().err


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT, signal.SIGHUP])
def test_a_signal_ends_the_program_and_its_children(number):
    def heard() -> None:
        """A suite in the background of a shell, or under nohup, passes on that the signal is ignored."""
        signal.signal(number, signal.SIG_DFL)

    command = [sys.executable, "-c", PARENT]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, preexec_fn=heard) as parent:
        assert parent.stdout
        grandchild = psutil.Process(int(parent.stdout.readline()))
        family = [grandchild, *psutil.Process(parent.pid).children(recursive=True)]
        parent.send_signal(number)
        assert parent.wait(20) == ending.SIGNALLED + number
    _, alive = psutil.wait_procs(family, timeout=10)
    assert not alive


@pytest.mark.slow
def test_sigterm_leaves_nothing_half_made(files, tmp_path):
    out, temporary = tmp_path / "new" / "out", tmp_path / "tmp"
    temporary.mkdir()
    arguments = ("run", files.left, files.right, "--disparities", "4", "--set", "max_width=64", "-o", out)
    environment = {**os.environ, "SOFTDEPTH_CACHE": str(tmp_path / "cache"), "TMPDIR": str(temporary)}
    with subprocess.Popen([*PROGRAM, *map(str, arguments), "--lanes=4"], env=environment) as parent:
        limit = time.monotonic() + 60
        family: list[psutil.Process] = []
        while not (family and any(temporary.glob("softdepth-*/obj"))):  # the compiler is at work
            assert time.monotonic() < limit
            assert parent.poll() is None
            time.sleep(0.05)
            family = psutil.Process(parent.pid).children(recursive=True)
        parent.terminate()
        assert parent.wait(20) == ending.SIGNALLED + signal.SIGTERM
    _, alive = psutil.wait_procs(family, timeout=10)
    assert not alive
    assert not out.parent.exists()
    assert not list(temporary.glob("softdepth-*"))


def test_the_documented_codes_are_the_codes(project):
    text = (project / "docs" / "cli.md").read_text().split("## Exit codes\n", 1)[1]
    documented = {int(code) for code in re.findall(r"^\| (\d+) \|", text, re.MULTILINE)}
    signals = {ending.SIGNALLED + number for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)}
    assert documented == {ending.DONE, ending.MISMATCH, ending.USER, ending.BUG, *signals}
