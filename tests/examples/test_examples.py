"""The examples run as they are."""

import importlib.util
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[2] / "examples"


def load(name: str):
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_walker_built_by_hand_walks_forward(capsys):
    duration = 0.5
    distance = load("build_a_walker").main(duration=duration)
    # Its ramp takes 1 s to 1.2 m/s.
    assert distance == pytest.approx(0.5 * 1.2 * duration**2, abs=0.02)
    assert f"after {duration:g} s" in capsys.readouterr().out
