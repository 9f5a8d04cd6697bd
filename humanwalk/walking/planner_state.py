"""The state of the step planner between two control periods.

Points of the level plane are complex numbers x + iy [m]; headings are angles about z [rad].
"""

import cmath
from typing import NamedTuple

from humanwalk.body import Side
from humanwalk.numerics import Array
from humanwalk.sides import other_side
from humanwalk.terrain.plane import Plane
from humanwalk.terrain.terrain import Ground
from humanwalk.walking.commanded_path import CommandedPath
from humanwalk.walking.footholds import Foothold
from humanwalk.walking.motions import PlanarMotion
from humanwalk.walking.preview import Preview
from humanwalk.walking.step_timing import StepTiming
from humanwalk.walking.swing_clearance import Clearance
from humanwalk.walking.swing_foot import SwingProfile
from humanwalk.walking.walking_reference import Phase


class Swing(NamedTuple):
    """The swinging foot.

    Attributes:
        motion: Ankle over the level plane.
        profile: Height and pitch for a foothold at the height of the ground at lift-off.
        foothold: Where the foot will stand.
        start_yaw, start_toes: Yaw of the foot and extension of the toes at lift-off [rad].
        start: Ankle over the level plane at lift-off [m].
        lift_off: Time on the clock of the step at lift-off [s].
        rise: Height of the ground at the foothold above that at lift-off [m].
        clearance: What the swing adds to clear the ground.
        lowest: Height of the lowest point of the sole without that, at `TIMES` [m].
    """

    motion: PlanarMotion
    profile: SwingProfile
    foothold: Foothold
    start_yaw: float
    start_toes: float
    start: complex = 0.0
    lift_off: float = 0.0
    rise: float = 0.0
    clearance: Clearance = Clearance()
    lowest: Array | float = 0.0


class PlannerState(NamedTuple):
    """The state of the step planner.

    Attributes:
        phase: Phase of the walk.
        elapsed: Time in the phase; in double and single support, on the clock of the step [s].
        stance: The stance foot of the step.
        right, left: Where the feet stand; the swinging foot, where it stood.
        support: Height of the support: that of the center of mass, without what it has above level ground [m].
        heading, old_heading: Headings of this step and of the one before [rad].
        path: The commanded path.
        height, height_rate: Mean height of the center of mass above the support [m, m/s].
        turn: Turn rate of this step: change of the heading to the next step over its duration [rad/s].
        next_turn: Turn rate of the steps after it [rad/s].
        path_correction: Velocity of this step in addition to the commanded one [m/s].
        steps: Number of steps since standing.
        early: Time by which the last step was shorter than planned [s].
        swing: The swinging foot in single support, else None.
        timing: Durations of this step.
        preview: The next footholds.
        ground: What is known of the ground.
        zmp: Zero-moment point that was planned last [m].
        caution: How careful this step is, from 0 to 1; see `Caution`.
        largest_error: Largest error of the DCM at touchdown that was predicted in this step [m].
    """

    phase: Phase
    elapsed: float
    stance: Side
    right: Foothold
    left: Foothold
    support: float
    heading: float
    old_heading: float
    path: CommandedPath
    height: float
    height_rate: float = 0.0
    turn: float = 0.0
    next_turn: float = 0.0
    path_correction: complex = 0.0
    steps: int = 0
    early: float = 0.0
    swing: Swing | None = None
    timing: StepTiming = StepTiming()
    preview: Preview = Preview()
    ground: Ground = Plane()
    zmp: complex = 0.0
    caution: float = 0.0
    largest_error: float = 0.0

    def __deepcopy__(self, memo: object) -> "PlannerState":
        """Return itself: Drake copies abstract values often, and the state is immutable."""
        return self

    def foot(self, side: Side) -> Foothold:
        """Where a foot stands or stood."""
        return self.right if side == "Right" else self.left

    @property
    def swing_side(self) -> Side:
        """The foot that swings in this step."""
        return other_side(self.stance)

    @property
    def stance_foot(self) -> Foothold:
        """Where the stance foot stands."""
        return self.foot(self.stance)

    @property
    def old_foot(self) -> Foothold:
        """Where the other foot stands, or stood before its swing."""
        return self.foot(self.swing_side)

    @property
    def midpoint(self) -> complex:
        """The point between the ankles."""
        return 0.5 * (self.right.position + self.left.position)

    @property
    def is_stepping(self) -> bool:
        """Whether the walker is in double or single support of a step."""
        return self.phase.is_stepping

    @property
    def direction(self) -> complex:
        """Unit vector along the heading."""
        return cmath.exp(1j * self.heading)

    def local(self, point: complex) -> complex:
        """A point in the frame of the step: origin at the stance ankle, x along the heading."""
        return (point - self.stance_foot.position) / self.direction

    def world(self, point: complex) -> complex:
        """A point of the frame of the step in W."""
        return self.stance_foot.position + self.direction * point
