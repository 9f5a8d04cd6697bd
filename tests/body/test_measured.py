"""Measured segments out of a file: what is kept, what is scaled, what is refused."""

import math
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from humanwalk.body.measured import Measurement, completed, read_measurements
from humanwalk.body.regions import region_names, regions
from humanwalk.body.segment_table import regions_of
from humanwalk.body.subject import Subject
from humanwalk.quantity import ParameterError

USUAL = regions("male", 30.0, 75.0, 1.80)

YAML = """
segments:
  thigh: {length: 0.42, width: 0.15}
  right_shank: {length: 0.43, mass: 3.0}
  left_shank: {length: 0.41, mass: 2.8}
  head: {mass: 5.5}
"""
CSV = """segment,length_m,width_m,mass_kg
thigh,0.42,0.15,
right_shank,0.43,,3.0
left_shank, 0.41, , 2.8

head,,,5.5
"""


def subject(path: Path) -> Subject:
    return Subject(75.0, 1.80, "male", measured=str(path))


def write(folder: Path, text: str, name: str = "segments.csv") -> Path:
    path = folder / name
    path.write_text(text)
    return path


def test_yaml_and_csv_are_one(tmp_path: Path) -> None:
    read = [read_measurements(write(tmp_path, text, name)) for text, name in ((YAML, "a.yaml"), (CSV, "a.csv"))]
    assert read[0] == read[1]
    assert read[0]["left_thigh"] == read[0]["right_thigh"] == Measurement(length=0.42, width=0.15)
    assert read[0]["left_shank"] == Measurement(length=0.41, mass=2.8)
    assert "right_foot" not in read[0]


def test_a_side_that_was_not_measured_mirrors_the_other(tmp_path: Path) -> None:
    read = read_measurements(write(tmp_path, "segment,mass_kg\nleft_foot,1.1\nright_hand,0.5\nhand,0.4\n"))
    assert {name: found.mass for name, found in read.items()} == {
        "right_foot": 1.1,
        "left_foot": 1.1,
        "right_hand": 0.5,
        "left_hand": 0.4,
    }


def test_the_body_has_what_was_measured_and_the_rest_fits(tmp_path: Path) -> None:
    body = subject(write(tmp_path, CSV)).body
    found = regions_of(body, USUAL)
    assert body.total_mass == pytest.approx(75.0, rel=1e-9)
    assert body.stature == pytest.approx(1.80, rel=1e-9)
    for name, length in (("right_thigh", 0.42), ("left_thigh", 0.42), ("right_shank", 0.43), ("left_shank", 0.41)):
        assert found[name].length == pytest.approx(length, rel=1e-9), name
    for name, mass in (("right_shank", 3.0), ("left_shank", 2.8), ("head", 5.5)):
        assert found[name].mass == pytest.approx(mass, rel=1e-9), name
    np.testing.assert_allclose(body.raised, (0.0, 0.02), atol=1e-9)
    # Legs are short by 5.2 cm: the trunk is longer than usual by as much, with the head.
    longer = sum(
        found[name].length - USUAL[name].length for name in ("head", "upper_trunk", "middle_trunk", "lower_trunk")
    )
    short = sum(USUAL[name].length - found[name].length for name in ("right_thigh", "right_shank"))
    assert longer == pytest.approx(short, rel=1e-6)
    # A thigh that is thinner than usual is lighter than usual, and turns easily about its long axis.
    assert found["right_thigh"].mass < USUAL["right_thigh"].mass
    assert found["right_thigh"].gyration[2] / USUAL["right_thigh"].gyration[2] == pytest.approx(
        0.15 / USUAL["right_thigh"].width, rel=1e-9
    )


FACTOR = st.one_of(st.just(0.0), st.floats(0.85, 1.15))


@settings(deadline=None, max_examples=40)
@given(
    st.dictionaries(
        st.sampled_from([name for name, _ in region_names()]), st.tuples(FACTOR, FACTOR, FACTOR), min_size=1, max_size=8
    )
)
def test_any_measured_segments_keep_stature_and_mass(factors: dict[str, tuple[float, float, float]]) -> None:
    measured = {
        name: Measurement(
            # The length of the head is always left to be scaled.
            length=0.0 if name == "head" else longer * USUAL[name].length,
            width=wider * USUAL[name].width,
            mass=heavier * USUAL[name].mass,
        )
        for name, (longer, wider, heavier) in factors.items()
    }
    found = completed(USUAL, measured)
    assert math.fsum(region.mass for region in found.values()) == pytest.approx(75.0, rel=1e-9)
    chains = [
        ("head", "upper_trunk", "middle_trunk", "lower_trunk", f"{s}_thigh", f"{s}_shank") for s in ("right", "left")
    ]
    heights = [math.fsum(found[name].length for name in chain) for chain in chains]
    assert max(heights) == pytest.approx(math.fsum(USUAL[name].length for name in chains[0]), rel=1e-9)
    for name, measurement in measured.items():
        assert measurement.width in (0.0, found[name].width)
        assert not measurement.mass or found[name].mass == pytest.approx(measurement.mass, rel=1e-9)
        assert min(found[name].gyration) > 0.0


