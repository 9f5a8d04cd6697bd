import hashlib
import io
import os
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pytest
from matplotlib.lines import Line2D
from PIL import Image, ImageFilter

from humanwalk.gait.normative import CYCLE
from humanwalk.measures.curves import ANGLES
from humanwalk.measures.signals import TIME
from humanwalk.measures.walk_measures import Walk
from humanwalk.quantity import ParameterError
from humanwalk.run.folder import Run
from humanwalk.run.outcome import Outcome
from humanwalk.scenario import Scenario, load_scenario
from humanwalk.terrain import Course
from humanwalk.terrain.steps import Stairs
from humanwalk.view.plots import PLOTS, write_gait_figures, write_plots
from humanwalk.view.plots.drawing import SIDE, new_figure
from humanwalk.view.plots.gait_figures import GAIT_FIGURES
from humanwalk.view.plots.ground import draw_faces

PERIOD = 0.01
STRIDE = 0.6
WEIGHT = 70 * 9.81

NEED_STRIDES = {
    *("joint_torques", "gait_cycle_angles", "gait_cycle_pelvis", "gait_cycle_hip_and_foot"),
    *("gait_cycle_moments", "gait_cycle_powers", "cop_under_soles"),
}
NEED_STEADY_WALK = {"tracking_error"}
NEED_SUPPORT = {"support_force", "support_torque"}

THESIS_NAMES = {name for name in PLOTS if name.startswith("figure_5_")}

UNITS = ("[s]", "[deg]", "[N m]", "[cm]", "[N]", "[m]", "[%]", "[W/kg]", "[N m/kg]")


def made_up_signals(columns: tuple[str, ...], duration: float) -> pa.Table:
    """A walk of sines: every column different, each foot on the ground for 60 % of its stride."""
    time = PERIOD * np.arange(round(duration / PERIOD) + 1)
    data = {name: np.sin(2 * np.pi * time / STRIDE + zlib.crc32(name.encode()) % 1000) for name in columns}
    data["com.x_m"], data["com.y_m"] = 1.4 * time, 0.01 * np.sin(time)
    for side, lag, y in (("right", 0.0, -0.1), ("left", 0.5, 0.1)):
        down = (time / STRIDE + lag) % 1.0 < 0.6
        data[f"{side}_foot.force_z_N"] = np.where(down, 1.1 * WEIGHT, 0.0)
        data[f"{side}_foot.cop_x_m"] = data[f"{side}_sole.x_m"] = 1.4 * time
        data[f"{side}_foot.cop_y_m"] = data[f"{side}_sole.y_m"] = np.full_like(time, y)
        data[f"{side}_sole.z_m"] = np.where(down, 0.0, 0.12)
    return pa.table({TIME: time, **data})


@pytest.fixture
def make_run(tmp_path: Path, columns: tuple[str, ...]) -> Callable[..., Any]:
    """Writes the run of made-up signals, by its duration [s], whether it is supported, and a change of its signals."""

    def make(
        duration: float = 6.0,
        supported: bool = True,
        change: Callable[..., Any] = lambda signals: signals,
        scenario: Scenario | None = None,
    ) -> Run:
        overrides = {
            "controller.thesis.balance.support.enabled": str(supported).lower(),
            "recording.signal_period": str(PERIOD),
        }
        signals = change(made_up_signals(columns, duration))
        if not supported:
            signals = signals.drop_columns([name for name in signals.column_names if name.startswith("support.")])
        outcome = Outcome(scenario or load_scenario("thesis", overrides), signals, "completed", wall_time=1.0)
        folder = tmp_path / f"run_{duration}_{supported}"
        folder.mkdir()
        return outcome.write(folder, "made up")

    return make


def title(figure: Any) -> str:
    return figure.get_suptitle()


@pytest.mark.parametrize("name", sorted(THESIS_NAMES))
def test_only_the_thesis_walk_has_numbers_and_levels_of_the_thesis(make_run: Callable[..., Any], name: str) -> None:
    assert "Figure 5." in title(PLOTS[name](make_run()))
    balanced = PLOTS[name](
        make_run(supported=False, scenario=load_scenario("walk", {"recording.signal_period": str(PERIOD)}))
    )
    texts = [title(balanced), *(line.get_label() for axes in balanced.axes for line in axes.get_lines())]
    assert [text for text in texts if "Figure" in text or "thesis" in text] == []  # type: ignore[operator]


