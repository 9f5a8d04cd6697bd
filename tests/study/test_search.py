"""The search alone, on a sphere function."""

from collections.abc import Mapping, Sequence

import pytest

from humanwalk.study.objectives import Score
from humanwalk.study.search import HIGH, LOW, SAMPLERS, Asked, importance, search
from humanwalk.study.tuning import Range

NAMES = ("x", "y", "z")
OPTIMUM = 0.4


def distance(coordinates: Mapping[str, float], place: float) -> float:
    return sum((value - place) ** 2 for value in coordinates.values())


def searched(sampler: str, trials: int, seed: int = 1, population: int = 8) -> list[tuple[Asked, Score]]:
    """Every trial of a search for the points near OPTIMUM, and for the nearest to its mirror image as a second goal."""
    found: list[tuple[Asked, Score]] = []

    def evaluate(batch: Sequence[Asked]) -> Sequence[Score]:
        scores = []
        for _, at in batch:
            near, mirrored = distance(at, OPTIMUM), distance(at, -OPTIMUM)
            scores.append(Score((near, mirrored), {"right": max(-at["x"], 0.0)}, near))
        found.extend(zip(batch, scores, strict=True))
        return scores

    search(sampler, seed, population, NAMES, 2, trials, evaluate)
    return found


@pytest.mark.parametrize("sampler", SAMPLERS)
def test_the_first_trial_is_the_start_and_all_lie_in_range(sampler: str) -> None:
    trials = [asked for asked, _ in searched(sampler, 40)]
    assert [number for number, _ in trials] == list(range(40))
    assert trials[0][1] == dict.fromkeys(NAMES, 0.0)
    assert all(LOW <= value <= HIGH for _, at in trials for value in at.values())


@pytest.mark.parametrize("sampler", SAMPLERS)
def test_the_same_seed_gives_the_same_trials_and_a_longer_search_begins_with_them(sampler: str) -> None:
    trials = searched(sampler, 60)
    assert searched(sampler, 60) == trials
    assert searched(sampler, 45) == trials[:45]
    assert searched(sampler, 60, seed=2) != trials


def test_cma_es_approaches_the_optimum() -> None:
    trials = searched("cma_es", 161)
    assert min(score.cost for _, score in trials) < 0.01 * trials[0][1].cost


def test_nsga2_finds_points_between_both_optima_within_the_constraint() -> None:
    """The Pareto front is the line from one optimum to the other; the constraint leaves the half with x >= 0."""
    late = [(at, score) for (number, at), score in searched("nsga2", 401, population=20) if number > 300]
    assert sum(score.feasible for _, score in late) > 0.7 * len(late)
    assert min(score.losses[0] for _, score in late) < 0.1
    assert min(score.losses[1] for _, score in late if score.feasible) < 0.8


def test_the_parameter_that_decides_is_the_most_important() -> None:
    trials = [(at, at["y"] ** 2 + 0.01 * at["x"]) for (_, at), _ in searched("nsga2", 100, population=100)]
    shares = importance(dict.fromkeys(NAMES, Range(LOW, HIGH)), trials)
    assert next(iter(shares)) == "y"
    assert sum(shares.values()) == pytest.approx(1.0)