def test_the_distance_of_the_shoulders_moves_the_arms_and_no_mass(tmp_path: Path) -> None:
    body = subject(write(tmp_path, "segment,width_m\nupper_trunk,0.40\n")).body
    assert body.origins["LeftArm_Humor_Upper_Arm"][1] == pytest.approx(0.20, abs=1e-9)
    assert regions_of(body, USUAL)["upper_trunk"].mass == pytest.approx(USUAL["upper_trunk"].mass, rel=1e-9)


def test_nothing_measured_changes_nothing() -> None:
    for name, found in completed(USUAL, {}).items():
        np.testing.assert_allclose(
            (found.length, found.width, found.mass, found.com, *found.gyration),
            (USUAL[name].length, USUAL[name].width, USUAL[name].mass, USUAL[name].com, *USUAL[name].gyration),
            rtol=1e-9,
        )


def test_all_measured_may_miss_stature_and_mass_by_two_percent() -> None:
    every = {name: Measurement(length=1.015 * r.length, mass=0.985 * r.mass) for name, r in USUAL.items()}
    found = completed(USUAL, every)
    for name, region in USUAL.items():
        assert found[name].mass == pytest.approx(region.mass, rel=1e-9)
    assert found["head"].length == pytest.approx(USUAL["head"].length, rel=1e-9)
    with pytest.raises(ParameterError, match=r"lengths of trunk, head and leg make a stature of 1\.89 m; allowed"):
        completed(USUAL, {name: Measurement(length=1.05 * r.length) for name, r in USUAL.items()})
    with pytest.raises(ParameterError, match=r"masses add up to 67\.5 kg; allowed: within 2 % of the subject's, 75 kg"):
        completed(USUAL, {name: Measurement(mass=0.9 * r.mass) for name, r in USUAL.items()})


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("segment,length\nthigh,0.4\n", "columns segment, length; allowed: segment, length_m, width_m, mass_kg"),
        ("", "columns ; allowed"),
        ("segment,mass_kg\n", "no segment; allowed: one or more of head"),
        ("segment,mass_kg\nthigh,1_0\n", "row 2: mass_kg: 1_0 is not a number"),
        ("segment,mass_kg\nthigh,heavy\n", "row 2: mass_kg: heavy is not a number"),
        ("segment,mass_kg\nthigh,nan\n", "segments.thigh.mass: nan is out of range"),
        ("segment,mass_kg\nthigh,-1\n", "segments.thigh.mass: -1 is out of range; allowed: 0 to 100 kg"),
        ("segment,length_m\nthigh,42\n", "segments.thigh.length: 42 is out of range; allowed: 0 to 1 m; if it is in c"),
        ("segment,mass_kg\nthig,8\n", "thig is no segment; allowed: head"),
        ("segment,mass_kg\nthigh,8\nthigh,9\n", "row 3: thigh is there twice"),
        ("segment,mass_kg\nthigh,8,9\n", "row 2: thigh has 3 cells; allowed: 2 cells"),
        ("segment,mass_kg\nhead,60\n", "mass: the measured segments leave 21 % of the usual mass for the others"),
        ("segment,length_m\nthigh,0.9\nshank,0.7\n", "length: the measured segments leave"),
    ],
)
def test_a_file_that_cannot_be_used_is_refused(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(ParameterError) as error:
        _ = subject(write(tmp_path, text)).body
    assert str(error.value).startswith("subject.measured: ")
    assert said in str(error.value)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            "segment,width_m\nshank,0.001\n",
            r"right_shank: \S+ kg .* a length of 0\.\d+ m and a width of 0\.001 m; allowed: each",
        ),
        (
            "segment,width_m\nlower_trunk,0.9\n",
            r"lower_trunk: \S+ kg .* a length of 0\.\d+ m and a width of 0\.9 m; allowed: each",
        ),
        ("segment,mass_kg\nhead,60\n", "mass: the measured segments leave"),
    ],
)
def test_segments_that_no_person_has_are_refused_with_their_file(tmp_path: Path, text: str, said: str) -> None:
    path = write(tmp_path, text)
    with pytest.raises(ParameterError, match=f"^subject.measured: {re.escape(str(path))}: {said}"):
        _ = subject(path).body


def test_a_yaml_file_without_segments_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match=r"a\.yaml: no segment; allowed: one or more of head"):
        read_measurements(write(tmp_path, "", "a.yaml"))


def test_an_unknown_format_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match=r"segments\.xls: unknown format; allowed: \.yaml, \.yml, \.csv"):
        read_measurements(write(tmp_path, CSV, "segments.xls"))


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match=r"subject\.measured: .*none\.csv"):
        _ = subject(tmp_path / "none.csv").body
