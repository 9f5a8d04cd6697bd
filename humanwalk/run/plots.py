"""The thesis' figures of a run."""

from humanwalk.run.folder import Run


def write_plots(run: Run) -> None:
    """Write the plots of a run."""
