"""A figure of your own from a simulation that is kept in memory: knee torques over time.

Run it with: python examples/plot_joint_torques.py
"""

from pathlib import Path

from matplotlib.figure import Figure

from humanwalk import load_scenario, simulate


def main(duration: float = 3.0, path: Path = Path("knee_torques.png")) -> Figure:
    """Walk for some seconds [s], and write and return the figure."""
    signals = simulate(load_scenario("thesis", {"duration": str(duration)})).signals
    figure = Figure(figsize=(7, 3), layout="constrained")
    axes = figure.subplots()
    for side in ("Right", "Left"):
        axes.plot(signals["time_s"], signals[f"{side}LegTibiaMotion.torque_N_m"], label=f"{side.lower()} knee")
    axes.set_xlabel("time [s]")
    axes.set_ylabel("torque, flexion positive [N m]")
    axes.legend()
    figure.savefig(path)
    print(f"{path}")
    return figure


if __name__ == "__main__":
    main()
