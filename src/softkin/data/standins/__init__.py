"""Stand-ins: robots simulated by softkin itself, for when the published data are out of reach."""

from __future__ import annotations

from softkin.data.standins import pneumatic_arm, tendon_finger
from softkin.data.standins.robot import StandIn

#: Name of a simulated robot -> how it is commanded and what shape it takes.
STANDINS: dict[str, StandIn] = {
    spec.name: spec for spec in (pneumatic_arm.SPEC, tendon_finger.SPEC, tendon_finger.FRICTIONAL)
}
