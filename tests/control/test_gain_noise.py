"""Gains change by random factors with median 1 that depend on the seed only; other parameters do not change."""

from dataclasses import fields

import numpy as np
import pytest

from humanwalk.control.gain_noise import gain_factors, noisy_tasks
from humanwalk.control.whole_body_parameters import PrescribedGains, TaskGains, WholeBodyParameters

EXACT = WholeBodyParameters()


def noisy(noise: float, seed: int = 0) -> WholeBodyParameters:
    return noisy_tasks(EXACT, noise, np.random.default_rng(seed))


def test_factors_have_the_given_spread_and_are_positive() -> None:
    factors = gain_factors(2000, 0.05, np.random.default_rng(0))
    assert np.std(np.log(factors)) == pytest.approx(0.05, rel=0.1)
    assert gain_factors(2000, 0.5, np.random.default_rng(0)).min() > 0.0


def test_without_noise_the_gains_do_not_change() -> None:
    assert noisy(0.0) == EXACT


def test_the_noise_depends_on_the_seed_only() -> None:
    assert noisy(0.1) == noisy(0.1) != noisy(0.1, seed=1)


def test_stiffness_and_damping_of_every_task_change_and_nothing_else() -> None:
    changed = noisy(0.1)
    for field in fields(EXACT):
        before, after = getattr(EXACT, field.name), getattr(changed, field.name)
        if isinstance(before, TaskGains | PrescribedGains):
            for gain in ("stiffness", "damping"):
                assert (getattr(before, gain) != getattr(after, gain)) == (getattr(before, gain) > 0.0)
            assert getattr(before, "weight", None) == getattr(after, "weight", None)
        else:
            assert before == after
