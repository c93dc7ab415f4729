"""Files go where they are sent: through what is no regular file, and complete or not at all otherwise."""

import os
import stat
import threading
from pathlib import Path

import pytest

from softdepth.files import check_writable, result_folder, write_atomically
from softdepth.spec.errors import InputError

DATA = b"module core;\n"


def test_a_device_stays_one(tmp_path):
    device = tmp_path / "full"
    try:
        os.mknod(device, stat.S_IFCHR | 0o666, os.makedev(1, 7))
        device.open("wb").close()
    except OSError:
        pytest.skip("devices can only be made by root")
    check_writable(device)
    with pytest.raises(InputError, match="No space left on device"):
        write_atomically(device, DATA)
    assert stat.S_ISCHR(device.stat().st_mode)
    assert list(tmp_path.iterdir()) == [device]


def test_a_full_device():
    with pytest.raises(InputError, match="'/dev/full': No space left on device"):
        write_atomically("/dev/full", DATA)
    assert stat.S_ISCHR(os.stat("/dev/full").st_mode)


def test_a_device_that_takes_all_needs_no_right_to_its_folder(monkeypatch):
    allowed = os.access
    monkeypatch.setattr(os, "access", lambda path, mode: Path(path) != Path("/dev") and allowed(path, mode))
    check_writable("/dev/null")
    write_atomically("/dev/null", DATA)


def test_a_fifo(tmp_path):
    path, got = tmp_path / "fifo", []
    os.mkfifo(path)
    reader = threading.Thread(target=lambda: got.append(path.read_bytes()))
    reader.start()
    write_atomically(path, DATA)
    reader.join(10)
    assert got == [DATA]
    assert stat.S_ISFIFO(path.stat().st_mode)


def test_a_pipe_by_its_name():
    reader, writer = os.pipe()
    write_atomically(f"/dev/fd/{writer}", DATA)
    os.close(writer)
    with open(reader, "rb") as end:
        assert end.read() == DATA


def test_a_file_that_is_open_gets_more(tmp_path):
    with (tmp_path / "log").open("ab") as file:
        file.write(b"first\n")
        file.flush()
        write_atomically(f"/dev/fd/{file.fileno()}", DATA)
        file.write(b"last\n")
    assert (tmp_path / "log").read_bytes() == b"first\n" + DATA + b"last\n"


@pytest.mark.parametrize("there", [True, False])
def test_a_link_stays_one(tmp_path, there):
    folder = tmp_path / "elsewhere"
    folder.mkdir()
    target = folder / "core.v"
    if there:
        target.write_bytes(b"old")
    first, second = tmp_path / "first", tmp_path / "second"
    second.symlink_to("elsewhere/core.v")
    first.symlink_to(second)
    write_atomically(first, DATA)
    assert first.is_symlink()
    assert second.is_symlink()
    assert target.read_bytes() == DATA
    assert os.listdir(folder) == ["core.v"]


def test_links_in_a_circle(tmp_path):
    (tmp_path / "a").symlink_to("b")
    (tmp_path / "b").symlink_to("a")
    with pytest.raises(InputError, match="cannot write"):
        write_atomically(tmp_path / "a", DATA)


def test_permissions_stay(tmp_path):
    path = tmp_path / "core.v"
    path.write_bytes(b"old")
    path.chmod(0o640)
    write_atomically(path, DATA)
    assert stat.S_IMODE(path.stat().st_mode) == 0o640


def test_results_go_through_links(tmp_path):
    out, disk = tmp_path / "out", tmp_path / "disk"
    disk.mkdir()
    out.symlink_to(disk)
    (disk / "map.pfm").symlink_to("kept.pfm")
    os.mkfifo(disk / "fifo")
    got = []
    reader = threading.Thread(target=lambda: got.append((disk / "fifo").read_bytes()))
    reader.start()
    with result_folder(out) as folder:
        for name in ("map.pfm", "fifo", "report.json"):
            (folder / name).write_bytes(DATA)
    reader.join(10)
    assert got == [DATA]
    assert (disk / "map.pfm").is_symlink()
    assert {file.name for file in disk.iterdir()} == {"map.pfm", "kept.pfm", "fifo", "report.json"}
    assert (disk / "kept.pfm").read_bytes() == DATA
