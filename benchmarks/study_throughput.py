"""What a study costs beyond its runs: the gain of a second worker, and the time of a row that simulates nothing.

    python benchmarks/study_throughput.py workers
    python benchmarks/study_throughput.py rows --rows 10000

`workers` needs two idle cores. It simulates the same points with one worker and with two, by turns, and prints the
ratio of rows per second of each pair and its median. Starting the workers and their first run, which imports Drake,
are not part of it.
"""

import argparse
import statistics
import tempfile
import time
from pathlib import Path

from humanwalk.study.cluster import local_client
from humanwalk.study.execute import run_study
from humanwalk.study.row import Job, Row
from humanwalk.study.study import Study, parse_study

WALKS = "scenario: thesis\nset: {{duration: {duration}}}\nfactors: {{seed: {{seeds: {{count: {runs}}}}}}}"
WARM_UP = "scenario: thesis\nset: {{duration: 0.01}}\nfactors: {{seed: {{seeds: {{count: {workers}}}}}}}"
NOTHING = "factors: {{seed: {{seeds: {{count: {rows}}}}}}}"


def nothing(job: Job) -> Row:
    """The row of a run that is not simulated."""
    return {"end": "completed", "survived": True, "duration_s": job.scenario.duration}


def seconds(study: Study, workers: int) -> float:
    """Time of a study on a number of workers that have simulated before [s]."""
    with tempfile.TemporaryDirectory() as place, local_client(workers) as client:
        run_study(parse_study(WARM_UP.format(workers=4 * workers)), Path(place) / "warm_up", client)
        begin = time.perf_counter()
        run_study(study, Path(place) / "study", client)
        return time.perf_counter() - begin


def compare_workers(duration: float, runs: int, repeats: int) -> None:
    study = parse_study(WALKS.format(duration=duration, runs=runs))
    ratios = []
    for _ in range(repeats):
        one, two = seconds(study, 1), seconds(study, 2)
        ratios.append(one / two)
        print(f"{runs} runs of {duration:g} s: {one:.2f} s with one worker, {two:.2f} s with two: {one / two:.3f}")
    print(f"median {statistics.median(ratios):.3f}")


def time_rows(rows: int, workers: int) -> None:
    study = parse_study(NOTHING.format(rows=rows))
    with tempfile.TemporaryDirectory() as place, local_client(workers) as client:
        run_study(parse_study(NOTHING.format(rows=4 * workers)), Path(place) / "warm_up", client, function=nothing)
        begin, cpu = time.perf_counter(), time.process_time()
        table = run_study(study, Path(place) / "study", client, function=nothing)
        took = time.perf_counter() - begin
        cpu = time.process_time() - cpu
        size = (Path(place) / "study" / "table.csv").stat().st_size
    assert table.num_rows == rows
    print(
        f"{rows} rows in {took:.1f} s with {workers} workers: {1e3 * took / rows:.2f} ms and {size / rows:.0f} B a row"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["workers", "rows"])
    parser.add_argument("--rows", type=int, default=10_000)
    parser.add_argument("--workers", type=int, default=2, help="of `rows`")
    parser.add_argument("--duration", type=float, default=5.0, help="of a walk [s]")
    parser.add_argument("--runs", type=int, default=16, help="walks of a study")
    parser.add_argument("--repeats", type=int, default=3)
    arguments = parser.parse_args()
    if arguments.what == "rows":
        time_rows(arguments.rows, arguments.workers)
    else:
        compare_workers(arguments.duration, arguments.runs, arguments.repeats)


if __name__ == "__main__":
    main()
