"""Persons after de Leva and Jensen: what their segments and skeletons keep, and what they are refused for."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from humanwalk.body import Skeleton, human
from humanwalk.body.build import REGION_BODIES, mass_properties, person, standing_height
from humanwalk.body.contact import contact_spheres, sole_patches
from humanwalk.body.de_leva import DE_LEVA, Sex
from humanwalk.body.growth import ADULT_AGE, MASS_SHARE, growth
from humanwalk.body.loads import AnkleWeights, Backpack
from humanwalk.body.regions import ARM, LEG, TRUNK, Regions, region_names, regions
from humanwalk.body.segment_table import regions_of, segment_rows
from humanwalk.body.subject import BODIES, Subject
from humanwalk.quantity import ParameterError
from humanwalk.sides import SIDES

SEXES: tuple[Sex, ...] = ("female", "male")
THESIS = Subject(sex="unspecified")


@st.composite
def subjects(draw: st.DrawFn) -> Subject:
    """Any person after the tables."""
    age = draw(st.floats(6.0, 80.0))
    low, high = (float(np.interp(age, (6.0, 18.0), limits)) for limits in ((1.05, 1.35), (1.30, 2.10)))
    stature = draw(st.floats(low, high))
    mass = draw(st.floats(max(12.0, 13.0 * stature**2), min(200.0, 50.0 * stature**2)))
    return Subject(mass, stature, draw(st.sampled_from(SEXES)), age)


@pytest.mark.parametrize("sex", SEXES)
def test_the_table_is_complete_and_adds_up(sex: Sex) -> None:
    rows = DE_LEVA[sex].rows
    assert set(rows) == {row for _, row in region_names()}
    assert math.fsum(rows[row].mass for _, row in region_names()) == pytest.approx(1.0, abs=2e-4)


@pytest.mark.parametrize("sex", SEXES)
def test_every_segment_of_the_table_is_a_solid_between_its_ends(sex: Sex) -> None:
    """Limbs, moreover, are longest along their length."""
    for name, row in DE_LEVA[sex].rows.items():
        squares = np.square(row.gyration)
        # Variances of the mass along x, y, z.
        variances = 0.5 * squares.sum() - squares
        along = 0 if name == "foot" else 2
        assert (variances > 0.0).all(), name
        assert variances[along] < row.com * (1.0 - row.com), name
        assert along == variances.argmax() or name.endswith("trunk"), name


@pytest.mark.parametrize("sex", SEXES)
def test_the_mean_subject_has_the_moments_of_the_table(sex: Sex) -> None:
    """Within the rounding of the shares of mass; the length of the trunk is the only one that is fitted."""
    table = DE_LEVA[sex]
    found = regions_of(Subject(table.mass, table.stature, sex).body, regions(sex, 30.0, table.mass, table.stature))
    for name, row in region_names():
        own, wanted = found[name], table.rows[row]
        assert own.mass == pytest.approx(wanted.mass * table.mass, rel=2e-3), name
        moments = own.mass * np.square(own.gyration)
        np.testing.assert_allclose(
            moments, wanted.mass * table.mass * np.square(wanted.gyration) * wanted.length**2, rtol=2e-3, err_msg=name
        )
        assert own.com / own.length == pytest.approx(wanted.com, rel=1e-9), name
        if not name.endswith("trunk"):
            assert own.length == pytest.approx(wanted.length, rel=1e-9), name


@settings(deadline=None, max_examples=60)
@given(subjects())
def test_masses_and_lengths_add_up(subject: Subject) -> None:
    body = subject.body
    assert body.total_mass == pytest.approx(subject.mass, rel=1e-9)
    assert body.stature == pytest.approx(subject.stature, rel=1e-9)
    assert body.origins["Cervical_5_7"][2] < body.stature
    assert body.raised == (0.0, 0.0)


@settings(deadline=None, max_examples=60)
@given(subjects())
def test_every_inertia_is_that_of_a_solid(subject: Subject) -> None:
    for segment in subject.body.segments:
        a, b, c = np.sort(segment.inertia)
        assert segment.mass > 0.0, segment.name
        assert 0.0 < a <= b <= c < a + b, segment.name


@settings(deadline=None, max_examples=30)
@given(subjects())
def test_a_skeleton_has_the_segments_it_was_made_of(subject: Subject) -> None:
    assert subject.sex != "unspecified"
    wanted = regions(subject.sex, subject.age, subject.mass, subject.stature)
    for name, found in regions_of(person(subject.sex, wanted), wanted).items():
        expected = wanted[name]
        np.testing.assert_allclose(
            (found.mass, found.length, found.com, *found.gyration),
            (expected.mass, expected.length, expected.com, *expected.gyration),
            rtol=1e-9,
            err_msg=name,
        )


@settings(deadline=None, max_examples=30)
@given(subjects())
def test_left_mirrors_right(subject: Subject) -> None:
    body = subject.body
    for right in (segment for segment in body.segments if segment.name.startswith("Right")):
        left = body.segment(right.name.replace("Right", "Left"))
        assert (left.mass, left.shape, left.proportions) == (right.mass, right.shape, right.proportions)
        np.testing.assert_allclose(left.com, np.multiply(right.com, (1, -1, 1)), atol=1e-15)
        np.testing.assert_allclose(body.origins[left.name], body.origins[right.name] * (1, -1, 1), atol=1e-15)


@settings(deadline=None, max_examples=30)
@given(subjects())
def test_soles_stand_on_the_ground(subject: Subject) -> None:
    body = subject.body
    for sphere in contact_spheres(body):
        assert body.origins[sphere.body][2] + sphere.center[2] - sphere.radius == pytest.approx(0.0, abs=1e-9)
    for patch in (patch for side in SIDES for patch in sole_patches(body, side)):
        np.testing.assert_allclose(body.origins[patch.body][2] + patch.p_BoQ_B[:, 2], 0.0, atol=1e-9)


@given(st.sampled_from(SEXES), st.floats(0.5, 2.0), st.floats(0.7, 1.2))
def test_adults_of_one_sex_are_similar(sex: Sex, heavier: float, taller: float) -> None:
    """Masses are proportional to body mass, lengths to stature, moments of inertia to m L2."""
    one, other = regions(sex, 30.0, 70.0, 1.7), regions(sex, 30.0, 70.0 * heavier, 1.7 * taller)
    for name, region in one.items():
        assert other[name].mass == pytest.approx(region.mass * heavier, rel=1e-9)
        np.testing.assert_allclose(
            (other[name].length, other[name].com, *other[name].gyration),
            np.multiply(taller, (region.length, region.com, *region.gyration)),
            rtol=1e-9,
        )


def test_torque_limits_and_rotors_scale_as_those_of_the_thesis_body() -> None:
    body, thesis = Subject(55.0, 1.6, "female").body, human().scaled(55.0, 1.6)
    for joint, wanted in zip(body.joints, thesis.joints, strict=True):
        assert joint.range_rad == wanted.range_rad
        for field in ("effort_limit_N_m", "rotor_inertia", "damping"):
            assert getattr(joint, field) == pytest.approx(getattr(wanted, field), rel=1e-9)


def test_all_bodies_have_one_topology() -> None:
    bodies = [BODIES[sex](Subject(20.0, 1.15, "male", 6.0) if sex != "unspecified" else THESIS) for sex in BODIES]
    for body in bodies:
        assert [s.name for s in body.segments] == [s.name for s in human().segments]
        assert [(j.name, j.parent, j.child, j.axis) for j in body.joints] == [
            (j.name, j.parent, j.child, j.axis) for j in human().joints
        ]
    assert {body for region in REGION_BODIES.values() for body in region} == {s.name for s in human().segments}
    assert sum(map(len, REGION_BODIES.values())) == len(human().segments)
    for shares in REGION_BODIES.values():
        assert math.fsum(share.mass for share in shares.values()) == pytest.approx(1.0, abs=1e-12)


def test_the_unspecified_sex_is_the_thesis_body() -> None:
    assert THESIS.body == THESIS.skeleton == THESIS.known_skeleton == human()
    assert Subject(55.0, 1.6, "unspecified").body == human().scaled(55.0, 1.6)


def test_the_default_is_a_man_of_the_thesis_mass_and_stature() -> None:
    assert Subject() == Subject(70.0, 1.75, "male", 30.0)


def test_a_subject_is_described_in_a_line() -> None:
    assert str(THESIS) == "70 kg, 1.75 m"
    assert str(Subject()) == "70 kg, 1.75 m, male"
    girl = Subject(26.0, 1.28, "female", 8.0, loads=(Backpack(3.0), AnkleWeights(0.5)))
    assert str(girl) == "26 kg, 1.28 m, female, 8 years, backpack 3 kg, ankle_weights 1 kg"


# Growth.


def test_children_reach_the_proportions_of_adults_without_a_step() -> None:
    for age in (ADULT_AGE, 30.0, 100.0):
        grown = growth(age)
        assert set(grown.mass.values()) == {1.0}
        assert (grown.limbs, grown.head) == (1.0, 1.0)
    before = growth(ADULT_AGE - 1e-6)
    assert max(abs(share - 1.0) for share in before.mass.values()) < 1e-5


@pytest.mark.parametrize("sex", SEXES)
def test_young_children_have_large_heads_and_short_legs(sex: Sex) -> None:
    previous = regions(sex, 6.0, 20.0, 1.1)
    for age in (8.0, 10.0, 12.0, 14.0):
        older = regions(sex, age, 20.0, 1.1)
        assert older["head"].mass < previous["head"].mass
        assert older["head"].length < previous["head"].length
        assert older["right_thigh"].length > previous["right_thigh"].length
        assert older["right_thigh"].mass > previous["right_thigh"].mass
        previous = older


def test_the_head_of_a_child_of_six_is_that_of_the_dummy() -> None:
    """NHTSA's Hybrid III of six years: head and neck 8.86 of 51.6 lb, sitting height 25.0 of 45.0 in."""
    child = regions("male", 6.0, 23.4, 1.143)
    share = child["head"].mass / 23.4
    assert share == pytest.approx(8.86 / 51.6, rel=0.02)
    body = person("male", child)
    adult = Subject(70.0, 1.75, "male").body
    # Hip joints are above the seat by the same share of the stature.
    seat = adult.hip_height / adult.stature - (1.0 - 0.52)
    assert 1.0 - body.hip_height / body.stature + seat == pytest.approx(25.0 / 45.0, abs=0.01)


