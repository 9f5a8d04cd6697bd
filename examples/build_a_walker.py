"""The thesis' walker wired by hand, as a script of your own would: gait, inverse kinematics, PD, plant, support.

Run it with: python examples/build_a_walker.py
"""

import numpy as np
from pydrake.geometry import Meshcat, MeshcatParams, MeshcatVisualizer
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder

from humanwalk.body import human
from humanwalk.body.limbs import PELVIS
from humanwalk.control.balance_support import BalanceSupportParameters
from humanwalk.control.inverse_kinematics import InverseKinematicsParameters
from humanwalk.diagrams.world import add_world
from humanwalk.gait.foot_cycle import FootPathParameters
from humanwalk.gait.speed_ramp import SpeedRamp
from humanwalk.gait.walking_gait import WalkingGait
from humanwalk.scenario import load_scenario
from humanwalk.systems.balance_support import BalanceSupport
from humanwalk.systems.following_view import keep_meshcat
from humanwalk.systems.gait_spline_source import GaitSplineSource
from humanwalk.systems.inverse_kinematics_solver import InverseKinematicsSolver
from humanwalk.systems.pd_actuator_bank import PdActuatorBank


def main(duration: float = 3.0) -> float:
    """Walk for some seconds [s] and return how far the pelvis came [m]."""
    builder = DiagramBuilder()
    world = add_world(builder, load_scenario("thesis"))
    plant = world.plant

    gait = WalkingGait(FootPathParameters(step_height=0.12), human().hip_half_width, SpeedRamp(1.2, 1.0))
    source = world.add("gait", GaitSplineSource(gait, human()))
    solver = world.add(
        "inverse_kinematics",
        InverseKinematicsSolver(world.model, InverseKinematicsParameters(), period=0.01),
        sole_targets=source.GetOutputPort("sole_targets"),
    )
    bank = world.add(
        "actuators",
        PdActuatorBank(plant, world.kp, world.kd, "semi_implicit", np.full_like(world.kp, np.inf)),
        desired_state=solver.GetOutputPort("desired_state"),
        sample_time=solver.GetOutputPort("sample_time"),
        state=world.state,
        net_actuation=plant.get_net_actuation_output_port(),
    )
    builder.Connect(bank.GetOutputPort("actuation"), plant.get_actuation_input_port())
    support = world.add(
        "support",
        BalanceSupport(plant, BalanceSupportParameters()),
        pelvis_reference=source.GetOutputPort("pelvis_reference"),
        state=world.state,
    )
    builder.Connect(support.GetOutputPort("generalized_force"), plant.get_applied_generalized_force_input_port())
    meshcat = Meshcat(MeshcatParams(host="localhost"))
    MeshcatVisualizer.AddToBuilder(builder, world.scene_graph, meshcat)
    keep_meshcat(meshcat)

    simulator = Simulator(builder.Build())
    simulator.AdvanceTo(duration)
    pelvis = plant.GetBodyByName(PELVIS).EvalPoseInWorld(plant.GetMyContextFromRoot(simulator.get_context()))
    print(f"The pelvis is at {np.round(pelvis.translation(), 3)} m after {duration:g} s.")
    return float(pelvis.translation()[0])


if __name__ == "__main__":
    main()
