"""The push source: force times duration is the impulse, in its direction, and random pushes come from the seed."""

import math

import numpy as np
import pytest

from humanwalk.systems.push_source import PushSource
from humanwalk.walking.push import Push, PushParameters, pushes_of


def at(source, time):
    context = source.CreateDefaultContext()
    context.SetTime(time)
    return source.GetOutputPort("spatial_forces").Eval(context), source.GetOutputPort("force").Eval(context)


@pytest.fixture
def source(plant):
    return PushSource(plant, PushParameters((Push(2.0, 0.1, 30.0, math.pi / 2), Push(2.05, 0.1, 10.0))), seed=0)


def test_port_names(source):
    assert source.GetOutputPort("spatial_forces").get_name() == "spatial_forces"
    assert source.GetOutputPort("force").size() == 3


@pytest.mark.parametrize(
    "time, force", [(1.99, (0, 0, 0)), (2.0, (0, 300, 0)), (2.07, (100, 300, 0)), (2.12, (100, 0, 0)), (3.0, (0, 0, 0))]
)
def test_force_over_time(source, time, force):
    forces, total = at(source, time)
    assert total == pytest.approx(force, abs=1e-9)
    assert sum((f.F_Bq_W.translational() for f in forces), np.zeros(3)) == pytest.approx(force, abs=1e-9)


def test_it_pushes_at_the_centre_of_mass_of_the_body(plant, source):
    (force,), _ = at(source, 2.0)
    assert plant.get_body(force.body_index).name() == "Ribs"
    assert force.p_BoBq_B == pytest.approx([0, 0, 0.0385])
    assert force.F_Bq_W.rotational() == pytest.approx([0, 0, 0])


def test_a_context_may_hold_other_pushes(source):
    context = source.CreateDefaultContext()
    source.set_pushes(context, [Push(1.0, 0.1, 20.0)])
    context.SetTime(1.05)
    assert source.GetOutputPort("force").Eval(context) == pytest.approx([200.0, 0.0, 0.0])
    assert at(source, 1.05)[1] == pytest.approx([0.0, 0.0, 0.0])
    with pytest.raises(ValueError, match="Rib: no such body"):
        source.set_pushes(context, [Push(body="Rib")])


def test_a_body_that_is_none_is_refused(plant):
    with pytest.raises(ValueError, match="Rib: no such body"):
        PushSource(plant, PushParameters((Push(body="Rib"),)), seed=0)


def test_random_pushes_are_the_seeds():
    parameters = PushParameters(random_interval=2.0, random_impulse=15.0, random_until=30.0)
    pushes = pushes_of(parameters, seed=3)
    assert pushes == pushes_of(parameters, seed=3)
    assert pushes != pushes_of(parameters, seed=4)
    assert pushes
    assert all(push.impulse <= 15.0 and push.time < 30.0 for push in pushes)
