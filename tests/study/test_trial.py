import pytest

from humanwalk.scenario import Scenario, load_scenario
from humanwalk.study import trial
from humanwalk.study.row import Job, Row
from humanwalk.study.study import parse_study
from humanwalk.study.trial import OF_RUNS, RUNS, Trial, simulate_trial

STUDY = parse_study("{scenario: walk, factors: {seed: {seeds: {count: 5}}}}")


def run_of(end: str = "completed", duration: float = 20.0, **measures: float | None) -> Row:
    row = {"end": end, "survived": end == "completed", "duration_s": duration}
    return row | {"mean_speed_m_s": None, "commanded_speed_m_s": None} | measures


def pushed(*times: float) -> Scenario:
    return load_scenario("walk", {"pushes.given": str([{"time": time} for time in times])})


@pytest.mark.parametrize(("falls", "simulated"), [(1, 2), (2, 4), (3, 5), (9, 5)])
def test_no_run_is_simulated_after_too_many_falls(falls: int, simulated: int, monkeypatch: pytest.MonkeyPatch) -> None:
    def every_second_falls(job: Job) -> Row:
        assert job.scenario.seed == job.index
        return run_of("fell", 5.0) if job.index % 2 else run_of()

    monkeypatch.setattr(trial, "simulate_row", every_second_falls)
    rows = simulate_trial(Trial(7, STUDY, falls))[RUNS]
    assert len(rows) == simulated
    assert [row["upright_share"] for row in rows] == [1.0, 0.25, 1.0, 0.25, 1.0][:simulated]


@pytest.mark.parametrize(
    ("row", "share"),
    [(run_of(), 1.0), (run_of("fell", 4.0), 0.0), (run_of("fell", 9.0), 0.5), (run_of("solver failed: x", 19.0), 1.0)],
)
def test_a_push_counts_as_survived_if_the_walker_is_upright_three_seconds_later(row: Row, share: float) -> None:
    """The third push would come after the end of the run."""
    assert OF_RUNS["pushes_survived_share"](pushed(2.0, 12.0, 21.0), row) == share


def test_without_pushes_a_run_that_survives_has_survived_all() -> None:
    walk = load_scenario("walk")
    assert OF_RUNS["pushes_survived_share"](walk, run_of()) == 1.0
    assert OF_RUNS["pushes_survived_share"](walk, run_of("fell", 19.0)) == 0.0


def test_the_speed_error_is_the_distance_from_the_commanded_speed() -> None:
    error = OF_RUNS["speed_error_m_s"]
    walk = load_scenario("walk")
    assert error(walk, run_of(mean_speed_m_s=1.3, commanded_speed_m_s=1.4)) == pytest.approx(0.1)
    assert error(walk, run_of(mean_speed_m_s=1.5, commanded_speed_m_s=1.4)) == pytest.approx(0.1)
    assert error(walk, run_of("fell", 1.0, commanded_speed_m_s=1.4)) is None
