"""How the cost of transport depends on the step height: a study, simulated by worker processes into a table.

Run it with: python examples/run_a_study.py
"""

from collections.abc import Sequence
from pathlib import Path

import pyarrow as pa

from humanwalk import Study, load_scenario, local_client, run_study
from humanwalk.study.factors import Values

STEP_HEIGHT = "controller.thesis.gait.path.step_height"


def main(
    folder: Path = Path("studies/step_height"),
    step_heights: Sequence[float] = (0.10, 0.15, 0.20),
    duration: float = 4.0,
    workers: int = 2,
) -> pa.Table:
    """Print and return one row for each step height [m]; a folder that has rows of the study resumes."""
    scenario = load_scenario("thesis", {"duration": str(duration)})
    study = Study(scenario=scenario, factors={STEP_HEIGHT: Values(tuple(step_heights))})
    with local_client(workers) as client:
        table = run_study(study, folder, client)
    for row in table.to_pylist():
        print(f"{row[STEP_HEIGHT]:.2f} m: {row['end']}, cost of transport {row['cost_of_transport']}")
    return table


# The worker processes import this file: without the condition each would run the study.
if __name__ == "__main__":
    main()