def line(figure: Any, text: str) -> Line2D:
    (found,) = (line for axes in figure.axes for line in axes.get_lines() if line.get_label() == text)
    return found


def test_every_plot_of_a_walk_is_written_under_its_name(make_run: Callable[..., Any]) -> None:
    run = make_run()
    written = write_plots(run)
    assert [path.name for path in written] == [f"{name}.png" for name in PLOTS]
    assert sorted(run.plots.iterdir()) == sorted(written)
    assert all(path.read_bytes().startswith(b"\x89PNG") for path in written)


def test_a_plot_that_cannot_be_written_is_refused_before_the_first_is_drawn(make_run: Callable[..., Any]) -> None:
    run = make_run()
    last = run.plots / f"{list(PLOTS)[-1]}.png"
    last.mkdir(parents=True)
    with pytest.raises(ParameterError, match=rf"^{last}: a folder or device; allowed: a file; move it away"):
        write_plots(run)
    assert list(run.plots.iterdir()) == [last]


def test_all_of_figures_5_8_to_5_21_exist() -> None:
    numbers = [int(name.split("_")[2]) for name in PLOTS if name.startswith("figure_5_")]
    assert numbers == list(range(8, 22))


@pytest.mark.parametrize("name", PLOTS)
def test_a_plot_has_a_title_and_units(make_run: Callable[..., Any], name: str) -> None:
    figure = PLOTS[name](make_run())
    title = figure.get_suptitle()
    if name.startswith("figure_"):
        _, chapter, number, *_ = name.split("_")
        assert title.startswith(f"Figure {chapter}.{int(number)} ")
    xlabels = [axes.get_xlabel() for axes in figure.axes if axes.get_xlabel()]
    ylabels = [axes.get_ylabel() for axes in figure.axes if axes.get_ylabel()]
    assert xlabels
    assert ylabels or name == "tracking_error"
    assert all(any(unit in text for unit in UNITS) for text in xlabels + ylabels)


@pytest.mark.parametrize(
    ("name", "column", "scale"),
    [
        ("figure_5_18_right_knee_angle_whole_run", "RightLegTibiaMotion.angle_rad", 180 / np.pi),
        ("figure_5_19_right_knee_torque_whole_run", "RightLegTibiaMotion.torque_N_m", 1.0),
        ("figure_5_20_right_ankle_angle_whole_run", "RightLegAnkleMotion.angle_rad", 180 / np.pi),
        ("figure_5_21_right_ankle_torque_whole_run", "RightLegAnkleMotion.torque_N_m", 1.0),
        ("figure_5_12_right_foot_x", "right_sole.x_m", 100.0),
        ("figure_5_13_right_foot_z", "right_sole.z_m", 100.0),
        ("figure_5_14_right_foot_y", "right_sole.y_m", 100.0),
        ("figure_5_15_left_foot_x", "left_sole.x_m", 100.0),
        ("figure_5_16_left_foot_z", "left_sole.z_m", 100.0),
        ("figure_5_17_left_foot_y", "left_sole.y_m", 100.0),
    ],
)
def test_the_whole_run_is_shown_in_the_units_of_the_thesis(
    make_run: Callable[..., Any], name: str, column: Any, scale: Any
) -> None:
    run = make_run()
    quantity = column.split(".")[1].split("_")[0]
    shown = line(PLOTS[name](run), quantity if quantity in ("angle", "torque") else "sole")
    np.testing.assert_array_equal(shown.get_xdata(), run.signals[TIME].to_numpy())
    np.testing.assert_allclose(shown.get_ydata(), scale * run.signals[column].to_numpy())  # type: ignore[arg-type]
    assert shown.get_color() == SIDE["Left" if column.startswith("left") else "Right"]


@pytest.mark.parametrize(
    ("name", "column"),
    [
        ("figure_5_08_right_knee_angle", "RightLegTibiaMotion.desired_angle_rad"),
        ("figure_5_10_right_ankle_angle", "RightLegAnkleMotion.desired_angle_rad"),
    ],
)
def test_the_first_four_seconds_show_the_desired_angle_too(
    make_run: Callable[..., Any], name: str, column: Any
) -> None:
    run = make_run()
    first = run.signals[TIME].to_numpy() <= 4.0
    shown = line(PLOTS[name](run), "desired")
    np.testing.assert_array_equal(shown.get_xdata(), run.signals[TIME].to_numpy()[first])
    np.testing.assert_allclose(shown.get_ydata(), np.degrees(run.signals[column].to_numpy()[first]))  # type: ignore[arg-type]


