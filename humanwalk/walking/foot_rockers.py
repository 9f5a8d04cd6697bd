"""How a foot that carries rolls: over the heel after it landed, over the ball before it leaves (Perry's rockers)."""

from __future__ import annotations

from dataclasses import dataclass

from humanwalk.numerics.scalars import clip
from humanwalk.quantity import quantity
from humanwalk.walking.walking_reference import FootReference, FootTask


@dataclass(frozen=True)
class FootRockers:
    """Rolling over heel and ball."""

    heel: float = quantity(0.15, "s", 0.02, 0.4)
    """A foot that landed on its heel is flat after this time."""

    ball: float = quantity(0.10, "s", 0.0, 0.3)
    """The heel rises this long before the other foot lands."""

    pitch: float = quantity(1.0, "rad", 0.0, 1.2)
    """Pitch of the foot that leaves, at the end of double support at 1 m/s and faster; in proportion below."""

    slowest: float = quantity(0.2, "m/s", 0.0, 3.0)
    """In a slower walk, and in going backward, feet leave flat."""

    def rises(self, speed: float) -> bool:
        """Whether heels rise at a forward speed [m/s]."""
        return speed > self.slowest

    def over_heel(self, yaw: float) -> FootReference:
        """A foot that has just landed."""
        return FootReference(FootTask.HEEL_STRIKE, 1.0, yaw)

    def over_ball(self, since: float, double_support: float, load: float, yaw: float, speed: float) -> FootReference:
        """A foot whose heel has been rising.

        Args:
            since: time since the heel left the ground [s].
            double_support: time from the other foot's touchdown until this one leaves [s].
            load: see FootReference.
            yaw: of the foot [rad].
            speed: forward [m/s].
        """
        duration = self.ball + double_support
        final = self.pitch * clip(speed, 0.0, 1.0)
        s = min(since / duration, 1.0)
        pitch = (final * s * s, 2.0 * final * s / duration, 2.0 * final / duration**2)
        return FootReference(FootTask.HEEL_OFF, load, yaw, pitch=pitch, toes=pitch[:2])
