"""Which library solver suits the whole-body program: time, failures and error over the programs of a walk.

    python -m pip install piqp proxsuite
    python benchmarks/qp_solvers.py --duration 6

DAQP is the solver that humanwalk uses; PIQP and ProxQP, of the package proxsuite, are none of its dependencies. The
solvers take turns program by program.
"""

import argparse
import logging
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
import piqp
from proxsuite import proxqp

from humanwalk.control.quadratic_program import QuadraticProgram
from humanwalk.run.simulate import simulate
from humanwalk.scenario import load_scenario

Array = npt.NDArray[np.float64]
Solve = Callable[[QuadraticProgram], Array | None]


def programs_of_a_walk(duration: float) -> list[QuadraticProgram]:
    programs: list[QuadraticProgram] = []
    solution = QuadraticProgram.solution

    def record(self: QuadraticProgram) -> Array | None:
        programs.append(self)
        return solution(self)

    QuadraticProgram.solution = record  # type: ignore[method-assign]
    try:
        simulate(load_scenario("walk", {"duration": str(duration)}))
    finally:
        QuadraticProgram.solution = solution  # type: ignore[method-assign]
    return programs


def parts(program: QuadraticProgram) -> tuple[Array, ...]:
    """H, g, A, b, C, lower, upper, x_lower, x_upper: equations and inequalities apart."""
    H, g, A, lower, upper = program
    x, rows = slice(0, g.size), slice(g.size, None)
    equation = lower[rows] == upper[rows]
    row_bounds = (A[~equation], lower[rows][~equation], upper[rows][~equation])
    return H, g, A[equation], upper[rows][equation], *row_bounds, lower[x], upper[x]


def with_daqp(program: QuadraticProgram) -> Array | None:
    return program.solution()


def with_piqp(tolerance: float) -> Solve:
    def solve(program: QuadraticProgram) -> Array | None:
        H, g, A, b, C, lower, upper, x_lower, x_upper = parts(program)
        solver = piqp.DenseSolver()
        solver.settings.eps_abs = solver.settings.eps_rel = tolerance
        column_major = np.asfortranarray
        solver.setup(column_major(H), g, column_major(A), b, column_major(C), lower, upper, x_lower, x_upper)
        is_solved = solver.solve() == piqp.PIQP_SOLVED
        found: Array = solver.result.x
        return found if is_solved else None

    return solve


def with_proxqp(tolerance: float, warm: bool) -> Solve:
    solvers: dict[tuple[int, ...], Any] = {}

    def solve(program: QuadraticProgram) -> Array | None:
        matrices = parts(program)
        size = len(matrices[0]), len(matrices[3]), len(matrices[5])
        solver = solvers.get(size) if warm else None
        if solver is None:
            solver = solvers[size] = proxqp.dense.QP(*size, True)
            solver.settings.eps_abs = tolerance
            solver.settings.max_iter = 200
            solver.init(*matrices)
        else:
            solver.settings.initial_guess = proxqp.InitialGuess.WARM_START_WITH_PREVIOUS_RESULT
            solver.update(*matrices, update_preconditioner=True)
        solver.solve()
        if solver.results.info.status == proxqp.QPSolverOutput.PROXQP_SOLVED:
            found: Array = solver.results.x.copy()
            return found
        del solvers[size]
        return None

    return solve


def main() -> None:
    logging.getLogger("drake").setLevel(logging.ERROR)
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--duration", type=float, default=6.0, help="of the walk whose programs are solved [s]")
    programs = programs_of_a_walk(parser.parse_args().duration)
    exact = with_piqp(1e-9)
    references = [exact(program) for program in programs]
    solvers = {
        "DAQP, cold": with_daqp,
        "PIQP 1e-6, cold": with_piqp(1e-6),
        "ProxQP 1e-4, cold": with_proxqp(1e-4, warm=False),
        "ProxQP 1e-4, warm": with_proxqp(1e-4, warm=True),
    }
    times: dict[str, list[float]] = {name: [] for name in solvers}
    errors: dict[str, list[float]] = {name: [] for name in solvers}
    for program, reference in zip(programs, references, strict=True):
        for name, solve in solvers.items():
            began = time.process_time()
            x = solve(program)
            times[name].append(1e3 * (time.process_time() - began))
            if x is not None and reference is not None:
                errors[name].append(float(np.abs(x - reference)[-34:].max()))
    unsolved = sum(reference is None for reference in references)
    print(f"{len(programs)} programs, {unsolved} without reference; processor time")
    print(f"{'solver':20}{'median ms':>10}{'mean ms':>9}{'99 % ms':>9}{'failures':>9}{'worst error':>13}")
    for name, spent in times.items():
        failures = len(programs) - unsolved - len(errors[name])
        summary = f"{np.median(spent):10.3f}{np.mean(spent):9.3f}{np.percentile(spent, 99):9.3f}"
        print(f"{name:20}{summary}{failures:9d}{max(errors[name]):13.1e}")


if __name__ == "__main__":
    main()
