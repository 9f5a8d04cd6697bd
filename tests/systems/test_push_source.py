"""The push source: force times duration is the impulse; random pushes follow from the seed."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydrake.multibody.plant import ExternallyAppliedSpatialForce, MultibodyPlant
from pydrake.multibody.tree import SpatialInertia

from humanwalk.body.limbs import CHEST
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError
from humanwalk.systems.push_source import PushSource
from humanwalk.walking.push import Push, PushParameters, all_pushes


def at(source: PushSource, time: float) -> tuple[Array | list[ExternallyAppliedSpatialForce] | list[Any], ...]:
    context = source.CreateDefaultContext()
    context.SetTime(time)
    return source.GetOutputPort("spatial_forces").Eval(context), source.GetOutputPort("force").Eval(context)


@pytest.fixture
def source(plant: MultibodyPlant) -> PushSource:
    return PushSource(plant, PushParameters((Push(2.0, 0.1, 30.0, math.pi / 2), Push(2.05, 0.1, 10.0))), seed=0)


def test_ports_and_signal(source: PushSource) -> None:
    (signal,) = source.signals
    assert (signal.name, signal.port.get_name()) == ("push", "force")
    assert signal.columns == ("push.force_x_N", "push.force_y_N", "push.force_z_N")
    assert source.GetOutputPort("spatial_forces").get_name() == "spatial_forces"
    assert source.GetOutputPort("force").size() == 3


@pytest.mark.parametrize(
    "time, force", [(1.99, (0, 0, 0)), (2.0, (0, 300, 0)), (2.07, (100, 300, 0)), (2.12, (100, 0, 0)), (3.0, (0, 0, 0))]
)
def test_force_over_time(source: PushSource, time: float, force: tuple[int, int, int]) -> None:
    forces, total = at(source, time)
    assert total == pytest.approx(force, abs=1e-9)
    assert sum((f.F_Bq_W.translational() for f in forces), np.zeros(3)) == pytest.approx(force, abs=1e-9)


def test_the_force_acts_at_the_center_of_mass_of_the_body(plant: MultibodyPlant, source: PushSource) -> None:
    (force,), _ = at(source, 2.0)
    body = plant.get_body(force.body_index)
    assert body.name() == CHEST
    assert force.p_BoBq_B == pytest.approx(body.default_com())
    assert force.F_Bq_W.rotational() == pytest.approx([0, 0, 0])


def test_a_context_may_hold_other_pushes(source: PushSource) -> None:
    context = source.CreateDefaultContext()
    source.set_pushes(context, [Push(1.0, 0.1, 20.0)])
    context.SetTime(1.05)
    assert source.GetOutputPort("force").Eval(context) == pytest.approx([200.0, 0.0, 0.0])
    assert at(source, 1.05)[1] == pytest.approx([0.0, 0.0, 0.0])
    with pytest.raises(ParameterError, match="Rib: no such body"):
        source.set_pushes(context, [Push(body="Rib")])


def test_an_unknown_body_is_a_one_line_error_that_names_the_nearest(plant: MultibodyPlant) -> None:
    message = r"^pushes\.body: Rib: no such body; allowed: the 44 bodies of the model; did you mean Ribs\?$"
    with pytest.raises(ParameterError, match=message):
        PushSource(plant, PushParameters((Push(body="Rib"),)), seed=0)
    message = (
        r"^pushes\.body: sole: no such body; allowed: the 44 bodies of the model: Pelvis, .*_FootToes, .*, \w+_Hand$"
    )
    with pytest.raises(ParameterError, match=message):
        PushSource(plant, PushParameters((Push(body="sole"),)), seed=0)


@given(st.floats(0.01, 2.0), st.floats(0.1, 100.0), st.floats(-math.pi, math.pi))
def test_force_times_duration_is_the_impulse(duration: float, impulse: float, direction: float) -> None:
    push = Push(1.0, duration, impulse, direction)
    x, y, z = (duration * f for f in push.force)
    assert (math.hypot(x, y), z) == pytest.approx((impulse, 0.0))
    assert math.remainder(math.atan2(y, x) - direction, 2.0 * math.pi) == pytest.approx(0.0, abs=1e-9)


def test_random_pushes_follow_from_the_seed() -> None:
    parameters = PushParameters(random_interval=2.0, random_impulse=15.0, random_until=30.0)
    pushes = all_pushes(parameters, seed=3)
    assert pushes == all_pushes(parameters, seed=3)
    assert pushes != all_pushes(parameters, seed=4)
    assert pushes
    assert all(push.impulse <= 15.0 and push.time < 30.0 for push in pushes)


def test_random_pushes_do_not_depend_on_the_noise_of_the_start() -> None:
    """The noise of the first joint's angle is the first normal number of the seed."""
    parameters = PushParameters(random_interval=2.0)
    seeds = range(1000)
    first = [all_pushes(parameters, seed)[0] for seed in seeds]
    noise = np.abs([np.random.default_rng(seed).standard_normal(2) for seed in seeds]).T
    correlations = np.corrcoef([*noise, [push.time for push in first], [push.impulse for push in first]])
    assert np.abs(correlations[:2, 2:]).max() < 0.08


@given(
    st.integers(0, 20_000), st.floats(0.0, 0.99), st.floats(0.001, 1.0), st.sampled_from([0.0005, 0.001, 0.002, 0.003])
)
def test_the_steps_of_physics_sum_up_to_the_impulse(begin: int, within: float, duration: float, step: float) -> None:
    """Times and durations need be no multiple of the step; a step longer or shorter would be 2 % of a push of 0.1 s."""
    push = Push(round(begin * step, 9) + within * step, duration, impulse=30.0).in_steps(step)
    forces = [push.force[0] for k in range(begin, begin + math.ceil(duration / step) + 3) if push.is_active(k * step)]
    assert step * sum(forces) == pytest.approx(30.0)
    assert push.duration == pytest.approx(duration, abs=max(0.5 * step, step - duration) + 1e-9)


def test_a_push_lasts_whole_steps_of_a_discrete_plant() -> None:
    plant = MultibodyPlant(0.002)
    plant.AddRigidBody(CHEST, SpatialInertia.SolidSphereWithMass(1.0, 0.1))
    plant.Finalize()
    source = PushSource(plant, PushParameters((Push(1.0, 0.0251),)), seed=0)
    (push,) = source.pushes(source.CreateDefaultContext())
    assert push.duration == pytest.approx(0.026)
    assert push.impulse == 30.0
