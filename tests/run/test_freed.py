"""A simulation that is no longer used is freed, with every system of its diagram."""

import gc
import subprocess
import sys
from pathlib import Path
from weakref import ref

import pytest
from pydrake.geometry import Meshcat

from humanwalk.body.opensim_names import COORDINATES
from humanwalk.choices.sources import FROM_SCENARIO, LIVE, Sources
from humanwalk.motion.followed import REQUIRED_JOINTS
from humanwalk.run.simulate import prepare
from humanwalk.scenario import Scenario, load_scenario
from humanwalk.view.replay import make_meshcat

FINE_STEP = {"simulation.time_step": "0.001"}

CHANGES = {
    "walk": ("walk", {}),
    "thesis": ("thesis", {}),
    "hydroelastic": ("walk", {"contact": "hydroelastic"}),
    "asperity": ("thesis", {"contact": "asperity", **FINE_STEP}),
    "cenic": ("thesis", {"simulation.integrator": "cenic", "simulation.time_step": "0"}),
    "style": ("walk", {"controller.balanced.style": "normative"}),
    "pid": ("thesis", {"actuation": "pid"}),
    "adaptive": ("thesis", {"actuation": "adaptive"}),
    "levels": (
        "thesis",
        {
            "controller.thesis.balance.foot_force.enabled": "true",
            "controller.thesis.balance.upper_body.enabled": "true",
        },
    ),
    "exoskeleton": ("walk", {"subject.devices": "[hip_exoskeleton]"}),
    "load": ("walk", {"subject.loads": "[{backpack: {mass: 10.0}}]"}),
    "course": ("course", {}),
}


def kept_systems(scenario: Scenario, meshcat: Meshcat | None = None, sources: Sources = FROM_SCENARIO) -> list[str]:
    """Names of the systems that live on after a prepared simulation was dropped."""
    prepared = prepare(scenario, meshcat, sources=sources)
    systems = [prepared.simulator.get_system(), *prepared.walker.GetSystems()]
    alive = {system.get_name(): ref(system) for system in systems}
    prepared.simulator.Initialize()
    del prepared, systems
    gc.collect()
    return [name for name, system in alive.items() if system() is not None]


@pytest.mark.parametrize("name", CHANGES)
def test_every_choice_of_a_scenario_is_freed(name: str) -> None:
    scenario, changes = CHANGES[name]
    assert kept_systems(load_scenario(scenario, changes)) == []


@pytest.mark.parametrize("kinematic", ["true", "false"])
def test_a_followed_recording_is_freed(kinematic: str, tmp_path: Path) -> None:
    names = [f"{COORDINATES[joint][0]}_deg" for joint in REQUIRED_JOINTS]
    rows = [f"{time}" + ",0.0" * len(names) for time in (0.0, 1.0)]
    (tmp_path / "still.csv").write_text("\n".join([",".join(["time", *names]), *rows]) + "\n")
    recorded = f"{{recorded: {{angles: {tmp_path / 'still.csv'}, kinematic: {kinematic}}}}}"
    assert kept_systems(load_scenario("thesis", {"controller": recorded})) == []


def test_pictures_and_live_sources_are_freed() -> None:
    assert kept_systems(load_scenario("walk"), make_meshcat(), LIVE) == []


def test_another_thread_may_free_what_a_meshcat_shows() -> None:
    """Drake ends the program if it destroys the Meshcat, too."""
    program = """
import gc, threading
from humanwalk.run.simulate import prepare
from humanwalk.scenario import load_scenario
from humanwalk.view.replay import make_meshcat
gc.disable()
prepare(load_scenario("walk"), make_meshcat()).simulator.Initialize()
thread = threading.Thread(target=gc.collect)
thread.start()
thread.join()
print("alive")
"""
    ended = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stdout) == (0, "alive\n"), ended.stderr
