"""The balanced walker on slopes that it knows."""

import numpy as np
import pytest

from humanwalk.run.simulate import simulate
from humanwalk.scenario import load_scenario

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("slope, cross_slope", [(0.05, 0.0), (-0.05, 0.0), (0.0, 0.05)])
def test_it_walks_on_a_slope_of_three_degrees_at_the_height_of_level_walking(slope: float, cross_slope: float) -> None:
    terrain = f"{{plane: {{slope: {slope}, cross_slope: {cross_slope}}}}}"
    outcome = simulate(load_scenario("walk", {"duration": "6", "terrain": terrain}))
    assert outcome.end == "completed"
    x, y, z = (outcome.signals[f"com.{axis}_m"].to_numpy() for axis in "xyz")
    assert x[-1] > 3.0
    ground = x * np.tan(slope) + y * np.tan(cross_slope)
    np.testing.assert_allclose(z - ground, 0.95, atol=0.05)
