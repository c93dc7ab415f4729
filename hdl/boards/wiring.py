"""What is connected to a board's pins, which are named as in its file in ``constraints/``."""

from dataclasses import dataclass
from typing import Literal

Lamp = Literal["alive", "locked", "receiving", "busy", "error"]
"""``alive`` blinks once a second; ``locked``: the clock is good and the core out of reset; ``receiving``:
a packet came; ``busy``: a frame is under way; ``error``: a packet was broken or refused. The core's own
fault keeps ``error`` lit."""


@dataclass(frozen=True)
class Wiring:
    """The pins of a board other than clock and serial port.

    Members
    -------
    lamps : what each LED shows, from ``led[0]`` on.
    lamp_on : the level that lights an LED.
    button_pressed : the level of the pressed reset button, or None where the board has no button.
    high : pins that must be held high.
    """

    lamps: tuple[Lamp, ...]
    lamp_on: int = 1
    button_pressed: int | None = 1
    high: tuple[str, ...] = ()


ALL_LAMPS: tuple[Lamp, ...] = ("alive", "locked", "receiving", "busy", "error")

WIRING = {
    # The ESP32 beside the FPGA shares the USB port and stays out of its way while GPIO0 is high.
    "ulx3s.lpf": Wiring(ALL_LAMPS, high=("wifi_gpio0",)),
    "icebreaker.pcf": Wiring(("alive", "error"), lamp_on=0, button_pressed=0),
    "tangnano20k.cst": Wiring(ALL_LAMPS, lamp_on=0),
}
"""By the name of the constraint file."""
