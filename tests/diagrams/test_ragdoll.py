"""The body that falls for pictures."""

import numpy as np
import pytest
from pydrake.systems.analysis import Simulator

from humanwalk.body.limbs import PELVIS
from humanwalk.body.plant import kinematics_plant
from humanwalk.body.subject import Subject
from humanwalk.diagrams.ragdoll import make_ragdoll
from humanwalk.run.fall_picture import TIME_TO_LIE
from humanwalk.terrain import Plane

SPEED = 1.5
"""Of the pelvis at the start [m/s]."""


@pytest.mark.parametrize(
    ("axis", "sign", "terrain"), [(0, 1.0, Plane()), (0, -1.0, Plane(slope=0.1)), (1, 1.0, Plane())]
)
def test_body_lies_on_the_ground_at_the_end(axis: int, sign: float, terrain: Plane) -> None:
    subject = Subject()
    plant = kinematics_plant(subject)
    context = plant.CreateDefaultContext()
    velocities = np.zeros(plant.num_velocities())
    start = plant.GetBodyByName(PELVIS).floating_velocities_start_in_v()
    # It tips over: about y for a fall along x.
    velocities[start + 3 + axis] = sign * SPEED
    velocities[start + 1 - axis] = sign * SPEED * (1 - 2 * axis)
    plant.SetVelocities(context, velocities)
    state = plant.GetPositionsAndVelocities(context)
    ragdoll = make_ragdoll(subject, terrain, state)
    simulator = Simulator(ragdoll)
    falling = ragdoll.GetSubsystemByName("plant")
    inner = falling.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    falling.SetPositionsAndVelocities(inner, state)
    # The walker falls to half of its height before.
    simulator.AdvanceTo(TIME_TO_LIE + 0.8)
    for index in falling.GetBodyIndices(falling.GetModelInstanceByName("human")):
        p_WB = falling.get_body(index).EvalPoseInWorld(inner).translation()
        height = p_WB[2] - float(terrain.height(p_WB[:2]))
        assert -0.02 < height < 0.5, falling.get_body(index).name()
    pelvis = falling.GetBodyByName(PELVIS)
    assert pelvis.EvalPoseInWorld(inner).translation()[2] < 0.35
    assert np.linalg.norm(pelvis.EvalSpatialVelocityInWorld(inner).translational()) < 0.3
