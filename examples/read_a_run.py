"""What is in a run folder: signals with units, measures, plots, and files for other programs.

Run it with: python examples/read_a_run.py runs/thesis
"""

import sys
from pathlib import Path

import numpy as np

from humanwalk import Run, plot
from humanwalk.exchange import export_run


def main(folder: Path) -> float:
    """Print what the run says, export it, and return the greatest force on the right foot [N]."""
    run = Run.open(folder)
    print(f"{run.summary['scenario']}: {run.summary['end']} after {run.time[-1]:g} s")
    print(f"commanded {run.scenario.controller.commanded_speed:g} m/s, walked {run.summary['mean_speed_m_s']} m/s")

    force = run["right_foot.force_z"]
    print(f"greatest force on the right foot: {force.max():.0f} {run.units['right_foot.force_z_N']}")
    knee = np.rad2deg(run["RightLegTibiaMotion.angle"])
    print(f"the right knee goes from {knee.min():.0f} to {knee.max():.0f} degrees")

    figure = plot(run, "ground_reaction")
    figure.savefig(folder / "my_ground_reaction.png")
    for path in export_run(run, "opensim"):
        print(f"wrote {path}")
    # run.signals is an Arrow table: run.signals.to_pandas() where pandas is installed.
    return float(force.max())


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "runs/thesis"))
