"""What a simulation returns."""

from dataclasses import dataclass
from pathlib import Path

import pyarrow as pa

from humanwalk.measures.ends import COMPLETED
from humanwalk.measures.signals import TIME
from humanwalk.measures.summary import Summary, summarize
from humanwalk.measures.summary_rows import summary_rows, summary_title
from humanwalk.notebook import html_table
from humanwalk.run.folder import Run, new_run_folder, write_run
from humanwalk.scenario import Scenario


@dataclass(frozen=True, repr=False)
class Outcome:
    """A simulation that has ended.

    Attributes:
        scenario: what was simulated.
        signals: the record, see `humanwalk.measures.signals`.
        end: why it ended, see `humanwalk.measures.ends`; or "solver failed: ...".
        wall_time: wall-clock time of the simulation [s], without building the diagram.
    """

    scenario: Scenario
    signals: pa.Table
    end: str
    wall_time: float

    def __repr__(self) -> str:
        """The main figures; the signals are a table of some 320 columns."""
        rows, end = self.signals.num_rows, self.signals[TIME][-1].as_py()
        return f"Outcome({self.end!r} at {end:.2f} s, {rows} samples of {self.signals.num_columns} signals)"

    def _repr_html_(self) -> str:
        summary = self.summary()
        return html_table(summary_title(summary), summary_rows(summary))

    @property
    def survived(self) -> bool:
        """Whether the walker was up for the whole duration."""
        return self.end == COMPLETED

    def summary(self, name: str = "script") -> Summary:
        """The measures, under the name of the scenario; see `humanwalk.measures.summary.summarize`."""
        return summarize(self.scenario, self.signals, self.end, self.wall_time, name)

    def write(self, folder: Path, name: str = "script") -> Run:
        """Write scenario, signals and summary into a folder that is there; see `humanwalk.run.folder.write_run`."""
        return write_run(folder, self.scenario, self.signals, self.summary(name))

    def save(self, path: Path | str, name: str = "script") -> Run:
        """Write scenario, signals and summary into a new or empty folder, and return the run.

        Raises:
            ParameterError: the folder holds files already, or cannot be written.
        """
        folder = Path(path)
        new_run_folder(folder, folder)
        return self.write(folder, name)
