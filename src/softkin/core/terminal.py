"""How what jobs say stands on the terminal."""

from __future__ import annotations

#: Environment variable, set while `cli.watching` draws its screen: jobs then write to their logs alone.
ON_A_SCREEN = "SOFTKIN_ON_A_SCREEN"
#: The time of day with which lines on the terminal begin.
CLOCK = "%H:%M:%S"
