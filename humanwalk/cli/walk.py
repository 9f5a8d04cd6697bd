"""One walk: simulate with a progress bar, write the run folder, print the summary."""

import json
import os
import shutil
import sys
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Column, Table

from humanwalk.body.subject import Subject
from humanwalk.choices.style import RecordedStyle
from humanwalk.cli.common import print_warnings, simulated_progress
from humanwalk.measures.summary_rows import summary_rows, summary_title
from humanwalk.motion.motion_table import read_motion_table
from humanwalk.quantity import ParameterError, numbers_of, printable
from humanwalk.run.checkpoint import CHECKPOINT_PERIOD
from humanwalk.run.folder import RUNS, Run, claimed, new_run_folder, require_room
from humanwalk.run.live_view import is_lost
from humanwalk.run.outcome import Outcome
from humanwalk.run.simulate import simulate
from humanwalk.scenario import Scenario, load_scenario, shipped_scenarios
from humanwalk.view.replay import make_meshcat
from humanwalk.view.replay_file import write_replay
from humanwalk.walking.step_timing import StepTiming

STEP_RANGE = next((of["low"], of["high"]) for name, _, of in numbers_of(StepTiming()) if name == "step")
"""Shortest and longest step that the walker may take [s], for the reference body."""

LOST = "the live view was lost: a web page sent a message that Meshcat cannot read; close pages that you do not trust"


def walk_and_write(
    scenario: str,
    overrides: Mapping[str, str],
    output: Path | None,
    *,
    name: str | None = None,
    live: bool,
    replay: bool,
    plots: bool,
    console: Console,
    checkpoint_period: float = CHECKPOINT_PERIOD,
) -> Run:
    """Simulate a scenario and write its run folder.

    Args:
        scenario: Name or path.
        overrides: See `load_scenario`.
        output: Folder of the run, or None for the next free one under runs/.
        name: Name of the run, instead of the scenario's.
        live: Whether to show the simulation in the browser.
        replay, plots: Whether to write them.
        console: Where progress and summary are printed.
        checkpoint_period: Wall-clock seconds between checkpoints; a killed program leaves the last one.

    Raises:
        ParameterError: Invalid input; no incomplete file is left behind.
    """
    loaded = load_scenario(scenario, overrides)
    name = name or name_of(scenario)
    print_warnings(loaded.warnings, console)
    recording = make_meshcat() if replay else None
    shown = make_meshcat(live=True) if live else None
    try:
        with run_folder(output, RUNS / name, loaded) as path:
            if shown is not None:
                console.print(f"live at {shown.web_url()}")
            _simulate_and_write(loaded, name, path, recording, shown, checkpoint_period, console)
    except RuntimeError:
        if shown is None or not is_lost(shown):
            raise
        raise ParameterError(LOST) from None
    if shown is not None and is_lost(shown):
        console.print(LOST, soft_wrap=True)
    run = Run.open(path)
    if not run.summary["physics"]:
        console.print("no physics: joints and pelvis follow the recording exactly; no forces, torques or balance")
    illustrate(run, recording, plots=plots, console=console)
    return run


def name_of(scenario: str) -> str:
    """Name of a run of a scenario, which is given by name or path."""
    return scenario if scenario in shipped_scenarios() else file_name(Path(scenario))


@contextmanager
def run_folder(wanted: Path | None, otherwise: Path, scenario: Scenario) -> Iterator[Path]:
    """The folder of a new run, claimed within the block; removed after it if nothing was written; see `new_run_folder`.

    Raises:
        ParameterError: It is in use, cannot be made, or its disk is too full for the scenario.
    """
    path, made = new_run_folder(wanted, otherwise)
    # A folder that another run has claimed meanwhile stays: the claim is outside the block that removes the folder.
    with claimed(path):
        try:
            require_room(path, scenario)
            yield path
        finally:
            # An empty folder would obstruct the next attempt.
            with suppress(OSError):
                for folder in made:
                    folder.rmdir()


def illustrate(run: Run, replay: Any, *, plots: bool, console: Console) -> None:
    """Write replay page and plots into a run folder, and print the summary.

    Args:
        run: The run.
        replay: A Meshcat with its recording; None for no page.
        plots: Whether to write them.
        console: Where progress and summary are printed.
    """
    with console.status("writing replay and plots"):
        if replay is not None:
            write_replay(run, replay)
        if plots and run.summary["physics"]:
            # Importing matplotlib takes half a second, which every walk would wait before its start.
            from humanwalk.view.plots import write_plots

            write_plots(run)
    console.print(summary_table(run.summary))
    if run.summary["fall"] is not None:
        console.print(run.summary["fall"]["description"], soft_wrap=True)
    console.print(f"{run.path}: " + ", ".join(sorted(entry.name for entry in run.path.iterdir())))
    if replay is not None:
        console.print(f"show it: {program()} replay {run.path}", soft_wrap=True)


