"""The thesis' walker wired by hand, as a script of your own would: gait, inverse kinematics, PD, plant, support.

Run it with: python examples/build_a_walker.py
"""

import numpy as np
from pydrake.geometry import Meshcat, MeshcatParams, MeshcatVisualizer
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder

from humanwalk.body import human
from humanwalk.body.plant import Subject, kinematics_plant
from humanwalk.choices.start import start_positions
from humanwalk.choices.world import add_human_plant
from humanwalk.control.balance_support import BalanceSupportParameters
from humanwalk.control.inverse_kinematics import InverseKinematicsParameters
from humanwalk.gait.foot_cycle import FootPathParameters
from humanwalk.gait.speed_ramp import SpeedRamp
from humanwalk.gait.walking_gait import WalkingGait
from humanwalk.scenario import load_scenario
from humanwalk.systems.balance_support import BalanceSupport
from humanwalk.systems.gait_spline_source import GaitSplineSource
from humanwalk.systems.inverse_kinematics_solver import InverseKinematicsSolver
from humanwalk.systems.pd_actuator_bank import PdActuatorBank


def main(duration: float = 3.0) -> float:
    """Walk for some seconds [s] and return how far the pelvis came [m]."""
    builder = DiagramBuilder()
    scenario = load_scenario("thesis")
    body = add_human_plant(builder, scenario)
    plant = body.plant
    plant.SetDefaultPositions(start_positions(scenario))

    gait = WalkingGait(FootPathParameters(step_height=0.12), human().hip_half_width, SpeedRamp(1.2, 1.0))
    source = builder.AddSystem(GaitSplineSource(gait, human()))
    solver = builder.AddSystem(
        InverseKinematicsSolver(kinematics_plant(Subject()), InverseKinematicsParameters(), period=0.005)
    )
    bank = builder.AddSystem(PdActuatorBank(plant, body.kp, body.kd))
    support = builder.AddSystem(BalanceSupport(plant, BalanceSupportParameters()))

    builder.Connect(source.GetOutputPort("sole_targets"), solver.GetInputPort("sole_targets"))
    builder.Connect(solver.GetOutputPort("desired_state"), bank.GetInputPort("desired_state"))
    builder.Connect(solver.GetOutputPort("sample_time"), bank.GetInputPort("sample_time"))
    builder.Connect(bank.GetOutputPort("plant_desired_state"), plant.get_desired_state_input_port(body.instance))
    builder.Connect(source.GetOutputPort("pelvis_reference"), support.GetInputPort("pelvis_reference"))
    builder.Connect(plant.get_state_output_port(), support.GetInputPort("state"))
    builder.Connect(support.GetOutputPort("generalized_force"), plant.get_applied_generalized_force_input_port())
    meshcat = Meshcat(MeshcatParams(host="localhost"))
    MeshcatVisualizer.AddToBuilder(builder, body.scene_graph, meshcat)

    simulator = Simulator(builder.Build())
    simulator.AdvanceTo(duration)
    pelvis = plant.GetBodyByName("Pelvis").EvalPoseInWorld(plant.GetMyContextFromRoot(simulator.get_context()))
    print(f"The pelvis is at {np.round(pelvis.translation(), 3)} m after {duration:g} s.")
    return float(pelvis.translation()[0])


if __name__ == "__main__":
    main()
