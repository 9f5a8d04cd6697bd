"""The replay page in a run folder."""

from pathlib import Path

from pydrake.geometry import Meshcat

from humanwalk.files import write_text
from humanwalk.quantity import printable
from humanwalk.run.folder import REPLAY, Run
from humanwalk.run.replayed import show_run
from humanwalk.view.replay import MAX_TITLE, make_meshcat, static_page
from humanwalk.view.samples import encode_samples


def write_replay(run: Run, meshcat: Meshcat) -> Path:
    """Write the page of a run that Meshcat has recorded, whole or not at all; returns its path.

    Raises:
        ParameterError: it cannot be written.
    """
    title = f"{run.summary['scenario']}: {run.scenario.description}, {run.summary['duration_s']:g} s"
    samples = encode_samples(run.signals, run.scenario)
    page = run.subfolder(REPLAY)
    write_text(page, static_page(meshcat, printable(title, MAX_TITLE), samples))
    return page


def require_replay(run: Run) -> Path:
    """The page of a run; one that was walked without it gets it from its signals.

    Raises:
        ParameterError: the page cannot be written, or the signals cannot be read.
    """
    if run.subfolder(REPLAY).is_file():
        return run.replay
    meshcat = make_meshcat()
    show_run(run, meshcat)
    return write_replay(run, meshcat)