def test_the_lateral_threshold_lies_half_a_centimeter_to_both_sides_of_the_initial_position(
    make_run: Callable[..., Any],
) -> None:
    run = make_run()
    (axes,) = PLOTS["figure_5_17_left_foot_y"](run).axes
    levels = sorted(line.get_ydata()[0] for line in axes.get_lines() if line.get_linestyle() == "--")  # type: ignore[index, type-var]
    assert levels == pytest.approx([9.5, 10.5])


def test_the_support_is_called_external_and_its_rms_is_that_of_the_summary(make_run: Callable[..., Any]) -> None:
    run = make_run()
    for name, key, unit in (
        ("support_force", "support_force_rms_N", "N"),
        ("support_torque", "support_torque_rms_N_m", "N m"),
    ):
        title = PLOTS[name](run).get_suptitle()
        assert title.startswith("External support")
        assert f"rms {run.summary[key]:.0f} {unit} " in title


def test_the_ground_reaction_covers_the_last_two_seconds_and_marks_the_weight(make_run: Callable[..., Any]) -> None:
    figure = PLOTS["ground_reaction"](make_run())
    vertical, fore_aft = figure.axes
    for axes in (vertical, fore_aft):
        right, left = axes.get_lines()[:2]
        assert (right.get_color(), left.get_color()) == (SIDE["Right"], SIDE["Left"])
        assert np.ptp(right.get_xdata()) == pytest.approx(2.0, abs=2 * PERIOD)  # type: ignore[arg-type]
    (weight,) = (line for line in vertical.get_lines() if line.get_label().startswith("body weight"))
    assert weight.get_ydata()[0] == pytest.approx(WEIGHT, rel=1e-3)  # type: ignore[index]


def test_the_center_of_pressure_is_drawn_only_while_the_foot_is_loaded(make_run: Callable[..., Any]) -> None:
    run = make_run()
    (axes,) = PLOTS["center_of_pressure"](run).axes
    dots = line(axes.figure, "center of pressure, right")
    drawn = np.isin(run.signals["right_foot.cop_x_m"].to_numpy(), dots.get_xdata())
    assert drawn.any()
    assert run.signals["right_foot.force_z_N"].to_numpy()[drawn].min() > 0.0


def test_the_view_from_above_shows_the_faces_in_view_behind_everything() -> None:
    """A view 0.4 m wide from the level ground before over the first of two treads, and the strip's edge."""
    course = Course((Stairs(tread=0.3, number=2),), width=2.0)
    figure = new_figure("", height=2.0)
    (axes,) = figure.axes
    axes.set(xlim=(0.8, 1.2), ylim=(0.5, 1.5))
    draw_faces(axes, course.faces)
    corners = [patch.get_extents().transformed(axes.transData.inverted()).extents for patch in axes.patches]
    np.testing.assert_allclose(corners, [(0.8, 0.5, 1.0, 1.0), (1.0, 0.5, 1.2, 1.0)])
    assert [patch.get_zorder() for patch in axes.patches] == [0, 0]
    assert (axes.get_xlim(), axes.get_ylim()) == ((0.8, 1.2), (0.5, 1.5))
    level, tread = (patch.get_facecolor()[:3] for patch in axes.patches)
    assert level != tread


def test_leg_torques_run_from_one_touchdown_to_the_next(make_run: Callable[..., Any]) -> None:
    for axes in PLOTS["joint_torques"](make_run()).axes:
        for side in ("right", "left"):
            (torque,) = (line for line in axes.get_lines() if line.get_label() == side)
            assert (torque.get_xdata().min(), torque.get_xdata().max()) == pytest.approx((0.0, 100.0))


def test_the_tracking_error_has_a_bar_for_every_joint(make_run: Callable[..., Any]) -> None:
    run = make_run()
    figure = PLOTS["tracking_error"](run)
    widths = [bar.get_width() for axes in figure.axes for bar in axes.patches]
    assert sorted(widths) == pytest.approx(sorted(np.degrees(list(run.summary["tracking_error_rad"].values()))))


def test_a_run_without_support_has_no_plot_of_it(make_run: Callable[..., Any]) -> None:
    run = make_run(supported=False)
    assert {name for name, plot in PLOTS.items() if plot(run) is not None} == set(PLOTS) - NEED_SUPPORT
    assert write_plots(run, ["support"]) == []


