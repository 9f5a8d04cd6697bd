"""Every scenario that is shipped walks, and what it leaves is a run."""

from pathlib import Path

import pytest

from humanwalk.choices import ThesisController
from humanwalk.run.simulate import simulate
from humanwalk.scenario import load_scenario, shipped_scenarios


@pytest.mark.parametrize("name", shipped_scenarios())
def test_shipped_scenario_walks_for_a_moment(name: str, tmp_path: Path) -> None:
    scenario = load_scenario(name, {"duration": "0.1"})
    outcome = simulate(scenario)
    assert outcome.end == "completed"
    run = outcome.write(tmp_path, name)
    assert run.summary["survived"] is True
    assert run.summary["external_support"] is isinstance(scenario.controller, ThesisController)
    assert run.signals.num_rows == 1 + round(0.1 / scenario.recording.signal_period)