def file_name(path: Path) -> str:
    """Name of the run of a file."""
    return path.stem.strip(".") or "scenario"


def program() -> str:
    """How this program is called in the present folder, for messages that show a command."""
    called = Path(sys.argv[0])
    if called.name == "__main__.py":
        return "python -m humanwalk"
    return "humanwalk" if shutil.which("humanwalk") else os.path.relpath(called)


def follow_overrides(recording: Path, mapping: Path | None, kinematic: bool) -> dict[str, str]:
    """Overrides of a scenario that follows a recording to its end, with or without physics.

    Raises:
        ParameterError: The recording cannot be read.
    """
    time = read_motion_table(recording).time
    recorded = _files(recording, mapping) | {"kinematic": kinematic}
    # JSON is YAML, and quotes any character in a path.
    return {
        "controller": json.dumps({"recorded": recorded}),
        "duration": repr(float(time[-1] - time[0])),
        "description": json.dumps(f"{recording.name}, followed{' without physics' if kinematic else ''}"),
    }


def balanced_overrides(recording: Path, mapping: Path | None, subject: Subject) -> dict[str, str]:
    """Overrides of a scenario that walks a recording on its own feet: its angles as style, its speed and its steps.

    Args:
        recording: File of joint angles with the path of the pelvis.
        mapping: File that assigns columns to joints; None: by name.
        subject: Body that the recording is applied to.

    Raises:
        ParameterError: The recording cannot be read, is not a walk, or has steps that the walker cannot take.
    """
    style = RecordedStyle(**_files(recording, mapping))
    gait = style.gait(subject)
    low, high = (subject.scale.time * end for end in STEP_RANGE)
    if not low <= gait.step <= high:
        raise ParameterError(
            f"{printable(recording)}: a step takes {gait.step:.3g} s; allowed: {low:.3g} to {high:.3g} s for this "
            "subject; give the time, its first column or that named time, in s, or record another walk"
        )
    walker = {
        "command": {"points": [{"time": 0.2, "forward": gait.speed}], "acceleration": 1.0},
        # Parameters are those of the reference body.
        "planner": {"timing": {"step": gait.step / subject.scale.time, "walk_ratio": 0.0}},
        "style": {"recorded": _files(recording, mapping)},
    }
    return {
        "controller": json.dumps({"balanced": walker}),
        "description": json.dumps(f"{recording.name}, walked without external force at {gait.speed:.2f} m/s"),
    }


def _files(recording: Path, mapping: Path | None) -> dict[str, Any]:
    """Fields of a controller or a style that name a recording and its mapping."""
    files = {"angles": recording, "mapping": mapping}
    return {name: str(file.absolute()) for name, file in files.items() if file is not None}


def write_or_rescue(path: Path, outcome: Outcome, name: str) -> None:
    """Write the run into its folder, or, if that fails, into a temporary one, so that the simulation is not lost.

    Raises:
        ParameterError: The run was not written to `path`; the message has the other folder.
    """
    try:
        outcome.write(path, name)
    except ParameterError as error:
        try:
            rescue = Path(tempfile.mkdtemp(prefix="humanwalk-"))
        except OSError:
            raise error from None
        try:
            outcome.write(rescue, name)
        except ParameterError:
            shutil.rmtree(rescue, ignore_errors=True)
            raise error from None
        raise ParameterError(f"{error}; the run is saved in {rescue}") from None


def _simulate_and_write(
    scenario: Scenario, name: str, path: Path, recording: Any, live: Any, checkpoint_period: float, console: Console
) -> None:
    def checkpoint(so_far: Outcome) -> None:
        # A disk that is full now may have space at the end.
        with suppress(ParameterError):
            so_far.write(path, name)

    progress = simulated_progress(console)
    task = progress.add_task(name, total=scenario.duration)

    def show(time: float) -> None:
        # Started late: a scenario that cannot be simulated produces only a one-line error.
        if not progress.live.is_started:
            progress.start()
            if not console.is_terminal:
                console.print(f"{name}: walking {scenario.duration:g} s")
        progress.update(task, completed=time)

    try:
        simulate(
            scenario,
            recording,
            on_progress=show,
            realtime_rate=0.0 if live is None else 1.0,
            on_checkpoint=checkpoint,
            checkpoint_period=checkpoint_period,
            on_end=lambda outcome: write_or_rescue(path, outcome, name),
            live=live,
        )
    finally:
        if progress.live.is_started:
            progress.stop()


def summary_table(summary: Mapping[str, Any]) -> Table:
    """Main figures of a summary; see `summary_rows`."""
    table = Table("", Column(justify="right"), "", title=summary_title(summary), show_header=False)
    for row in summary_rows(summary):
        table.add_row(*row)
    return table