def test_a_run_that_ended_before_the_first_step_has_no_plots_of_strides(make_run: Callable[..., Any]) -> None:
    names = {path.stem for path in write_plots(make_run(duration=0.05))}
    assert names == set(PLOTS) - NEED_STRIDES - NEED_STEADY_WALK


def test_one_sample_gives_no_plot(make_run: Callable[..., Any]) -> None:
    assert write_plots(make_run(duration=0.0)) == []


@pytest.mark.parametrize(
    ("only", "expected"),
    [
        (["figure_5_17_left_foot_y"], {"figure_5_17_left_foot_y"}),
        (["support", "ground"], {"support_force", "support_torque", "ground_reaction"}),
    ],
)
def test_some_plots_are_chosen_by_name_or_beginning(
    make_run: Callable[..., Any], only: list[str], expected: set[str]
) -> None:
    run = make_run()
    assert {path.stem for path in write_plots(run, only)} == expected
    assert {path.stem for path in run.plots.iterdir()} == expected


@pytest.mark.parametrize(
    ("arguments", "named"), [({"only": ["figure_9"]}, "tracking_error"), ({"format": "gif"}, "pdf")]
)
def test_an_unknown_name_or_format_is_refused_with_the_known_ones_and_nothing_written(
    make_run: Callable[..., Any], arguments: Any, named: str
) -> None:
    run = make_run()
    with pytest.raises(ParameterError, match=f"allowed: .*{named}") as error:
        write_plots(run, **arguments)
    assert "\n" not in str(error.value)
    assert not run.plots.exists()


@pytest.mark.parametrize(("format", "beginning"), [("svg", b"<?xml"), ("pdf", b"%PDF"), ("png", b"\x89PNG")])
def test_a_plot_is_the_same_bytes_every_time_in_every_format(
    make_run: Callable[..., Any], format: str, beginning: bytes
) -> None:
    run = make_run()

    def digest() -> str:
        (path,) = write_plots(run, ["support_force"], format)
        content = path.read_bytes()
        assert path.suffix == f".{format}"
        assert content.startswith(beginning)
        return hashlib.sha256(content).hexdigest()

    assert digest() == digest()


def test_plots_share_no_global_figure(make_run: Callable[..., Any]) -> None:
    import matplotlib._pylab_helpers as pyplot_figures

    write_plots(make_run(), ["figure_5_08"])
    assert not pyplot_figures.Gcf.figs


def test_figures_4_2_to_4_7_are_small_enough_for_the_documentation(tmp_path: Path) -> None:
    written = write_gait_figures(tmp_path / "thesis")
    assert [int(path.stem.split("_")[2]) for path in written] == list(range(2, 8))
    assert all(path.stat().st_size < 60_000 for path in written)


@pytest.mark.parametrize(
    ("name", "start", "points"),
    [("figure_4_02_forward_path", (41.67, 0.0), 13), ("figure_4_04_backward_path", (8.33, 6.67), 12)],
)
def test_the_foot_path_of_a_cycle_is_closed_and_passes_through_its_control_points(
    name: str, start: Any, points: Any
) -> None:
    figure = GAIT_FIGURES[name]()
    path = line(figure, "Hermite spline").get_xydata()
    control = line(figure, "control points, in their order").get_xydata()
    assert len(control) == points  # type: ignore[arg-type]
    np.testing.assert_allclose(control[0], start, atol=0.01)  # type: ignore[arg-type, index]
    np.testing.assert_allclose(path[0], path[-1], atol=1e-12)  # type: ignore[arg-type, index]
    assert all(np.abs(path - point).max(axis=1).min() < 1e-9 for point in control)  # type: ignore[operator]


@pytest.mark.parametrize("name", ["figure_4_06_forward_plot", "figure_4_07_backward_plot"])
def test_the_points_of_a_path_begin_at_the_standing_foot(name: str) -> None:
    (axes,) = GAIT_FIGURES[name]().axes
    points = next(line for line in axes.get_lines() if "points" in line.get_label()).get_xydata()  # type: ignore[operator]
    np.testing.assert_allclose(points[0], (25.0, -5.0))  # type: ignore[arg-type, index]
    assert np.linalg.norm(np.diff(points, axis=0), axis=1).max() <= 1.4 + 1e-9


