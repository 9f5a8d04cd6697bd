"""Which library solver suits the whole-body program: time, failures and error over the programs of a walk.

    python -m pip install piqp
    python benchmarks/qp_solvers.py --duration 6

PIQP is no dependency of humanwalk; ProxQP, of the package proxsuite, is the solver that it uses.
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

from humanwalk.control.whole_body_qp import QuadraticProgram, WholeBodyQp
from humanwalk.run.simulate import simulate
from humanwalk.scenario import load_scenario

Array = npt.NDArray[np.float64]
Solve = Callable[[QuadraticProgram], Array | None]


def programs_of_a_walk(duration: float) -> list[QuadraticProgram]:
    programs: list[QuadraticProgram] = []
    solve = WholeBodyQp._solve

    def record(self: WholeBodyQp, program: QuadraticProgram) -> Array | None:
        programs.append(program)
        return solve(self, program)

    WholeBodyQp._solve = record  # type: ignore[method-assign]
    try:
        simulate(load_scenario("walk", {"duration": str(duration)}))
    finally:
        WholeBodyQp._solve = solve  # type: ignore[method-assign]
    return programs


def with_piqp(tolerance: float) -> Solve:
    def solve(program: QuadraticProgram) -> Array | None:
        H, g, A, b, C, lower, upper, x_lower, x_upper = program
        solver = piqp.DenseSolver()
        solver.settings.eps_abs = solver.settings.eps_rel = tolerance
        column_major = np.asfortranarray
        solver.setup(column_major(H), g, column_major(A), b, column_major(C), lower, upper, x_lower, x_upper)
        return solver.result.x if solver.solve() == piqp.PIQP_SOLVED else None

    return solve


def with_proxqp(tolerance: float, warm: bool) -> Solve:
    solvers: dict[int, Any] = {}

    def solve(program: QuadraticProgram) -> Array | None:
        size = program.g.size
        solver = solvers.get(size) if warm else None
        if solver is None:
            solver = solvers[size] = proxqp.dense.QP(size, program.b.size, program.lower.size, True)
            solver.settings.eps_abs = tolerance
            solver.settings.max_iter = 200
            solver.settings.initial_guess = proxqp.InitialGuess.WARM_START_WITH_PREVIOUS_RESULT
            solver.init(*program)
        else:
            solver.update(*program, update_preconditioner=True)
        solver.solve()
        if solver.results.info.status == proxqp.QPSolverOutput.PROXQP_SOLVED:
            return solver.results.x.copy()
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
    print(f"{len(programs)} programs\n{'solver':24}{'mean ms':>9}{'99 % ms':>9}{'failures':>9}{'worst error':>13}")
    for name, solve in (
        ("PIQP 1e-4", with_piqp(1e-4)),
        ("PIQP 1e-6", with_piqp(1e-6)),
        ("ProxQP 1e-4, cold", with_proxqp(1e-4, warm=False)),
        ("ProxQP 1e-4, warm", with_proxqp(1e-4, warm=True)),
    ):
        times, failures, error = [], 0, 0.0
        for program, reference in zip(programs, references, strict=True):
            began = time.perf_counter()
            x = solve(program)
            times.append(1e3 * (time.perf_counter() - began))
            if x is None:
                failures += 1
            elif reference is not None:
                error = max(error, float(np.abs(x - reference)[:34].max()))
        print(f"{name:24}{np.mean(times):9.3f}{np.percentile(times, 99):9.3f}{failures:9d}{error:13.1e}")


if __name__ == "__main__":
    main()
