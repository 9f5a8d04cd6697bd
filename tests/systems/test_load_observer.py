"""The load observer as a system: what a body that stands with more than its weight on the ground carries."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.analysis import Simulator

from humanwalk.body.limbs import CHEST, PELVIS
from humanwalk.control.felt_load import LoadFeeling
from humanwalk.numerics import Array
from humanwalk.numerics.rotation import yaw_pitch
from humanwalk.quantity import GRAVITY
from humanwalk.systems.body_observer import BodyObserver
from humanwalk.systems.load_observer import LoadObserver

PERIOD = 0.006
FEELING = LoadFeeling(time_constant=0.1)


@pytest.fixture(scope="module")
def observer(plant: MultibodyPlant) -> LoadObserver:
    return LoadObserver(plant, FEELING, PERIOD)


def turned(plant: MultibodyPlant, yaw: float) -> tuple[Array, Array]:
    """State of a body that stands at a heading, and its center of mass."""
    context = plant.CreateDefaultContext()
    pelvis = plant.GetBodyByName(PELVIS)
    X_WP = pelvis.EvalPoseInWorld(context)
    X_WP.set_rotation(type(X_WP.rotation())(yaw_pitch(yaw, 0.0)))
    plant.SetFreeBodyPose(context, pelvis, X_WP)
    return plant.GetPositionsAndVelocities(context), plant.CalcCenterOfMassPositionInWorld(context)


def felt(observer: LoadObserver, state: Array, force: float, pressure: Array, duration: float) -> Array:
    """The load that is felt after a time with half of a vertical force on each foot."""
    simulator = Simulator(observer)
    context = simulator.get_mutable_context()
    feet = np.zeros((2, 8))
    feet[:, 2], feet[:, 3:5], feet[:, 7] = force / 2, pressure, 1.0
    observer.GetInputPort("state").FixValue(context, state)
    observer.GetInputPort("foot_forces").FixValue(context, feet.ravel())
    simulator.Initialize()
    simulator.AdvanceTo(duration)
    load: Array = observer.GetOutputPort("load").Eval(context)
    return load.copy()


def test_ports(observer: LoadObserver, plant: MultibodyPlant) -> None:
    inputs = [observer.get_input_port(i) for i in range(observer.num_input_ports())]
    assert [(port.get_name(), port.size()) for port in inputs] == [
        ("state", plant.num_multibody_states()),
        ("foot_forces", 16),
    ]
    assert observer.num_output_ports() == 1
    assert observer.GetOutputPort("load").size() == 4


def test_its_signal_has_a_column_per_element(observer: LoadObserver) -> None:
    (signal,) = observer.signals
    assert signal.name == "felt_load"
    assert len(set(signal.columns)) == signal.port.size()


def test_a_body_that_weighs_what_its_model_weighs_carries_nothing(
    observer: LoadObserver, plant: MultibodyPlant
) -> None:
    state, com = turned(plant, 0.0)
    weight = plant.CalcTotalMass(plant.CreateDefaultContext()) * GRAVITY
    np.testing.assert_array_equal(felt(observer, state, weight, com[:2], 0.5), 0.0)


@given(mass=st.floats(5.0, 40.0), yaw=st.floats(-3.0, 3.0), x=st.floats(-0.3, 0.3), y=st.floats(-0.3, 0.3))
def test_with_the_load_that_is_felt_the_center_of_mass_is_above_the_pressure(
    observer: LoadObserver, plant: MultibodyPlant, mass: float, yaw: float, x: float, y: float
) -> None:
    """At any heading, with the same place on the body."""
    body = plant.CalcTotalMass(plant.CreateDefaultContext())

    def standing(heading: float) -> tuple[Array, Array, Array]:
        """State, center of mass with the load, and the load that is felt."""
        state, com = turned(plant, heading)
        place = com + mass / (body + mass) * yaw_pitch(heading, 0.0) @ (x, y, 0.0)
        return state, place, felt(observer, state, (body + mass) * GRAVITY, place[:2], 2.0)

    state, place, load = standing(yaw)
    assert load[0] == pytest.approx(mass, rel=1e-3)
    np.testing.assert_allclose(load, standing(0.0)[2], atol=1e-6)

    body_observer = BodyObserver(plant)
    context = body_observer.CreateDefaultContext()
    body_observer.GetInputPort("state").FixValue(context, state)
    body_observer.GetInputPort("load").FixValue(context, load)
    with_load = body_observer.GetOutputPort("com").Eval(context)[:3]
    np.testing.assert_allclose(with_load, place, atol=1e-3)


def test_a_load_is_felt_with_the_time_constant(observer: LoadObserver, plant: MultibodyPlant) -> None:
    state, com = turned(plant, 0.0)
    body = plant.CalcTotalMass(plant.CreateDefaultContext())
    early, late = (
        felt(observer, state, (body + 20.0) * GRAVITY, com[:2], time)[0]
        for time in (FEELING.time_constant, 20.0 * FEELING.time_constant)
    )
    assert early == pytest.approx(20.0 * (1.0 - np.exp(-1.0)), rel=0.05)
    assert late == pytest.approx(20.0, rel=1e-6)


@pytest.mark.parametrize("acceleration", [(1.0, -0.5, 0.5), (-2.0, 1.0, -0.5)])
def test_a_body_that_the_ground_accelerates_as_a_whole_carries_only_its_load(
    observer: LoadObserver, plant: MultibodyPlant, acceleration: tuple[float, float, float]
) -> None:
    """One foot carries the load, which is above the center of mass, the force on the other passes through this."""
    state, com = turned(plant, 0.0)
    body, mass = plant.CalcTotalMass(plant.CreateDefaultContext()), 15.0
    force = body * np.add(acceleration, (0.0, 0.0, GRAVITY))
    feet = np.zeros((2, 8))
    feet[0, :3], feet[0, 3:6] = force, com - force * com[2] / force[2]
    feet[1, 2], feet[1, 3:5] = mass * GRAVITY, com[:2]
    context = observer.CreateDefaultContext()
    observer.GetInputPort("foot_forces").FixValue(context, feet.ravel())
    velocity = slice(plant.num_positions() + 3, plant.num_positions() + 6)
    for k in range(round(10.0 * FEELING.time_constant / PERIOD)):
        state[velocity] = k * PERIOD * np.array(acceleration)
        observer.GetInputPort("state").FixValue(context, state)
        context.SetDiscreteState(observer.EvalUniquePeriodicDiscreteUpdate(context))
    load = observer.GetOutputPort("load").Eval(context)
    assert load[0] == pytest.approx(mass, rel=1e-3)
    standing = plant.CreateDefaultContext()
    np.testing.assert_allclose(plant.GetFrameByName(CHEST).CalcPoseInWorld(standing) @ load[1:], com, atol=1e-3)
