"""What a user of the Python package sees: short texts of objects, errors that name the function, types."""

import dataclasses
import inspect
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import humanwalk
from humanwalk.diagrams.walker import make_diagram
from humanwalk.run.folder import SUMMARY
from humanwalk.scenario import SimulationParameters

ROOT = Path(__file__).parents[1]

USES = """
import humanwalk
from humanwalk import load_scenario, simulate

reveal_type(simulate(load_scenario("thesis")).survived)
reveal_type(humanwalk.Run.open("runs/thesis")["com.x"])
humanwalk.simulat
"""


@pytest.fixture(scope="module")
def outcome() -> Any:
    return humanwalk.simulate(humanwalk.load_scenario("thesis", {"duration": "0.02", "description": "<b>one</b>"}))


def test_texts_of_objects_are_short_and_have_what_matters(outcome: Any, tmp_path: Path) -> None:
    run = outcome.save(tmp_path / "run", "a walk")
    texts = [(outcome, ["completed", "0.02 s"]), (run, ["a walk: completed"]), (outcome.scenario, ["one", "thesis"])]
    for thing, words in texts:
        assert len(repr(thing)) < 300
        assert "\n" not in repr(thing)
        assert all(word in repr(thing) for word in words)


def test_tables_of_objects_escape_what_comes_from_files(outcome: Any, tmp_path: Path) -> None:
    run = outcome.save(tmp_path / "run", "<script>")
    for thing in (outcome, run, outcome.scenario):
        table = thing._repr_html_()
        assert table.startswith("<table>")
        assert "<b>one" not in table
        assert "<script" not in table
    assert "&lt;b&gt;one" in outcome.scenario._repr_html_()


def test_a_broken_run_still_has_a_text(outcome: Any, tmp_path: Path) -> None:
    run = outcome.save(tmp_path / "run")
    (run.path / SUMMARY).write_text("{")
    assert "summary.json" in repr(humanwalk.Run(run.path))


@pytest.mark.parametrize("function", [humanwalk.make_walker, humanwalk.make_playback, humanwalk.simulate, make_diagram])
@pytest.mark.parametrize("argument", ["thesis", None, Path("thesis.yaml")])
def test_a_name_in_place_of_a_scenario_produces_an_error_with_the_fix(function: Any, argument: Any) -> None:
    name = function.__name__
    with pytest.raises(humanwalk.ParameterError, match=rf"{name}: .* is no Scenario; .* write {name}\(load_scenario"):
        function(argument)


@pytest.mark.parametrize(
    ("fields", "error"),
    [
        ({"duration": -3.0}, r"duration: -3 is out of range; allowed: 0\.001 to 3600 s"),
        ({"duration": "3"}, "duration: '3' is not a number; allowed: 0\\.001 to 3600 s"),
        ({"contact": "point"}, "contact: 'point' is no choice; allowed: PointContact, HydroelasticContact, .* give an"),
        ({"pushes": None}, "pushes: None is not a group of fields; allowed: given"),
        ({"simulation": SimulationParameters(integrator="euler")}, "simulation.integrator: 'euler' is unknown"),  # type: ignore[arg-type]
    ],
)
@pytest.mark.parametrize("function", [humanwalk.make_walker, humanwalk.simulate, make_diagram])
def test_a_field_that_python_replaced_is_checked_as_one_of_a_file(
    function: Any, fields: dict[str, Any], error: str
) -> None:
    scenario = dataclasses.replace(humanwalk.load_scenario("thesis"), **fields)
    with pytest.raises(humanwalk.ParameterError, match=f"^{error}"):
        function(scenario)


def test_a_value_that_replaces_one_is_text_or_itself() -> None:
    push = [{"time": 0.3, "impulse": 4}]
    plain = humanwalk.load_scenario("walk", {"duration": 0.5, "contact": "point", "pushes.given": push})
    text = humanwalk.load_scenario("walk", {"duration": "0.5", "contact": "point", "pushes.given": str(push)})
    assert plain == text
    assert (plain.duration, plain.pushes.given[0].time) == (0.5, 0.3)
    with pytest.raises(humanwalk.ParameterError, match=r"^duration: None is not a number; allowed: 0\.001 to 3600 s"):
        humanwalk.load_scenario("walk", {"duration": None})
    for no_mapping in ("duration=3", ["duration=3"]):
        with pytest.raises(humanwalk.ParameterError, match=r"^overrides: .* is no mapping; allowed: {"):
            humanwalk.load_scenario("walk", no_mapping)  # type: ignore[arg-type]


@pytest.mark.parametrize("load", [humanwalk.load_scenario, humanwalk.load_study, humanwalk.load_tuning])
@pytest.mark.parametrize("argument", [None, 3, {"duration": 3}])
def test_what_is_no_name_is_refused_in_one_line(load: Any, argument: Any) -> None:
    with pytest.raises(humanwalk.ParameterError, match="no name; allowed: a name or the path of a file; write one"):
        load(argument)


@pytest.mark.parametrize(
    ("function", "call"),
    [
        (humanwalk.run_study, r"run_study\(load_study\("),
        (humanwalk.tune, r"tune\(load_tuning\("),
        (humanwalk.plot, r"plot\(Run\.open\("),
    ],
)
@pytest.mark.parametrize("argument", ["walk", None, Path("walk.yaml")])
def test_a_name_in_place_of_what_is_loaded_produces_an_error_with_the_fix(
    function: Any, call: str, argument: Any
) -> None:
    with pytest.raises(humanwalk.ParameterError, match=rf"is no (Study|Tuning|Run); allowed: .*; write {call}"):
        function(argument, *[None] * (len(inspect.signature(function).parameters) - 1))


def test_builders_that_do_not_fit_the_controller_name_the_one_that_does(tmp_path: Path) -> None:
    (tmp_path / "motion.csv").touch()
    recorded = '{"recorded": {"angles": "%s", "kinematic": true}}' % (tmp_path / "motion.csv")
    with pytest.raises(humanwalk.ParameterError, match=r"make_walker: .*build it with make_playback"):
        humanwalk.make_walker(humanwalk.load_scenario("thesis", {"controller": recorded}))
    with pytest.raises(humanwalk.ParameterError, match=r"make_playback: .*build it with make_walker"):
        humanwalk.make_playback(humanwalk.load_scenario("stand"))


@pytest.mark.slow
def test_a_script_outside_the_checkout_sees_types(tmp_path: Path) -> None:
    """Mypy reads the whole package: half a minute without its cache."""
    (tmp_path / "script.py").write_text(USES)
    result = subprocess.run(
        [sys.executable, "-m", "mypy", "--cache-dir", str(ROOT / ".mypy_cache"), "script.py"],
        cwd=tmp_path,
        env={"MYPYPATH": str(ROOT), "PATH": ""},
        capture_output=True,
        text=True,
        check=False,
    )
    assert 'Revealed type is "bool"' in result.stdout
    assert 'Revealed type is "numpy.ndarray' in result.stdout
    assert 'Module has no attribute "simulat"' in result.stdout