def test_jensens_shares_of_mass_agree_with_the_dummy_of_six_years_and_with_de_levas_man() -> None:
    """With this one where both cut the body nearly alike: head, trunk, and legs."""

    def share(region: str, age: float) -> float:
        return float(np.polynomial.polynomial.polyval(age, MASS_SHARE[region]))

    assert share("head", 6.0) == pytest.approx(8.86 / 51.6, abs=1e-3)
    rows = DE_LEVA["male"].rows
    # Shank and foot have one share together.
    legs = 2.0 * (share("thigh", ADULT_AGE) + share("shank", ADULT_AGE))
    arms = 2.0 * math.fsum(share(region, ADULT_AGE) for region in ARM)
    head = share("head", ADULT_AGE)
    assert head == pytest.approx(rows["head"].mass, rel=0.02)
    assert 1.0 - head - arms - legs == pytest.approx(math.fsum(rows[region].mass for region in TRUNK), rel=0.03)
    assert legs == pytest.approx(2.0 * math.fsum(rows[region].mass for region in LEG), rel=0.11)


# Refusals.


@pytest.mark.parametrize(
    ("fields", "said"),
    [
        ({"mass": 11.0}, "mass: 11 is out of range; allowed: 12 to 200 kg"),
        ({"mass": 25.0}, "mass: 25 kg at 1.75 m is a body mass index of 8.16 kg/m2; allowed: 10 to 80"),
        ({"mass": 200.0, "stature": 1.5}, "give 22.5 to 180 kg"),
        ({"mass": 20.0, "stature": 1.1}, "stature: 1.1 m is impossible at an age of 30 years; allowed: 1.2 to 2.2 m"),
        ({"mass": 40.0, "stature": 1.5, "age": 6.0, "sex": "male"}, "allowed: 1 to 1.35 m"),
        (
            {"mass": 20.0, "stature": 1.1, "sex": "unspecified", "age": 6.0},
            "sex: unspecified is the thesis' adult body and takes no age",
        ),
        ({"sex": "unspecified", "measured": "x.csv"}, "takes no measured; allowed: female, male"),
        ({"age": 5.0}, "age: 5 is out of range; allowed: 6 to 100 years"),
        ({"mass": float("nan")}, "mass: nan is out of range"),
    ],
    ids=str,
)
def test_a_person_that_cannot_exist_is_refused(fields: dict[str, float], said: str) -> None:
    with pytest.raises(ParameterError) as error:
        Subject(**fields)  # type: ignore[arg-type]
    assert said in str(error.value)
    assert "\n" not in str(error.value)


