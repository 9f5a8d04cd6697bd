"""Styles of the balanced walk: by tag, with the subject's own speeds, and refused without a recording."""

from pathlib import Path

import pytest
from pydrake.multibody.plant import MultibodyPlant

from humanwalk.body.joint_map import JointMap
from humanwalk.body.subject import Subject
from humanwalk.choices.style import STYLES, NormativeStyle, NoStyle, RecordedStyle
from humanwalk.quantity import ParameterError
from humanwalk.scenario import load_scenario


def test_a_walk_has_no_style_unless_it_names_one(plant: MultibodyPlant) -> None:
    assert load_scenario("walk").controller.followed_style == "none"
    assert load_scenario("normative").controller.followed_style == "normative"
    assert load_scenario("thesis").controller.followed_style is None
    assert NoStyle().task(Subject(), JointMap.of(plant)) is None
    assert NormativeStyle().task(Subject(), JointMap.of(plant)) is not None


def test_every_style_has_a_tag() -> None:
    assert set(STYLES) == {"none", "normative", "recorded"}


def test_a_recorded_style_needs_a_recording() -> None:
    with pytest.raises(ParameterError, match="no recording"):
        RecordedStyle()


def test_a_recording_that_is_not_there_is_reported(tmp_path: Path, plant: MultibodyPlant) -> None:
    with pytest.raises(ParameterError, match=r"nothing\.mot"):
        RecordedStyle(str(tmp_path / "nothing.mot")).task(Subject(), JointMap.of(plant))
