"""The search of a tuning: Optuna's CMA-ES and NSGA-II, asked for a whole batch at a time and told of it in order.

A search is a pure function of the tuning and the scores of its trials: nothing else is stored. To resume, the same
trials are asked for again, and the stored scores are told instead of new ones (docs/decisions/0023).
"""

import logging
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import optuna

from humanwalk.study.objectives import Score
from humanwalk.study.tuning import Range

LOW, HIGH = -1.0, 1.0
"""Range of every coordinate of a search; 0 is the start."""


@dataclass(frozen=True)
class Sampler:
    """A sampler of Optuna.

    Attributes:
        make: makes it of seed and population.
        several: whether it minimizes all losses under constraints; if not, it minimizes the cost.
    """

    make: Callable[[int, int], optuna.samplers.BaseSampler]
    several: bool


SAMPLERS = {
    "cma_es": Sampler(lambda seed, size: optuna.samplers.CmaEsSampler(seed=seed, popsize=size), several=False),
    "nsga2": Sampler(lambda seed, size: optuna.samplers.NSGAIISampler(seed=seed, population_size=size), several=True),
}

Asked = tuple[int, Mapping[str, float]]
"""Number of a trial, and its coordinates by name."""


def search(
    sampler: str,
    seed: int,
    population: int,
    coordinates: Sequence[str],
    losses: int,
    trials: int,
    evaluate: Callable[[Sequence[Asked]], Sequence[Score] | None],
) -> None:
    """Ask for trials until there are enough.

    Trial 0 is the start, alone in its batch: without a trial that is complete, Optuna samples at random. Every further
    batch is one population.

    Args:
        sampler: a key of SAMPLERS.
        seed: of the sampler.
        population: trials of a batch.
        coordinates: names.
        losses: number of losses of a score.
        trials: number of trials.
        evaluate: returns the scores of a batch in order, None to end the search. It is not called with trials beyond
            the last one.
    """
    optuna.logging.set_verbosity(logging.ERROR)
    chosen = SAMPLERS[sampler]
    directions = [optuna.study.StudyDirection.MINIMIZE] * (losses if chosen.several else 1)
    study = optuna.create_study(directions=directions, sampler=chosen.make(seed, population))
    study.enqueue_trial(dict.fromkeys(coordinates, 0.0))
    space: dict[str, optuna.distributions.BaseDistribution] = {
        name: optuna.distributions.FloatDistribution(LOW, HIGH) for name in coordinates
    }
    for size in _batch_sizes(trials, population):
        batch = [study.ask(space) for _ in range(size)]
        asked = [(trial.number, trial.params) for trial in batch if trial.number < trials]
        scores = evaluate(asked)
        if scores is None:
            return
        for trial, score in zip(batch, scores, strict=False):
            if chosen.several:
                for name, violation in score.violations.items():
                    trial.set_constraint(name, violation)
            study.tell(trial, score.losses if chosen.several else score.cost)


def _batch_sizes(trials: int, population: int) -> Iterator[int]:
    """1, then whole populations, the last of which may exceed the number of trials."""
    yield 1
    for _ in range(1, trials, population):
        yield population


def importance(
    parameters: Mapping[str, Range], trials: Sequence[tuple[Mapping[str, float], float]]
) -> dict[str, float]:
    """Importance of every parameter for a low number, by PED-ANOVA, in decreasing order; the sum is 1.

    Watanabe, Bansal and Hutter (2023), IJCAI, 4389-4396.

    Args:
        parameters: ranges by name.
        trials: values of the parameters and the number of every trial, at least two.
    """
    optuna.logging.set_verbosity(logging.ERROR)
    study = optuna.create_study(direction="minimize")
    space: dict[str, optuna.distributions.BaseDistribution] = {
        name: optuna.distributions.FloatDistribution(limits.low, limits.high, log=limits.log)
        for name, limits in parameters.items()
    }
    for values, number in trials:
        study.add_trial(optuna.create_trial(params=dict(values), distributions=space, value=number))
    return optuna.importance.get_param_importances(study, evaluator=optuna.importance.PedAnovaImportanceEvaluator())
