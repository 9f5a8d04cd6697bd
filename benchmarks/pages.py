"""Puts the tables of benchmarks/results into the pages of docs, between their marks.

python benchmarks/pages.py
python benchmarks/pages.py runs/balance_speeds runs/push_random    # and takes over the tables of these studies
"""

import argparse
import json
import math
import re
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from studies import STUDIES, keep, table
from terrain_counts import terrain_walks

from humanwalk.bench.result import COLUMNS, read_result
from humanwalk.body import human
from humanwalk.body.skeleton import Joint
from humanwalk.files import write_text
from humanwalk.quantity import ParameterError

ROOT = Path(__file__).parents[1]
RESULTS = ROOT / "benchmarks" / "results"
DOCS = ROOT / "docs"
BUSY = 1.5
"""Load above which more than the measured process was running."""


def measured_on(machine: dict[str, Any]) -> str:
    busy = " The machine was busy with other work: ratios count, times do not." if machine["load"] > BUSY else ""
    return (
        f"Measured on: {machine['processor']}, {machine['cores']} cores, load {machine['load']:.1f}, "
        f"Drake {machine['drake']}, Python {machine['python']}.{busy}"
    )


def load(name: str) -> Any:
    data = json.loads((RESULTS / f"{name}.json").read_text(encoding="utf-8"))
    return data


def bench() -> str:
    result = read_result(RESULTS / "bench.json")
    rows = [
        [name, *(format(value(cost), form) for _, value, form in COLUMNS)] for name, cost in result.scenarios.items()
    ]
    seconds = next(iter(result.scenarios.values())).duration_s
    return (
        table(["scenario", *(heading for heading, _, _ in COLUMNS)], rows)
        + f"\n\n{measured_on(result.machine)} Repeats: {result.repeats}, of {seconds:g} s."
        + ("" if result.complete else f" Not complete: {result.progress}.")
    )


def scaling_time() -> str:
    data = load("scaling_time")
    found = data["found"]
    rows = [[str(r["minute"]), f"{1e3 * r['cpu_s_per_s']:.0f}", f"{r['resident_MB']:.1f}"] for r in found["rows"]]
    return (
        f"`{found['scenario']}`, recording off: {found['end']}, memory grows by "
        f"{found['growth_MB_per_minute']:.2f} MB a minute. With recording on, the record grows by "
        f"{found['record_MB_per_minute']:.1f} MB a minute, by design.\n\n"
        + table(["minute of walking", "ms for a simulated second", "memory MB"], rows)
        + f"\n\n{measured_on(data['machine'])}"
    )


def scaling_contacts() -> str:
    data = load("scaling_contacts")
    rows = [[str(r["contact_points"]), f"{1e3 * r['cpu_s_per_s']:.0f}", f"{r['ratio']:.2f}"] for r in data["found"]]
    return (
        table(["contact spheres", "ms for a simulated second", "ratio"], rows) + f"\n\n{measured_on(data['machine'])}"
    )


def scaling_workers() -> str:
    data = load("scaling_workers")
    rows = [[str(r["workers"]), f"{r['simulated_s_per_s']:.2f}", f"{r['ratio']:.2f}"] for r in data["found"]]
    return table(["processes", "simulated seconds per second", "ratio"], rows) + f"\n\n{measured_on(data['machine'])}"


def accuracy() -> str:
    data = load("accuracy")
    parts = []
    for scenario in ("thesis", "walk"):
        rows = [r for r in data["rows"] if r["scenario"] == scenario and "reference" not in r and "refused" not in r]
        base = next(r for r in rows if (r["contact"], r["method"], r["setting"]) == ("point", "lagged", 1.0))
        lines = [
            [
                f"{r['contact']}, {r['method']}",
                f"{r['setting']:g}" + ("" if r["method"] == "cenic" else " ms"),
                f"{r['force_rms_N']:.1f}",
                f"{1e3 * r['angle_rms_rad']:.2f}",
                f"{1e3 * r['com_rms_m']:.2f}",
                _number(r["speed_m_s"], ".3f"),
                _number(r["step_time_s"], ".3f"),
                f"{r['peak_force_N']:.0f}",
                f"{r['cpu_s_per_s'] / base['cpu_s_per_s']:.2f}",
                f"{1 / r['cpu_s_per_s']:.2f}",
            ]
            for r in rows
        ]
        headings = ["force N", "angle mrad", "COM mm", "speed m/s", "step s", "peak N", "cost", "x real"]
        parts.append(f"`{scenario}`\n\n" + table(["contact, method", "step or accuracy", *headings], lines))
        refused = [r for r in data["rows"] if r["scenario"] == scenario and "refused" in r]
        parts += [f"Refused at {r['setting']:g} ms: {r['refused']}." for r in refused]
        models = [
            f"{r['contact']}, {r['method']}: {r['force_rms_N']:.0f} N, {1e3 * r['angle_rms_rad']:.2f} mrad"
            for r in data["rows"]
            if r["scenario"] == scenario and "reference" in r and r["force_rms_N"] > 0
        ]
        parts.append(f"References against that of point, lagged: {'; '.join(models)}.")
    return "\n\n".join([*parts, measured_on(data["machine"])])


def _number(value: float | None, form: str) -> str:
    return "-" if value is None else format(value, form)


