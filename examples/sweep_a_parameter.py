"""How the cost of transport depends on the step height: one simulation each, in processes of their own.

Run it with: python examples/sweep_a_parameter.py
"""

from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

from humanwalk import load_scenario, simulate


def walk(step_height: float, duration: float) -> dict[str, float]:
    """The summary of a walk with a step height [m]."""
    scenario = load_scenario(
        "thesis", {"controller.thesis.gait.path.step_height": str(step_height), "duration": str(duration)}
    )
    return simulate(scenario).summary(f"step height {step_height:g} m")


def main(
    step_heights: Sequence[float] = (0.10, 0.15, 0.20), duration: float = 4.0, processes: int = 2
) -> list[dict[str, float]]:
    """Print and return one summary for each step height [m]."""
    # Drake's diagrams cannot be sent to another process: each builds its own from the scenario.
    with ProcessPoolExecutor(processes, mp_context=get_context("spawn")) as pool:
        summaries = list(pool.map(walk, step_heights, [duration] * len(step_heights)))
    for height, summary in zip(step_heights, summaries, strict=True):
        print(f"{height:.2f} m: {summary['end']}, cost of transport {summary['cost_of_transport']}")
    return summaries


if __name__ == "__main__":
    main()
