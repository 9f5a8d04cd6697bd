"""Joint angles of your own, followed through the actuators with the balance support, and shown without physics.

Run it with: python examples/follow_a_recording.py
"""

import tempfile
from pathlib import Path

import numpy as np

from humanwalk import Run, load_scenario, simulate

SQUAT = {"LegFemurMotion": 1.0, "LegTibiaMotion": 2.0, "LegAnkleMotion": 1.0}
"""How far each joint bends, so that the soles stay level."""


def write_squat(path: Path, duration: float) -> None:
    """A squat of 30 degrees and back, as a table of angles; hips that are not named would be missed."""
    time = np.linspace(0.0, duration, 50)
    bend = np.deg2rad(30) * np.sin(np.pi * time / duration) ** 2
    names = [
        f"{side}{joint}"
        for side in ("Right", "Left")
        for joint in (*SQUAT, "LegFemurSideMotion", "LegFemurTwistMotion")
    ]
    columns = [SQUAT.get(name.removeprefix("Right").removeprefix("Left"), 0.0) * bend for name in names]
    header = ",".join(["time_s", *(f"{name}.angle_rad" for name in names)])
    np.savetxt(path, np.column_stack((time, *columns)), delimiter=",", header=header, comments="")


def main(folder: Path, duration: float = 2.0) -> dict[str, Run]:
    """Write the recording, follow it with and without physics, and return both runs."""
    recording = folder / "squat.csv"
    write_squat(recording, duration)
    runs = {}
    for name, kinematic in (("followed", "false"), ("shown", "true")):
        overrides = {
            "controller": f"{{recorded: {{angles: {recording}, kinematic: {kinematic}}}}}",
            "duration": str(duration),
        }
        runs[name] = simulate(load_scenario("thesis", overrides)).save(folder / name)
        print(f"{name}: the pelvis sinks by {100 * np.ptp(runs[name]['pelvis.z']):.1f} cm")
    print(f"the knee needs up to {runs['followed'].summary['peak_torque_N_m']['RightLegTibiaMotion']:.0f} N m")
    return runs


if __name__ == "__main__":
    main(Path(tempfile.mkdtemp()))
