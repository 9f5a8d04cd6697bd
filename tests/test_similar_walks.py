"""Dynamic similarity: a body scaled exactly walks the reference's walk in its own units.

Lengths, masses and inertias of the body scale, and with them what a scenario commands: speeds, times, pushes, and the
steps of the simulation. Gains are not given: they follow from the body.
"""

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from humanwalk.body.skeleton import REFERENCE_MASS, REFERENCE_STATURE
from humanwalk.body.subject import Subject
from humanwalk.body_units import REFERENCE_BODY, BodyScale, scaled
from humanwalk.measures.signals import unit_of
from humanwalk.run.simulate import simulate
from humanwalk.scenario import Scenario, parse_scenario

pytestmark = pytest.mark.slow

# The steps are powers of two and the factors of the times are short binary numbers, so that simultaneous events are
# simultaneous in all bodies; the gains are those of the thesis' body without a factor. The soles begin below the
# ground, and not at the same height to the last bit.
TIMES = """
simulation: {time_step: 0.001953125}
recording: {signal_period: 0.009765625}
start: {pelvis_lift: -0.0005}
subject: {sex: unspecified}
"""
WALKS = {
    "balanced": f"""{TIMES}
duration: 2.0
controller:
  balanced:
    style: normative
    control_period: 0.005859375
    command: {{acceleration: 1.0, points: [{{time: 0.125, forward: 1.0, turn: 0.1}}]}}
pushes: {{given: [{{time: 1.25, duration: 0.125, impulse: 10.0, direction: 1.5}}]}}
""",
}
COMMANDED = {"balanced": "command"}
BODIES = {
    "small": BodyScale(length=(7 / 8) ** 2, mass=(7 / 8) ** 6),
    "tall and heavy": BodyScale(length=(17 / 16) ** 2, mass=1.3 * (17 / 16) ** 6),
}
THRESHOLDS = ("loaded", "friction_use")
"""Columns that are zero up to a force of 1 N on every body; not compared."""
WHERE_LOADED = (".cop_", ".free_moment")
"""The same, compared where the foot carries more on both bodies."""


def similar(scenario: Scenario, walker: str, scale: BodyScale) -> Scenario:
    """A scenario in which another body is told to do what the reference body does, in its own units."""
    controller: Any = scenario.controller
    parts: dict[str, Any] = {
        name: scaled(getattr(scenario, name), scale) for name in ("pushes", "start", "simulation", "recording")
    }
    return replace(
        scenario,
        **parts,
        duration=scale.time * scenario.duration,
        subject=Subject(REFERENCE_MASS * scale.mass, REFERENCE_STATURE * scale.length, "unspecified"),
        controller=replace(
            controller,
            **{COMMANDED[walker]: scaled(getattr(controller, COMMANDED[walker]), scale)},
            control_period=scale.time * controller.control_period,
        ),
    )


@cache
def walk(walker: str, scale: BodyScale = REFERENCE_BODY) -> dict[str, Any]:
    """Signals by column, in the units of the reference body."""
    signals = simulate(similar(parse_scenario(WALKS[walker]), walker, scale)).signals
    factors = {name: scale.factor(unit_of(name)) for name in signals.column_names}
    return {name: signals[name].to_numpy() / factor for name, factor in factors.items()}


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("until, tolerance", [(1.25, 1e-7), (1.95, 2e-3)])
def test_a_body_scaled_exactly_walks_the_same_walk_in_its_own_units(body: str, until: float, tolerance: float) -> None:
    """Rounding errors grow by four orders of magnitude when a foot lands after the push."""
    own, reference = walk("balanced", BODIES[body]), walk("balanced")
    assert own.keys() == reference.keys()
    rows = reference["time_s"] <= until
    for name, column in reference.items():
        if name.endswith(THRESHOLDS):
            continue
        compared = rows
        if any(part in name for part in WHERE_LOADED):
            foot = name.partition(".")[0]
            compared = rows & (own[f"{foot}.loaded"] > 0.0) & (reference[f"{foot}.loaded"] > 0.0)
            assert compared.any()
        bound = tolerance * (1.0 + np.abs(column).max())
        np.testing.assert_allclose(own[name][compared], column[compared], rtol=0.0, atol=bound, err_msg=name)
