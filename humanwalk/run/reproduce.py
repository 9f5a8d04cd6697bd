"""Re-runs a run and checks that the results match exactly, or within a tolerance."""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from humanwalk.measures.ends import COMPLETED, CUT_SHORT, INTERRUPTED
from humanwalk.quantity import ParameterError, file_paths
from humanwalk.run.folder import Run
from humanwalk.run.provenance import Provenance, file_hash, versions
from humanwalk.run.simulate import simulate

TOLERANCE = 0.01
SMALL = 1e-3
"""Measures match if they differ by no more than TOLERANCE of their value, or by SMALL in their unit."""

NOT_OF_THE_WALK = ("wall_time_s", "realtime_factor", "versions", "scenario", "description")


@dataclass(frozen=True)
class Reproduction:
    """Result of a re-run.

    Attributes:
        bits_agree: all signals match exactly.
        measures_agree: all measures match within TOLERANCE.
        notes: what has changed since the run, and what differs, one line each.
    """

    bits_agree: bool
    measures_agree: bool
    notes: tuple[str, ...]

    @property
    def verdict(self) -> str:
        """One line."""
        if not self.measures_agree:
            return "the same bits in every signal, but other measures" if self.bits_agree else "other measures"
        if self.bits_agree:
            return "the same bits in every signal"
        return f"other bits, the same measures within {100 * TOLERANCE:g} %"


def reproduce(run: Run, on_progress: Callable[[float], None] | None = None) -> Reproduction:
    """Re-run the scenario of a run folder; a run that was interrupted or left unfinished is repeated up to its end.

    `on_progress` is called with the simulated time [s].

    Raises:
        ParameterError: the scenario cannot be simulated, or its recording is gone.
        KeyboardInterrupt: Ctrl-C ended the repetition.
    """
    scenario, then = run.scenario, run.summary["provenance"]
    notes = list(_changes(run, then))
    last = float(run.time[-1])
    cut_short = run.summary["end"] in CUT_SHORT
    again = simulate(replace(scenario, duration=last) if cut_short and last > 0 else scenario, on_progress=on_progress)
    if again.end == INTERRUPTED:
        raise KeyboardInterrupt
    # The repetition of a run that was cut short completes its shorter duration.
    end = run.summary["end"] if cut_short and again.end == COMPLETED else again.end
    old, new = run.signals, again.signals
    other = sorted(set(old.column_names) ^ set(new.column_names))
    if other:
        # Measures need the signals of this version.
        return Reproduction(False, False, (*notes, f"signals that only one of them has: {', '.join(other)}"))
    if old.num_rows != new.num_rows:
        notes.append(f"{new.num_rows} rows where there were {old.num_rows}")
    rows = min(old.num_rows, new.num_rows)
    unequal = {name: old[name].to_numpy()[:rows] != new[name].to_numpy()[:rows] for name in old.column_names}
    differ = {name: int(places.argmax()) for name, places in unequal.items() if places.any()}
    if differ:
        first = min(differ, key=differ.__getitem__)
        notes.append(f"{len(differ)} signals differ, first {first} at {run.time[differ[first]]:g} s")
    old_measures = dict(_numbers(replace(again, signals=old, end=run.summary["end"]).summary()))
    new_measures = dict(_numbers(replace(again, end=end).summary()))
    apart = [
        f"{name}: {new_measures.get(name)} where it was {value}"
        for name, value in old_measures.items()
        if not _agree(value, new_measures.get(name))
    ]
    notes.extend(apart[:10])
    bits = not differ and old.num_rows == new.num_rows
    return Reproduction(bits, not apart, tuple(notes))


def _changes(run: Run, then: Provenance) -> Iterator[str]:
    """What has changed since the run, beside the scenario: `Run.scenario` tells that."""
    for field, path in file_paths(run.scenario).items():
        found = file_hash(path)
        if found is None:
            raise ParameterError(f"{field}: {path} is gone; allowed: the file of the run; put it back")
        if found != then["files_sha256"].get(field):
            yield f"{path} was changed since the run"
    now = versions()
    for name, was in then["versions"].items():
        if now.get(name) != was:
            yield f"{name} is {now.get(name)}, was {was}"


def _numbers(value: Any, name: str = "") -> Iterator[tuple[str, Any]]:
    if isinstance(value, Mapping):
        for key, item in value.items():
            if name or key not in NOT_OF_THE_WALK:
                yield from _numbers(item, f"{name}.{key}" if name else str(key))
    else:
        yield name, value


def _agree(a: Any, b: Any) -> bool:
    if isinstance(a, float) and isinstance(b, float | int):
        return math.isclose(a, b, rel_tol=TOLERANCE, abs_tol=SMALL)
    return bool(a == b)
