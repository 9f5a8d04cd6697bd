"""What is in a run folder: signals with units, measures, plots, and files for other programs.

Run it with: python examples/read_a_run.py runs/thesis
"""

import sys
from pathlib import Path

import numpy as np

from humanwalk import Run, plot
from humanwalk.exchange import export_run


def text(speed: float | None) -> str:
    """A speed with its unit, or that there is none."""
    return "-" if speed is None else f"{speed:.2f} m/s"


def main(folder: Path) -> float:
    """Print what the run says, export it, and return the greatest force on the right foot [N]."""
    run = Run.open(folder)
    print(f"{run.summary['scenario']}: {run.summary['end']} after {run.time[-1]:g} s")
    # A number that a run does not have is None: a walker that fell early has no mean speed of steady walking.
    commanded, walked = run.scenario.controller.commanded_speed, run.summary["mean_speed_m_s"]
    print(f"commanded {text(commanded)}, walked {text(walked)}")

    force = run["right_foot.force_z"]
    print(f"greatest force on the right foot: {force.max():.0f} {run.units['right_foot.force_z_N']}")
    knee = np.rad2deg(run["RightLegTibiaMotion.angle"])
    print(f"the right knee goes from {knee.min():.0f} to {knee.max():.0f} degrees")

    plot(run, "ground_reaction").savefig(folder / "my_ground_reaction.png")
    for path in export_run(run, "opensim"):
        print(f"wrote {path}")
    # run.signals is an Arrow table: run.signals.to_pandas() where pandas is installed.
    return float(force.max())


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "runs/thesis"))
