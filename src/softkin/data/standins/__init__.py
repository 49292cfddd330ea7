"""Stand-ins: robots that softkin simulates in the place of published data that cannot be reached."""

from __future__ import annotations

from softkin.data.standins import pneumatic_arm, tendon_finger
from softkin.data.standins.robot import StandIn

#: Name of a simulated robot -> how its commands are drawn and its poses simulated.
STANDINS: dict[str, StandIn] = {
    spec.name: spec
    for spec in (pneumatic_arm.SPEC, tendon_finger.SPEC, tendon_finger.FRICTIONAL, tendon_finger.RECORDED)
}
