"""The serial port: bytes to and from a board, and what may be wrong with it, in one line."""

import contextlib
import errno
import select
import termios
from pathlib import Path
from types import TracebackType
from typing import Self

import serial

from softdepth.spec.errors import InputError, ToolError

CHUNK = 1 << 16
WRITE_SECONDS = 10.0
"""How long the system may take to accept a packet before the port counts as dead."""
_FAILURES = (OSError, termios.error)
"""What a port that went away raises, as pyserial passes it on."""


class Port:
    """An open serial port, 8N1; a context manager that closes it.

    Raises `InputError` if it cannot be opened, and `ToolError` when it goes away.
    """

    def __init__(self, path: str, baud: int) -> None:
        self.path = path
        self.baud = baud
        try:
            self._serial = serial.Serial(path, baud, timeout=0, write_timeout=WRITE_SECONDS, exclusive=True)
        except (*_FAILURES, ValueError, OverflowError) as error:
            raise _unopened(path, error) from error
        # FTDI's driver collects bytes for 16 ms otherwise; other ports do not know the setting.
        with contextlib.suppress(OSError, ValueError, AttributeError, NotImplementedError):
            self._serial.set_low_latency_mode(True)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        with contextlib.suppress(*_FAILURES):
            self._serial.close()

    def write(self, data: bytes) -> None:
        """Send bytes."""
        try:
            self._serial.write(data)
        except _FAILURES as error:
            raise self._gone() from error

    def read(self, seconds: float) -> bytes:
        """The bytes that have come, as soon as there are any; none after `seconds`."""
        try:
            # pyserial would set up the whole port anew for each other timeout
            ready, _, _ = select.select([self._serial], [], [], seconds)
            return self._serial.read(CHUNK) if ready else b""
        except (*_FAILURES, TypeError, ValueError) as error:  # pyserial's own state may be half closed
            raise self._gone() from error

    def drain(self) -> None:
        """Forget what came so far."""
        try:
            self._serial.reset_input_buffer()
        except _FAILURES as error:
            raise self._gone() from error

    def _gone(self) -> ToolError:
        return ToolError(
            f"the board on '{self.path}' was unplugged or switched off",
            "plug it in, load the bitstream again if it is not in flash, and repeat the command",
        )


def _unopened(path: str, error: Exception) -> InputError:
    number = getattr(error, "errno", None)
    if number == errno.EACCES:
        return InputError(
            f"no permission to use '{path}'", "run: sudo usermod -aG dialout $USER, and log in again"
        )
    if number == errno.ENOENT or not Path(path).exists():
        return InputError(
            f"there is no serial port '{path}'", "plug the board in, then look: ls /dev/serial/by-id/"
        )
    if number in (errno.EBUSY, errno.EAGAIN) or "lock" in str(error).lower():
        return InputError(f"'{path}' is in use by another program", "close that program")
    return InputError(f"'{path}' is not a usable serial port ({error})", "name the board's port with --port")