def test_a_segment_without_room_for_its_inertia_is_refused() -> None:
    segments = dict(regions("male", 30.0, 70.0, 1.75))
    flat = replace(segments["head"], gyration=(0.02, 0.02, 0.02))
    with pytest.raises(ParameterError, match=r"head: 4\.86 kg cannot have the moments of inertia"):
        person("male", segments | {"head": flat})


# Legs of different length.


def unequal(shorter: float) -> tuple[Regions, Skeleton]:
    segments = dict(regions("female", 30.0, 60.0, 1.65))
    shank = segments["left_shank"]
    segments["left_shank"] = replace(shank, length=shank.length - shorter)
    return segments, person("female", segments)


def test_a_shorter_leg_ends_above_the_ground() -> None:
    segments, body = unequal(0.03)
    np.testing.assert_allclose(body.raised, (0.0, 0.03), atol=1e-12)
    assert body.stature == pytest.approx(standing_height(segments), rel=1e-12) == pytest.approx(1.65, rel=1e-9)
    assert body.ankle_height("Left") == pytest.approx(body.ankle_height("Right"), abs=1e-12)
    assert body.leg_length == pytest.approx(segments["left_thigh"].length + segments["left_shank"].length, rel=1e-9)
    for sphere in contact_spheres(body):
        above = body.origins[sphere.body][2] + sphere.center[2] - sphere.radius
        assert above == pytest.approx(body.raised[SIDES.index("Left" if "Left" in sphere.body else "Right")], abs=1e-9)


# The table of `humanwalk model`.


def test_a_person_after_the_tables_is_its_own_reference() -> None:
    rows = list(segment_rows(Subject(25.0, 1.25, "female", 8.0)))
    assert [row.name for row in rows] == [name for name, _ in region_names()]
    for row in rows:
        np.testing.assert_allclose(row.ratios, 1.0, rtol=1e-9)


def test_the_thesis_body_is_compared_with_men() -> None:
    rows = {row.name: row for row in segment_rows(THESIS)}
    body = human()
    assert math.fsum(row.own.mass for row in rows.values()) == pytest.approx(70.0, rel=1e-12)
    thigh = rows["right_thigh"].own
    assert (thigh.mass, thigh.length, thigh.com) == pytest.approx((7.84, 0.4242, 0.2121), rel=1e-9)
    # The thesis' uniform cylinder is lighter than de Leva's thigh, and thinner than its mass asks for.
    assert rows["right_thigh"].ratios[0] == pytest.approx(7.84 / (0.1416 * 70.0), rel=1e-3)
    mass, center, _ = mass_properties(body, [s.name for s in body.segments])
    assert mass == pytest.approx(70.0)
    np.testing.assert_allclose(center, body.com, atol=1e-12)
