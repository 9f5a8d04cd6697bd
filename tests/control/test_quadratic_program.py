"""Solutions are feasible and optimal; a program with NaN has none."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.control.quadratic_program import QuadraticProgram


@given(st.integers(0, 10_000))
def test_a_solution_is_feasible_and_no_feasible_direction_decreases_the_cost(seed: int) -> None:
    random = np.random.default_rng(seed)
    root = random.normal(size=(6, 6))
    A, inside = random.normal(size=(4, 6)), random.normal(size=6)
    lower = np.concatenate((inside, A @ inside)) - random.uniform(0.0, 1.0, 10)
    upper = np.concatenate((inside, A @ inside)) + random.uniform(0.0, 1.0, 10)
    lower[6] = upper[6] = A[0] @ inside
    H = root @ root.T + 0.1 * np.eye(6)
    program = QuadraticProgram(H, random.normal(size=6), A, lower, upper)
    x = program.solution()
    assert x is not None
    values = np.concatenate((x, A @ x))
    assert (values >= lower - 1e-5).all()
    assert (values <= upper + 1e-5).all()
    # A convex function is minimal where its slope toward every feasible point is not negative.
    slope = H @ x + program.g
    others = inside + random.normal(size=(200, 6)) * 0.1
    others -= np.outer((others - inside) @ A[0], A[0]) / (A[0] @ A[0])
    reached = np.hstack((others, others @ A.T))
    feasible = others[((reached >= lower - 1e-12) & (reached <= upper + 1e-12)).all(axis=1)]
    assert ((np.vstack((inside, feasible)) - x) @ slope >= -1e-4).all()


@pytest.mark.parametrize("field", ["H", "g", "A", "lower", "upper"])
def test_a_program_with_nan_has_no_solution(field: str) -> None:
    program = QuadraticProgram(np.eye(3), np.ones(3), np.ones((1, 3)), -np.ones(4), np.ones(4))
    assert program.solution() is not None
    assert program._replace(**{field: np.nan * getattr(program, field)}).solution() is None