def test_the_gait_cycle_shows_the_mean_of_the_steady_strides_over_the_band_of_human_gait(
    make_run: Callable[..., Any],
) -> None:
    run = make_run()
    figure = PLOTS["gait_cycle_angles"](run)
    for axes, name in zip(figure.axes, ("hip", "knee", "ankle"), strict=True):
        (shown,) = (line for line in axes.get_lines() if line.get_label().startswith("right"))
        angle = ANGLES[name].of(run.signals, "Right", run.scenario.subject.mass, 1.0)
        # Every stride of the made-up walk is the same sine.
        assert np.ptp(shown.get_ydata()) == pytest.approx(np.ptp(angle), rel=0.02)
        np.testing.assert_allclose(shown.get_xdata(), CYCLE)
        assert shown.get_ydata()[0] == pytest.approx(shown.get_ydata()[-1], abs=0.05 * np.ptp(angle))
        people = ANGLES[name].people(Walk.of(run.signals, run.scenario).pace.group)
        band = axes.collections[0].get_paths()[0].vertices
        assert band[:, 1].max() == pytest.approx((people.mean + people.sd).max())
        assert band[:, 1].min() == pytest.approx((people.mean - people.sd).min())


def test_power_is_torque_times_rate_per_mass(make_run: Callable[..., Any]) -> None:
    def steady_power(signals: pa.Table) -> pa.Table:
        columns = {name: signals[name].to_numpy() for name in signals.column_names}
        columns["RightLegTibiaMotion.torque_N_m"] = np.full(len(signals), 35.0)
        columns["RightLegTibiaMotion.velocity_rad_s"] = np.full(len(signals), -2.0)
        return pa.table(columns)

    knee = PLOTS["gait_cycle_powers"](make_run(change=steady_power)).axes[1]
    (shown,) = (line for line in knee.get_lines() if line.get_label().startswith("right"))
    np.testing.assert_allclose(shown.get_ydata(), -1.0)  # type: ignore[arg-type]


BASELINES = Path(__file__).parent.parent / "data" / "plots"
"""Reviewed pictures of the plots; WRITE_BASELINES=1 pytest tests/view/test_plots.py draws them again."""

IMAGE_DPI = 72
IMAGE_TOLERANCE = 4.0
"""Greatest rms difference of a plot from its picture, of 255, both blurred: fonts and edges may move by a pixel."""

REVIEWED = (
    "figure_4_02_forward_path",
    "figure_5_08_right_knee_angle",
    "figure_5_17_left_foot_y",
    "gait_cycle_angles",
    "gait_cycle_moments",
    "gait_cycle_powers",
    "ground_reaction",
    "center_of_pressure",
    "cop_under_soles",
    "support_force",
    "joint_torques",
    "tracking_error",
)


def drawn(figure: Any) -> Image.Image:
    file = io.BytesIO()
    figure.savefig(file, format="png", dpi=IMAGE_DPI)
    return Image.open(file).convert("RGB")


def rms_difference(one: Image.Image, other: Image.Image) -> float:
    if one.size != other.size:
        return 255.0
    blurred = (np.asarray(image.filter(ImageFilter.GaussianBlur(2.0)), dtype=float) for image in (one, other))
    first, second = blurred
    return float(np.sqrt(((first - second) ** 2).mean()))


@pytest.mark.parametrize("name", REVIEWED)
def test_a_plot_matches_its_reviewed_picture(make_run: Callable[..., Any], name: str) -> None:
    picture = drawn(GAIT_FIGURES[name]() if name in GAIT_FIGURES else PLOTS[name](make_run()))
    baseline = BASELINES / f"{name}.png"
    if os.environ.get("WRITE_BASELINES"):
        baseline.parent.mkdir(parents=True, exist_ok=True)
        picture.quantize(64).save(baseline, optimize=True)
    with Image.open(baseline) as known:
        assert rms_difference(picture, known.convert("RGB")) < IMAGE_TOLERANCE


def test_another_curve_does_not_match_the_picture(make_run: Callable[..., Any]) -> None:
    def late(signals: pa.Table) -> pa.Table:
        columns = {name: signals[name].to_numpy() for name in signals.column_names}
        columns["RightLegTibiaMotion.angle_rad"] = np.roll(columns["RightLegTibiaMotion.angle_rad"], 10)
        return pa.table(columns)

    with Image.open(BASELINES / "figure_5_08_right_knee_angle.png") as known:
        assert (
            rms_difference(drawn(PLOTS["figure_5_08_right_knee_angle"](make_run(change=late))), known.convert("RGB"))
            > 2.0 * IMAGE_TOLERANCE
        )
