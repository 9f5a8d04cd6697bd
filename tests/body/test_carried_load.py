"""A load on the chest that is set at run time: a point mass more, and nothing else."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydrake.multibody.plant import MultibodyPlant

from humanwalk.body.carried_load import NO_LOAD, CarriedLoad
from humanwalk.body.limbs import CHEST

PLACES = st.tuples(*[st.floats(-0.5, 0.5)] * 3).map(np.array)


@given(mass=st.floats(0.1, 60.0), place=PLACES)
def test_a_load_moves_the_center_of_mass_as_a_point_mass_does(
    plant: MultibodyPlant, mass: float, place: np.ndarray
) -> None:
    context = plant.CreateDefaultContext()
    body, com = plant.CalcTotalMass(context), plant.CalcCenterOfMassPositionInWorld(context)
    at = plant.GetFrameByName(CHEST).CalcPoseInWorld(context) @ place
    carried = CarriedLoad(plant, context)
    carried.set(np.array((mass, *place)))
    assert carried.mass == mass
    assert plant.CalcTotalMass(context) == pytest.approx(body + mass)
    expected = (body * com + mass * at) / (body + mass)
    np.testing.assert_allclose(plant.CalcCenterOfMassPositionInWorld(context), expected, atol=1e-9)


@given(mass=st.floats(0.1, 60.0), place=PLACES)
def test_a_load_that_is_put_down_leaves_nothing(plant: MultibodyPlant, mass: float, place: np.ndarray) -> None:
    context = plant.CreateDefaultContext()
    before = plant.CalcMassMatrix(context)
    carried = CarriedLoad(plant, context)
    carried.set(np.array((mass, *place)))
    carried.set(NO_LOAD)
    assert carried.mass == 0.0
    np.testing.assert_array_equal(plant.CalcMassMatrix(context), before)


def test_a_load_is_in_one_context_only(plant: MultibodyPlant) -> None:
    mine, other = plant.CreateDefaultContext(), plant.CreateDefaultContext()
    body = plant.CalcTotalMass(other)
    CarriedLoad(plant, mine).set(np.array((10.0, 0.0, 0.0, 0.0)))
    assert plant.CalcTotalMass(other) == body
    assert plant.CalcTotalMass(mine) == pytest.approx(body + 10.0)
