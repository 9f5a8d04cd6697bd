"""A full-body human that walks: 44 bodies and 42 revolute joints, simulated with Drake.

A Subject is whose body it is, a Scenario what happens to it, a Diagram the systems wired together,
a Run what came out. Units are SI and radians; frames and quantities are written in Drake's monogram
notation (p_WC, X_PF, V_WF).

For scripts and notebooks, what most of them need is here:

    from humanwalk import load_scenario, simulate

    outcome = simulate(load_scenario("thesis", {"controller.thesis.gait.path.step_height": "0.12", "duration": "3"}))
    run = outcome.save("runs/low")
    run["RightLegTibiaMotion.torque"]  # with run.units; run.summary; humanwalk.plot(run, "joint_torques")
"""

from importlib import import_module
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from humanwalk.diagrams.playback import make_playback
    from humanwalk.diagrams.walker import make_walker
    from humanwalk.quantity import ParameterError
    from humanwalk.run.folder import Run
    from humanwalk.run.outcome import Outcome
    from humanwalk.run.simulate import simulate
    from humanwalk.scenario import Scenario, load_scenario
    from humanwalk.study.cluster import local_client
    from humanwalk.study.execute import run_study
    from humanwalk.study.study import Study, load_study
    from humanwalk.study.table import read_table
    from humanwalk.study.tune import tune
    from humanwalk.study.tuning import Tuning, load_tuning
    from humanwalk.view.plots import plot

__version__ = version("humanwalk")

_HOMES = {
    "Outcome": "humanwalk.run.outcome",
    "ParameterError": "humanwalk.quantity",
    "Run": "humanwalk.run.folder",
    "Scenario": "humanwalk.scenario",
    "Study": "humanwalk.study.study",
    "Tuning": "humanwalk.study.tuning",
    "load_scenario": "humanwalk.scenario",
    "load_study": "humanwalk.study.study",
    "load_tuning": "humanwalk.study.tuning",
    "local_client": "humanwalk.study.cluster",
    "make_playback": "humanwalk.diagrams.playback",
    "make_walker": "humanwalk.diagrams.walker",
    "plot": "humanwalk.view.plots",
    "read_table": "humanwalk.study.table",
    "run_study": "humanwalk.study.execute",
    "simulate": "humanwalk.run.simulate",
    "tune": "humanwalk.study.tune",
}

__all__ = [
    "Outcome",
    "ParameterError",
    "Run",
    "Scenario",
    "Study",
    "Tuning",
    "__version__",
    "load_scenario",
    "load_study",
    "load_tuning",
    "local_client",
    "make_playback",
    "make_walker",
    "plot",
    "read_table",
    "run_study",
    "simulate",
    "tune",
]


# Types come from the imports above; with this function every misspelled name would have type Any.
if not TYPE_CHECKING:

    def __getattr__(name: str) -> Any:
        """Import on first use: the command line's help should not wait for Drake."""
        if name not in _HOMES:
            raise AttributeError(f"module 'humanwalk' has no attribute {name!r}")
        return getattr(import_module(_HOMES[name]), name)

    def __dir__() -> list[str]:
        """Names for completion in notebooks."""
        return __all__
