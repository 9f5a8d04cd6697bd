"""The bare plant repeats the recorded walk, or produces an error."""

from typing import Any

import numpy as np
import pytest

from humanwalk.bench.bare_plant import BarePlant, PlantRecord, record_plant
from humanwalk.quantity import ParameterError
from humanwalk.run.simulate import prepare
from humanwalk.scenario import Scenario, load_scenario

DURATION = 0.06


def recorded(name: str, **overrides: Any) -> tuple[Scenario, PlantRecord]:
    scenario = load_scenario(name, {key.replace("__", "."): value for key, value in overrides.items()})
    prepared = prepare(scenario, record=False)
    record = record_plant(prepared)
    prepared.simulator.Initialize()
    prepared.simulator.AdvanceTo(DURATION)
    return scenario, record


@pytest.mark.parametrize(
    ("name", "overrides"),
    [
        ("thesis", {}),
        ("thesis", {"actuation__pd__law": "implicit"}),
        ("thesis", {"contact": "hydroelastic"}),
        ("walk", {}),
        ("stand", {"pushes__given": "[{time: 0.02, duration: 0.02, impulse: 2.0}]"}),
    ],
    ids=["thesis", "implicit", "hydroelastic", "balanced", "pushed"],
)
def test_the_bare_plant_repeats_the_walk_bit_by_bit(name: str, overrides: dict[str, Any]) -> None:
    scenario, record = recorded(name, **overrides)
    bare = BarePlant(scenario, record)
    cost = bare.advance(0.5 * DURATION) + bare.advance(DURATION)
    context = bare.plant.GetMyContextFromRoot(bare.simulator.get_context())
    assert np.array_equal(bare.plant.GetPositionsAndVelocities(context), record.end)
    assert not np.array_equal(record.start, record.end)
    assert cost.cpu > 0


def test_another_walk_is_refused() -> None:
    scenario, record = recorded("thesis")
    record.inputs["actuation"][3] = record.inputs["actuation"][3] + 1.0  # type: ignore[operator]
    with pytest.raises(ParameterError, match="does not repeat"):
        BarePlant(scenario, record).advance(DURATION)


def test_a_plant_without_steps_is_refused() -> None:
    scenario = load_scenario("thesis", {"simulation.integrator": "cenic", "simulation.time_step": "0"})
    with pytest.raises(ParameterError, match="cenic"):
        record_plant(prepare(scenario, record=False))
