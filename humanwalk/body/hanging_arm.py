"""Hanging arms: how far they swing with a load in the hand."""

from dataclasses import replace
from typing import NamedTuple

from humanwalk.body.carried_load import NO_LOAD
from humanwalk.body.limbs import ARMS, CHEST
from humanwalk.body.plant import kinematics_plant
from humanwalk.body.subject import Subject
from humanwalk.numerics import Array
from humanwalk.numerics.scalars import clip
from humanwalk.sides import SIDES, Side


class HangingArm(NamedTuple):
    """One arm that hangs straight.

    Attributes:
        free_inertia, inertia: Moment of inertia about the shoulder without loads, and with those that its person knows
            [kg m2].
        aside: Distance of the shoulder to the left of the middle of the chest [m].
        length: Distance of shoulder and wrist [m].
    """

    free_inertia: float
    inertia: float
    aside: float
    length: float

    def freedom(self, load: Array = NO_LOAD) -> float:
        """Swing of the arm relative to that of a free arm with the same angular momentum.

        Args:
            load: Mass and position of a load in addition, see `CarriedLoad`. It hangs in the hand if it is as far aside
                as the shoulder, and not if it is nearer than half of that.
        """
        in_hand = clip(2.0 * float(load[2]) / self.aside - 1.0, 0.0, 1.0)
        return self.free_inertia / (self.inertia + in_hand * float(load[0]) * self.length**2)


def hanging_arms(subject: Subject) -> dict[Side, HangingArm]:
    """Both arms of a subject."""
    plant, free = kinematics_plant(subject), kinematics_plant(replace(subject, loads=()))
    context = plant.CreateDefaultContext()
    M, M_free = plant.CalcMassMatrix(context), free.CalcMassMatrix(free.CreateDefaultContext())
    X_CW = plant.GetFrameByName(CHEST).CalcPoseInWorld(context).inverse()
    arms: dict[Side, HangingArm] = {}
    for side in SIDES:
        shoulder, wrist = (plant.GetJointByName(name) for name in (ARMS[side].shoulder_flexion, ARMS[side].wrist))
        p, q = (
            X_CW.multiply(joint.frame_on_parent().CalcPoseInWorld(context)).translation() for joint in (shoulder, wrist)
        )
        v = shoulder.velocity_start()
        arms[side] = HangingArm(float(M_free[v, v]), float(M[v, v]), float(p[1]), float(p[2] - q[2]))
    return arms
