"""Simulates a run again and says whether the same came out."""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from humanwalk.quantity import ParameterError, file_paths
from humanwalk.run.folder import Run
from humanwalk.run.provenance import Provenance, file_hash, scenario_hash, versions
from humanwalk.run.simulate import simulate

TOLERANCE = 0.01
"""Measures agree if they differ by no more than this share, or by 1e-3 of their unit."""
SMALL = 1e-3

NOT_OF_THE_WALK = ("wall_time_s", "realtime_factor", "versions", "scenario", "description")


@dataclass(frozen=True)
class Reproduction:
    """What came of repeating a run.

    Attributes:
        bits_agree: every number of every signal is the same.
        measures_agree: every measure is the same within TOLERANCE.
        notes: one line each: what was changed since the run, and what differs.
    """

    bits_agree: bool
    measures_agree: bool
    notes: tuple[str, ...]

    @property
    def verdict(self) -> str:
        """One line."""
        if self.bits_agree:
            return "the same bits in every signal"
        share = f"{100 * TOLERANCE:g} %"
        return f"other bits, the same measures within {share}" if self.measures_agree else "other measures"


def reproduce(run: Run, on_progress: Callable[[float], None] | None = None) -> Reproduction:
    """Repeat a run from the scenario in its folder; one that was interrupted, up to where it was.

    Raises:
        ParameterError: the run's scenario cannot be simulated any more, or its recording is gone.
    """
    scenario, then = run.scenario, run.summary["provenance"]
    notes = list(_changes(run, then))
    last = float(run.time[-1])
    again = simulate(
        replace(scenario, duration=last) if run.summary["end"] == "interrupted" and last > 0 else scenario,
        on_progress=on_progress,
    )
    old, new = run.signals, again.signals
    other = sorted(set(old.column_names) ^ set(new.column_names))
    if other:
        # Measures need the signals of this version.
        return Reproduction(False, False, (*notes, f"signals that only one of them has: {', '.join(other)}"))
    if old.num_rows != new.num_rows:
        notes.append(f"{new.num_rows} rows where there were {old.num_rows}")
    rows = min(old.num_rows, new.num_rows)
    differ = {}
    for name in old.column_names:
        unequal = np.flatnonzero(old[name].to_numpy()[:rows] != new[name].to_numpy()[:rows])
        if unequal.size:
            differ[name] = int(unequal[0])
    if differ:
        first = min(differ, key=lambda name: differ[name])
        notes.append(f"{len(differ)} signals differ, first {first} at {run.time[differ[first]]:g} s")
    old_measures = dict(_numbers(replace(again, signals=old, end=run.summary["end"]).summary()))
    new_measures = dict(_numbers(replace(again, end=_end(run, again.end)).summary()))
    apart = [
        f"{name}: {new_measures.get(name)} where it was {value}"
        for name, value in old_measures.items()
        if not _agree(value, new_measures.get(name))
    ]
    notes.extend(apart[:10])
    bits = not differ and old.num_rows == new.num_rows
    return Reproduction(bits, bits or not apart, tuple(notes))


def _end(run: Run, end: str) -> str:
    # Up to where a person stopped it, a run that goes on is the same.
    return "interrupted" if run.summary["end"] == "interrupted" and end == "completed" else end


def _changes(run: Run, then: Provenance) -> Iterator[str]:
    """What is not as it was when the run was made."""
    if then["scenario_sha256"] != scenario_hash(run.scenario):
        yield "scenario.yaml was changed since the run, or has fields that this version reads otherwise"
    for field, path in file_paths(run.scenario.controller).items():
        if _followed_hash(path) != then["files_sha256"].get(field):
            yield f"{path} was changed since the run"
    now = versions()
    for name, was in then["versions"].items():
        if now.get(name) != was:
            yield f"{name} is {now.get(name)}, was {was}"


def _followed_hash(path: str) -> str:
    found = file_hash(path)
    if found is None:
        raise ParameterError(f"follow: {path} is gone; allowed: the file that was followed; put it back")
    return found


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