def mujoco() -> str:
    data = load("mujoco_physics")
    names = {
        "angle_rms_rad": ("joint angles, Drake - MuJoCo, rms", 1e3, "mrad"),
        "tracking_rms_rad_drake": ("joint angles off their targets, Drake, rms", 1e3, "mrad"),
        "tracking_rms_rad_mujoco": ("the same, MuJoCo", 1e3, "mrad"),
        "com_rms_m": ("center of mass, Drake - MuJoCo, rms", 1e3, "mm"),
        "force_size_rms_N": ("ground force (20 ms means), Drake, rms", 1.0, "N"),
        "force_rms_N": ("ground force, Drake - MuJoCo, rms", 1.0, "N"),
        "final_vertical_over_weight_drake": ("ground and support, mean of the last 0.5 s, Drake", 1.0, "m g"),
        "final_vertical_over_weight_mujoco": ("the same, MuJoCo", 1.0, "m g"),
        "drake_ms_per_step": ("bare plant, Drake", 1.0, "ms a step"),
        "mujoco_ms_per_step": ("mj_step, MuJoCo", 1.0, "ms a step"),
        "cost_ratio_median": ("Drake / MuJoCo, median of turns", 1.0, ""),
    }
    rows = [
        [name, *(f"{scale * data[case][key]:.4g} {unit}".strip() for case in ("stand", "walk"))]
        for key, (name, scale, unit) in names.items()
    ]
    dynamics, fall = data["dynamics"], data["fall"]
    return (
        f"Mass matrix in 50 random states: greatest difference {dynamics['mass_matrix_relative']:.1e} of its greatest "
        f"element; Coriolis, gyroscopic and gravity forces: {dynamics['bias_forces_relative']:.1e}. Free fall of a "
        f"limp, turning body, 0.3 s: center of mass off the parabola by {fall['com_off_parabola_m_drake']:.1e} m "
        f"(Drake) and {fall['com_off_parabola_m_mujoco']:.1e} m (MuJoCo), angles of the two within "
        f"{fall['angle_difference_rad']:.1e} rad.\n\n"
        + table(["", "standing", "thesis' walk"], rows)
        + f"\n\n{measured_on(data['machine'])} MuJoCo {data['machine']['mujoco']}."
    )


def contact_thesis() -> str:
    return _contact("thesis", {"with the support's": ("{:.3f} m g", "mean_with_support_weights")})


def contact_walk() -> str:
    return _contact("walk", {})


def _contact(walk: str, more: dict[str, tuple[str, ...]]) -> str:
    runs = load("contact")[walk]
    lines = {
        "end": ("{} at {:g} s", "end", "time_s"),
        "speed": ("{:.3f} m/s", "mean_speed_m_s"),
        "mean vertical ground force": ("{:.3f} m g", "mean_vertical_force_weights"),
        **more,
        "greatest force on a foot (at 200 Hz)": ("{:.1f} m g", "largest_vertical_force_weights"),
        "friction use, median and 95 %": ("{:.2f}, {:.2f}", "friction_use_median", "friction_use_95_percent"),
        "slip per step": ("{:.1f} mm", "slip_per_step_mm"),
        "penetration, median and 95 %": ("{:.1f}, {:.1f} mm", "penetration_median_mm", "penetration_95_percent_mm"),
        "real-time factor, by processor time": ("{:.2f}", "realtime_factor_cpu"),
    }
    rows = [
        [name, *(form.format(*(run[key] for key in keys)) for run in runs.values())]
        for name, (form, *keys) in lines.items()
    ]
    return table(["", *runs], rows)


PERFORMANCE = (bench, accuracy, scaling_time, scaling_contacts, scaling_workers, mujoco)


def joints() -> str:
    def row(joint: Joint) -> list[str]:
        low, high = (f"{math.degrees(limit):.0f}" for limit in joint.range_rad)
        x, y, z = (f"{component:.0f}" for component in joint.axis)
        return [f"`{joint.name}`", joint.motion, f"({x}, {y}, {z})", f"{low} to {high}", f"{joint.effort_limit_N_m:g}"]

    headings = ["joint", "positive motion", "axis", "range [deg]", "torque limit [N m]"]
    return table(headings, map(row, human().joints))


PAGES: dict[Path, tuple[Callable[[], str], ...]] = {
    DOCS / "performance.md": PERFORMANCE,
    DOCS / "contact.md": (contact_thesis, contact_walk),
    DOCS / "howto/terrain.md": (terrain_walks,),
    DOCS / "reference/signals.md": (joints,),
    **{DOCS / page: sections for page, sections in STUDIES.items()},
}


def filled(page: Path) -> str:
    """The page with the tables of the results."""
    text = page.read_text(encoding="utf-8")
    for section in PAGES[page]:
        marks = re.compile(rf"(<!-- {section.__name__} -->\n).*?(<!-- end -->)", re.DOTALL)
        content = f"\n{section()}\n\n".replace("\\", r"\\")
        text, found = marks.subn(rf"\g<1>{content}\g<2>", text)
        if found != 1:
            raise ValueError(f"{page}: needs one mark <!-- {section.__name__} -->, has {found}")
    return text


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="*", type=Path, help="of shipped studies")
    try:
        for folder in parser.parse_args().folders:
            keep(folder)
    except ParameterError as error:
        sys.exit(f"pages: {error}")
    for page in PAGES:
        write_text(page, filled(page))
