"""Gait measures of constructed walks whose step, stride and work are known."""

import json
from typing import Any

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given
from hypothesis import strategies as st

from humanwalk.measures.events import events_of
from humanwalk.measures.gait_measures import gait_measures, stance_shares
from humanwalk.measures.signals import TIME

PERIOD = 0.002
WEIGHT = 700.0


def walk(
    stride: float = 1.0,
    duty: float = 0.6,
    length: float = 1.2,
    width: float = 0.2,
    lag: float = 0.5,
    duration: float = 6.0,
    **more: Any,
) -> pa.Table:
    """Feet that stand still in stance and glide to the next place in swing; the left one `lag` of a stride later.

    The right foot lands at stride, 2 stride, ...; at its landing the left one stands where it landed before.
    """
    time = PERIOD * np.arange(round(duration / PERIOD) + 1)
    data = {TIME: time}
    for side, late, y in (("right", 0.0, -width / 2), ("left", lag, width / 2)):
        cycle = time / stride - late
        phase = cycle % 1.0
        down = phase < duty - 1e-9
        swing = np.clip((phase - duty) / (1 - duty), 0.0, 1.0)
        data[f"{side}_sole.x_m"] = length * (np.floor(cycle) + swing + late)
        data[f"{side}_sole.y_m"] = np.full_like(time, y)
        data[f"{side}_foot.force_z_N"] = np.where(down, WEIGHT, 0.0)
        data[f"{side}_foot.loaded"] = down.astype(float)
        data[f"{side}_foot.cop_x_m"] = np.where(down, data[f"{side}_sole.x_m"] + 0.25 * phase / duty, 0.0)
        data[f"{side}_foot.cop_y_m"] = np.where(down, y, 0.0)
    data["knee.torque_N_m"] = 20.0 * np.sin(2 * np.pi * time / stride)
    data["knee.velocity_rad_s"] = np.full_like(time, 2.0)
    return pa.table(data | more)


def measured(signals: pa.Table, begin: float) -> Any:
    """The measures of a walk along x."""
    return gait_measures(signals, signals[TIME].to_numpy() >= begin, np.ones(signals.num_rows, dtype=complex))


def both(value: float) -> dict[str, Any]:
    return {"right": pytest.approx(value, rel=0.02), "left": pytest.approx(value, rel=0.02)}


walks = st.fixed_dictionaries(
    {
        "stride": st.floats(0.8, 1.4),
        "duty": st.floats(0.52, 0.75),
        "length": st.floats(0.4, 1.6),
        "width": st.floats(0.05, 0.3),
    }
)


@given(st.floats(-np.pi, np.pi))
def test_measures_do_not_depend_on_where_the_walk_leads(heading: float) -> None:
    signals, direction = walk(), np.exp(1j * heading)
    turned = {name: signals[name] for name in signals.column_names}
    for point in (f"{side}_{part}" for side in ("right", "left") for part in ("sole.", "foot.cop_")):
        place = direction * (signals[f"{point}x_m"].to_numpy() + 1j * signals[f"{point}y_m"].to_numpy())
        turned |= {f"{point}x_m": place.real, f"{point}y_m": place.imag}
    facing = np.full(signals.num_rows, direction)
    found, expected = gait_measures(pa.table(turned), np.ones(facing.size, dtype=bool), facing), measured(signals, 0.0)
    for name in ("stride_length_m", "step_length_m", "step_width_m"):
        assert found[name] == pytest.approx(expected[name]), name
    assert found["stride_speed_m_s"] == pytest.approx(expected["stride_speed_m_s"])
    for axis in ("x", "y"):
        assert found["cop_excursion_m"][axis] == pytest.approx(expected["cop_excursion_m"][axis], abs=1e-9)


@given(walks)
def test_measures_of_a_symmetric_walk_are_those_of_its_construction(made: dict[str, float]) -> None:
    measures = measured(walk(**made), 0.0)
    assert measures["stride_time_s"] == both(made["stride"])
    assert measures["stride_length_m"] == both(made["length"])
    assert measures["step_time_s"] == both(made["stride"] / 2)
    assert measures["step_length_m"] == both(made["length"] / 2)
    assert measures["step_width_m"] == both(made["width"])
    assert measures["stance_share"] == both(made["duty"])
    shares = measures["double_support_share"].values()
    assert all(share == pytest.approx(2 * made["duty"] - 1, abs=0.01) for share in shares)
    assert measures["cadence_1_min"] == pytest.approx(120 / made["stride"], rel=0.02)
    assert measures["stride_speed_m_s"] == pytest.approx(made["length"] / made["stride"], rel=0.02)


def test_steps_of_a_limp_differ_and_strides_do_not() -> None:
    measures = measured(walk(lag=0.4), 0.0)
    assert measures["stride_time_s"] == both(1.0)
    # The left foot lands 0.4 of a stride after the right one, and 0.4 of a stride length in front of it.
    assert measures["step_time_s"]["left"] == pytest.approx(0.4, rel=0.02)
    assert measures["step_time_s"]["right"] == pytest.approx(0.6, rel=0.02)
    assert measures["step_length_m"]["left"] == pytest.approx(0.48, rel=0.02)
    assert measures["step_length_m"]["right"] == pytest.approx(0.72, rel=0.02)


def test_crossed_feet_have_a_negative_width() -> None:
    assert measured(walk(width=-0.05), 0.0)["step_width_m"] == both(-0.05)


def test_running_has_no_double_support() -> None:
    measures = measured(walk(duty=0.4), 0.0)
    assert set(measures["double_support_share"].values()) == {0.0}
    assert measures["stance_share"] == both(0.4)


def test_stride_without_toe_off_has_no_stance_share() -> None:
    signals = walk(duration=1.3)
    assert stance_shares(events_of(signals, "Right")).size == 0


def test_excursion_of_the_center_of_pressure_is_per_stance() -> None:
    measures = measured(walk(), 0.0)
    assert measures["cop_excursion_m"]["x"] == both(0.25)
    assert measures["cop_excursion_m"]["y"] == {"right": 0.0, "left": 0.0}


def test_joint_work_is_per_stride_and_split_by_sign() -> None:
    """Power 40 sin: half a wave of it is 40 / pi over a stride of one second."""
    work = measured(walk(), 0.0)["joint_work_J"]
    assert work == {
        "knee": {"positive": pytest.approx(40 / np.pi, rel=1e-3), "negative": pytest.approx(-40 / np.pi, rel=1e-3)}
    }


def test_joint_work_sums_to_the_change_of_energy() -> None:
    signals = walk()
    work = measured(signals, 0.0)["joint_work_J"]["knee"]
    assert work["positive"] + work["negative"] == pytest.approx(0.0, abs=1e-3)


def test_strides_count_from_a_time_on() -> None:
    assert measured(walk(), 2.6)["strides"] == {"right": 3, "left": 2}


@pytest.mark.parametrize("duration", [0.0, 0.3, 1.2])
def test_walk_without_a_stride_has_null(duration: float) -> None:
    measures = measured(walk(duration=duration), 0.0)
    assert measures["strides"] == {"right": 0, "left": 0}
    assert measures["stride_time_s"] == {"right": None, "left": None}
    assert measures["stride_speed_m_s"] is None
    assert measures["joint_work_J"] is None
    json.dumps(measures, allow_nan=False)
