"""The record: one named column with a unit for each number of each port, in the port's order."""

import re

import numpy as np
import pyarrow as pa
import pytest
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import Context, Diagram, DiagramBuilder

from humanwalk.body.joint_map import JointMap
from humanwalk.diagrams.walker import make_diagram, make_walker
from humanwalk.measures.signals import TIME, matrix
from humanwalk.run.recorder import Recorder, recorded_signals
from humanwalk.scenario import load_scenario

PERIOD = 0.01
LEVELS = {
    "controller.thesis.balance.foot_force.enabled": "true",
    "controller.thesis.balance.upper_body.enabled": "true",
}
ENDINGS = ("_m", "_m_s", "_N", "_N_m", "_rad", "_rad_s", "_kg")
WITHOUT_UNIT = (
    r"\.((reference_)?quaternion_[wxyz]|saturated|loaded|friction_use|phase|scheduled|ik_residual|ik_iterations"
    r"|ik_converged|solved|failures(_in_a_row)?)$"
)


@pytest.fixture(scope="module")
def recorded() -> tuple[Diagram, Context, pa.Table]:
    """A tenth of a second of a walker with every port that can be recorded; walker, root context, table."""
    builder = DiagramBuilder()
    walker = builder.AddNamedSystem("walker", make_walker(load_scenario("thesis", LEVELS)))
    joint_map = JointMap.of(walker.GetSubsystemByName("plant"))
    recorder = Recorder.add_to(builder, walker, joint_map, PERIOD)
    simulator = Simulator(builder.Build())
    simulator.AdvanceTo(0.1)
    context = simulator.get_context()
    return walker, walker.GetMyContextFromRoot(context), recorder.table(context)


def test_column_names_are_unique(recorded: tuple[Diagram, Context, pa.Table]) -> None:
    _, _, table = recorded
    assert len(set(table.column_names)) == len(table.column_names)
    assert all(table.column_names)


def test_every_column_names_its_unit(columns: tuple[str, ...]) -> None:
    for name in columns:
        assert name.endswith(ENDINGS) or re.search(WITHOUT_UNIT, name), name


@pytest.mark.parametrize("scenario", ["thesis", "stand"])
def test_every_signal_has_a_column_for_every_element_of_its_port(joints: JointMap, scenario: str) -> None:
    walker = make_diagram(load_scenario(scenario))
    signals = recorded_signals(walker, joints)
    for signal in signals:
        assert walker.GetOutputPort(signal.name).size() == signal.port.size() == len(signal.columns), signal.name
    ports = map(walker.get_output_port, range(walker.num_output_ports()))
    # What the joints receive is recorded as torque.
    vectors = {port.get_name() for port in ports if port.size()} - {"net_actuation"}
    assert vectors == {signal.name for signal in signals}


def test_the_table_has_the_columns_of_every_signal(
    recorded: tuple[Diagram, Context, pa.Table], joints: JointMap
) -> None:
    walker, _, table = recorded
    columns = [column for signal in recorded_signals(walker, joints) for column in signal.columns]
    assert table.column_names == [TIME, *columns]


def test_a_row_every_period(recorded: tuple[Diagram, Context, pa.Table]) -> None:
    _, _, table = recorded
    np.testing.assert_allclose(table[TIME].to_numpy(), PERIOD * np.arange(11), atol=1e-12)


def test_joint_columns_hold_their_own_joint(recorded: tuple[Diagram, Context, pa.Table]) -> None:
    walker, context, table = recorded
    plant = walker.GetSubsystemByName("plant")
    plant_context = plant.CreateDefaultContext()
    state = walker.GetOutputPort("state").Eval(context)
    plant.SetPositionsAndVelocities(plant_context, state)
    for name in JointMap.of(plant).names:
        joint = plant.GetJointByName(name)
        assert table[f"{name}.angle_rad"][-1].as_py() == joint.get_angle(plant_context)
        assert table[f"{name}.velocity_rad_s"][-1].as_py() == joint.get_angular_rate(plant_context)


def test_desired_angles_belong_to_the_joints_of_their_name(recorded: tuple[Diagram, Context, pa.Table]) -> None:
    _, _, table = recorded
    # The knee of the leg that swings first bends; the arms hang with bent elbows.
    assert table["RightLegTibiaMotion.desired_angle_rad"][-1].as_py() > 0.3
    assert table["LeftLegTibiaMotion.desired_angle_rad"][-1].as_py() < 0.2
    assert table["LeftArmElbowMotion.desired_angle_rad"][-1].as_py() > 0.2


def test_pelvis_columns_are_the_pelvis(recorded: tuple[Diagram, Context, pa.Table]) -> None:
    walker, context, table = recorded
    plant = walker.GetSubsystemByName("plant")
    plant_context = plant.CreateDefaultContext()
    plant.SetPositionsAndVelocities(plant_context, walker.GetOutputPort("state").Eval(context))
    pelvis = plant.GetBodyByName("Pelvis")
    X_WP, V_WP = pelvis.EvalPoseInWorld(plant_context), pelvis.EvalSpatialVelocityInWorld(plant_context)
    row = {name: column[-1].as_py() for name, column in zip(table.column_names, table.columns, strict=True)}
    np.testing.assert_allclose([row[f"pelvis.{axis}_m"] for axis in "xyz"], X_WP.translation(), atol=1e-9)
    np.testing.assert_allclose([row[f"pelvis.velocity_{axis}_m_s"] for axis in "xyz"], V_WP.translational(), atol=1e-9)
    np.testing.assert_allclose(
        [row[f"pelvis.angular_velocity_{axis}_rad_s"] for axis in "xyz"], V_WP.rotational(), atol=1e-9
    )


def test_right_is_right(recorded: tuple[Diagram, Context, pa.Table]) -> None:
    _, _, table = recorded
    assert table["right_sole.y_m"][0].as_py() < 0 < table["left_sole.y_m"][0].as_py()
    # The right foot swings first; the left one carries.
    assert table["right_sole.z_m"][-1].as_py() > 0.01
    assert table["left_foot.force_z_N"][-1].as_py() > 300.0
    assert table["right_foot.force_z_N"][-1].as_py() == 0.0
    assert table["left_foot.scheduled"][-1].as_py() == 1.0
    assert table["right_foot.scheduled"][-1].as_py() == 0.0


def test_unsupported_walker_has_no_columns_of_the_support(joints: JointMap) -> None:
    walker = make_walker(load_scenario("thesis", {"controller.thesis.balance.support.enabled": "false"}))
    builder = DiagramBuilder()
    builder.AddSystem(walker)
    recorder = Recorder.add_to(builder, walker, joints, PERIOD)
    simulator = Simulator(builder.Build())
    simulator.Initialize()
    table = recorder.table(simulator.get_context())
    assert table.num_rows == 1
    assert not [name for name in table.column_names if name.startswith(("support.", "balance."))]


def test_matrix_keeps_the_order_of_the_columns_asked_for(recorded: tuple[Diagram, Context, pa.Table]) -> None:
    _, _, table = recorded
    both = matrix(table, ["com.z_m", "com.x_m"])
    np.testing.assert_array_equal(both[:, 0], table["com.z_m"].to_numpy())
    np.testing.assert_array_equal(both[:, 1], table["com.x_m"].to_numpy())


def test_a_matrix_of_no_columns_has_the_rows_of_the_table() -> None:
    assert matrix(pa.table({TIME: [0.0, 1.0, 2.0]}), []).shape == (3, 0)
