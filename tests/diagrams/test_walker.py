"""The walker's diagram: its ports, its start, its variants, and the physics that no variant may change."""

import re
from typing import Any

import numpy as np
import pytest
from pydrake.multibody.plant import ContactResults, MultibodyPlant
from pydrake.systems.analysis import ApplySimulatorConfig, Simulator, SimulatorConfig
from pydrake.systems.framework import Context, Diagram

from humanwalk.body import SIDES, SOLE_SET
from humanwalk.body.contact import SOLE_PARTS
from humanwalk.body.joint_map import JointMap
from humanwalk.control.pd_control import PdLaw
from humanwalk.diagrams.walker import make_diagram, make_walker
from humanwalk.numerics import Array
from humanwalk.quantity import ParameterError
from humanwalk.scenario import Scenario, load_scenario

N = 42
GRAVITY = 9.81

STAND = {"controller.thesis.gait.ramp.speed": "0"}
SEMI_IMPLICIT = {"actuation.pd.law": "semi_implicit"}
IMPLICIT = {"actuation.pd.law": "implicit"}
LEVELS = {
    "controller.thesis.balance.foot_force.enabled": "true",
    "controller.thesis.balance.upper_body.enabled": "true",
}
UNSUPPORTED = {"controller.thesis.balance.support.enabled": "false"}
HYDROELASTIC = {"contact": "hydroelastic"}
ASPERITY = {"contact": "asperity", "simulation.time_step": "0.001"}
CENIC = {"simulation.integrator": "cenic", "simulation.time_step": "0"}
EXPLICIT = {
    "actuation.pd.law": "explicit",
    "controller.thesis.gains.preset": "damped",
    "controller.thesis.gains.stiffness_scale": "0.04",
    "simulation.time_step": "0.0003",
}

PORTS = {
    "state": 97,
    "net_actuation": N,
    "query_object": 0,
    "push": 3,
    "contact_results": 0,
    "torque": N,
    "saturated": N,
    "desired_state": 2 * N,
    "ik_status": 6,
    "pelvis_reference": 13,
    "phase": 2,
    "contact_schedule": 2,
    "soles": 6,
    "com": 6,
    "foot_forces": 16,
    "friction_use": 2,
    "leg_contact": 1,
}


def thesis(*changes: dict[str, str]) -> Scenario:
    return load_scenario("thesis", {key: value for change in changes for key, value in change.items()})


class Walked:
    """A walker that was simulated for some seconds."""

    def __init__(self, scenario: Scenario, duration: float) -> None:
        self.walker = make_walker(scenario)
        self.plant = self.walker.GetSubsystemByName("plant")
        assert isinstance(self.plant, MultibodyPlant)
        self.simulator = Simulator(self.walker)
        if scenario.simulation.integrator == "cenic":
            ApplySimulatorConfig(SimulatorConfig(integration_scheme="cenic", max_step_size=0.01), self.simulator)
        self.pelvis, self.torque, self.saturated = [], [], []
        self.simulator.set_monitor(self._look)
        self.simulator.AdvanceTo(duration)

    def _look(self, context: Context) -> None:
        state = self.value("state", context)
        self.pelvis.append(np.append(context.get_time(), state[4:7]))
        self.torque.append(self.value("torque", context).copy())
        self.saturated.append(self.value("saturated", context).copy())

    def value(self, port: str, context: Context | None = None) -> Array:
        return self.walker.GetOutputPort(port).Eval(context or self.simulator.get_context())


# Ports.


@pytest.mark.parametrize(
    ("changes", "more"),
    [
        ((), {"support_wrench": 6}),
        ((UNSUPPORTED,), {}),
        ((LEVELS,), {"support_wrench": 6, "foot_shift": 12, "alpha": 4}),
        ((CENIC,), {"support_wrench": 6}),
        ((EXPLICIT,), {"support_wrench": 6}),
        (({"actuation": "pid"},), {"support_wrench": 6, "integral_torque": N}),
        (({"actuation": "adaptive"},), {"support_wrench": 6, "estimates": 2 * N}),
    ],
    ids=["thesis", "unsupported", "levels", "cenic", "explicit", "pid", "adaptive"],
)
def test_exported_ports_are_those_of_the_docstring(changes: tuple[dict[str, str], ...], more: dict[str, Any]) -> None:
    walker = make_walker(thesis(*changes))
    outputs = {port.get_name(): port.size() for port in map(walker.get_output_port, range(walker.num_output_ports()))}
    inputs = {port.get_name(): port.size() for port in map(walker.get_input_port, range(walker.num_input_ports()))}
    assert outputs == PORTS | more
    assert inputs == {"feedforward": N}
    documented = make_walker.__doc__.partition("Exported outputs")[2]
    assert [port for port in outputs if not re.search(rf"\b{port}\b", documented)] == []


def test_support_and_exoskeleton_add_up_in_the_plant() -> None:
    walker = make_walker(thesis({"subject.devices": "[hip_exoskeleton]"}))
    context = walker.CreateDefaultContext()
    command = np.linspace(-1.0, 1.0, N)
    walker.GetInputPort("exoskeleton_command").FixValue(context, command)
    plant = walker.GetSubsystemByName("plant")
    assert isinstance(plant, MultibodyPlant)
    of_plant = plant.GetMyMutableContextFromRoot(context)
    plant.SetVelocities(of_plant, np.full(plant.num_velocities(), 0.1))
    applied = plant.get_applied_generalized_force_input_port().Eval(of_plant)
    parts = [
        system.GetOutputPort("generalized_force").Eval(system.GetMyContextFromRoot(context))
        for system in map(walker.GetSubsystemByName, ("support", "exoskeleton"))
    ]
    assert all(np.any(part) for part in parts)
    np.testing.assert_allclose(applied, sum(parts), atol=1e-12)


def test_feedforward_needs_no_connection_and_adds_torque_when_connected() -> None:
    walker = make_walker(thesis(STAND))
    torques = []
    for extra in (None, 3.0):
        simulator = Simulator(walker)
        context = simulator.get_mutable_context()
        if extra is not None:
            walker.GetInputPort("feedforward").FixValue(context, np.full(N, extra))
        simulator.Initialize()
        bank = walker.GetSubsystemByName("actuators")
        torques.append(bank.GetOutputPort("actuation").Eval(bank.GetMyContextFromRoot(context)))
    np.testing.assert_allclose(torques[1] - torques[0], 3.0)


# The start.


def standing(scenario: Scenario) -> tuple[Diagram, Context, MultibodyPlant, Context]:
    walker = make_walker(scenario)
    context = walker.CreateDefaultContext()
    plant = walker.GetSubsystemByName("plant")
    return walker, context, plant, plant.GetMyContextFromRoot(context)


@pytest.mark.parametrize(
    "subject", [{}, {"subject.mass": "55", "subject.stature": "1.6"}, {"subject.stature": "1.95"}], ids=str
)
def test_default_context_stands_on_the_ground(subject: dict[str, Any]) -> None:
    walker, context, plant, plant_context = standing(thesis(subject))
    soles = walker.GetOutputPort("soles").Eval(context)
    np.testing.assert_allclose(soles[[2, 5]], 0.0, atol=1e-3)
    query = walker.GetOutputPort("query_object").Eval(context)
    assert all(pair.depth < 1e-3 for pair in query.ComputePointPairPenetration())
    np.testing.assert_array_equal(plant.GetVelocities(plant_context), 0.0)


@pytest.mark.parametrize("lift", [-0.001, 0.05])
def test_pelvis_lift_lifts_the_body(lift: float) -> None:
    walker, context, _, _ = standing(thesis({"start.pelvis_lift": str(lift)}))
    np.testing.assert_allclose(walker.GetOutputPort("soles").Eval(context)[[2, 5]], lift, atol=1e-6)


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        ("RightLegTibiaMotion", "-0.3", "nearest allowed value is 0"),
        ("RightLegTibiaMotion", "3", "allowed: 0 to 2.356 rad"),
        ("RightLegTibaMotion", "0.3", "did you mean RightLegTibiaMotion?"),
    ],
)
def test_start_that_the_body_cannot_take_is_refused(key: str, value: str, said: str) -> None:
    scenario = thesis({f"start.joint_angles.{key}": value})
    with pytest.raises(ParameterError) as raised:
        make_walker(scenario)
    message = str(raised.value)
    assert message.startswith(f"start.joint_angles.{key}:")
    assert said in message
    assert len(message.splitlines()) == 1


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (
            {"controller.thesis.gait.path.offset": "0.03"},
            ("controller.thesis.gait.path.offset", "0.037", "step_length"),
        ),
        ({"controller.thesis.gait.path.step_length": "1"}, ("controller.thesis.gait.path.offset", "shorten the step")),
        ({"controller.thesis.gait.path.toe_drop": "0"}, ("RightLegAnkleMotion", "toe_drop")),
        ({"controller.thesis.gait.path.step_height": "0.4"}, ("RightLegAnkleMotion", "step_height")),
        ({"controller.thesis.gait.path.toe_drop": "1.2"}, ("controller.thesis.gait.path.toe_drop", "into the ground")),
        ({"actuation.pd.law": "explicit"}, ("actuation.pd.law", "unstable", "implicit")),
        ({"controller.thesis.gains.joints": "{RightLegTibaMotion: {kp: 1}}"}, ("no such joint", "RightLegTibiaMotion")),
    ],
    ids=str,
)
def test_gait_or_gains_that_cannot_work_are_refused(change: dict[str, str], said: tuple[str, ...]) -> None:
    scenario = thesis(change)
    with pytest.raises(ParameterError) as raised:
        make_walker(scenario)
    message = str(raised.value)
    assert all(part in message for part in said)
    assert len(message.splitlines()) == 1


def test_the_offset_that_is_named_as_a_mend_works() -> None:
    with pytest.raises(ParameterError) as raised:
        make_walker(thesis({"controller.thesis.gait.path.offset": "0.03"}))
    offset = str(raised.value).partition("set offset: ")[2].partition(",")[0]
    make_walker(thesis({"controller.thesis.gait.path.offset": offset}))


# Variants.


@pytest.mark.parametrize(
    "changes",
    [
        *[(HYDROELASTIC,), (CENIC,), (CENIC, HYDROELASTIC), (EXPLICIT,), (SEMI_IMPLICIT,), (IMPLICIT,), (LEVELS,)],
        *[(ASPERITY,), (ASPERITY, IMPLICIT), (ASPERITY, LEVELS)],
    ],
    ids=[
        *["hydroelastic", "cenic", "cenic-hydroelastic", "explicit", "semi_implicit", "implicit", "levels"],
        *["asperity", "asperity-implicit", "asperity-levels"],
    ],
)
def test_variant_walks_the_way_of_the_reference(changes: tuple[dict[str, str], ...]) -> None:
    walked = Walked(thesis(*changes), 0.1)
    np.testing.assert_allclose(walked.pelvis[-1][1:3], walked.value("pelvis_reference")[4:6], atol=0.01)
    assert np.isfinite(walked.value("state")).all()


@pytest.mark.parametrize("approximation", ["sap", "lagged", "similar"])
def test_contact_approximation_is_the_plants(approximation: str) -> None:
    walker = make_walker(thesis({"simulation.contact_approximation": approximation}))
    plant = walker.GetSubsystemByName("plant")
    assert plant.get_discrete_contact_approximation().name == f"k{approximation.capitalize()}"


@pytest.mark.parametrize("controller", ["reference", "balanced"])
def test_without_visuals_there_is_nothing_to_see_and_the_walk_is_the_same(controller: str) -> None:
    states = []
    for visuals in (True, False):
        walker = make_diagram(load_scenario("walk" if controller == "balanced" else "thesis"), visuals=visuals)
        inspector = walker.GetSubsystemByName("scene_graph").model_inspector()
        seen = [g for g in inspector.GetAllGeometryIds() if inspector.GetIllustrationProperties(g) is not None]
        assert bool(seen) == visuals
        simulator = Simulator(walker)
        simulator.AdvanceTo(0.05)
        states.append(walker.GetOutputPort("state").Eval(simulator.get_context()))
    np.testing.assert_allclose(*states, atol=1e-9)  # type: ignore[call-overload]


@pytest.mark.parametrize("contact", ["point", "hydroelastic"])
def test_the_spheres_under_both_soles_touch_the_ground(contact: str) -> None:
    walked = Walked(thesis(STAND, {"contact": contact}), 0.05)
    inspector = walked.walker.GetSubsystemByName("scene_graph").model_inspector()
    results = walked.value("contact_results")
    assert isinstance(results, ContactResults)
    pairs = [results.point_pair_contact_info(i).point_pair() for i in range(results.num_point_pair_contacts())]
    surfaces = [
        results.hydroelastic_contact_info(i).contact_surface() for i in range(results.num_hydroelastic_contacts())
    ]
    names = {
        inspector.GetName(geometry)
        for geometry in [
            *(end for pair in pairs for end in (pair.id_A, pair.id_B)),
            *(end for surface in surfaces for end in (surface.id_M(), surface.id_N())),
        ]
    }
    shapes = {name for name in names if "ground" not in name}
    assert all(SOLE_SET in name for name in shapes)
    assert all(any(f"{side}Leg" in name for name in shapes) for side in SIDES)
    assert bool(pairs) == (contact == "point")
    assert bool(surfaces) == (contact == "hydroelastic")


def test_drake_collides_no_foot_that_the_asperity_law_carries() -> None:
    walked = Walked(thesis(STAND, ASPERITY), 0.05)
    results = walked.value("contact_results")
    assert (results.num_point_pair_contacts(), results.num_hydroelastic_contacts()) == (0, 0)  # type: ignore[attr-defined]
    assert walked.value("foot_forces").reshape(2, 8)[:, 7].tolist() == [1.0, 1.0]


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (CENIC, ("contact: asperity", "discrete", "contact: point")),
        ({"simulation.time_step": "0.003"}, ("asperity: unstable", "time_step")),
    ],
    ids=["cenic", "step"],
)
def test_asperity_that_cannot_be_simulated_is_refused(change: dict[str, str], said: tuple[str, ...]) -> None:
    with pytest.raises(ParameterError) as raised:
        make_walker(thesis(ASPERITY, change))
    message = str(raised.value)
    assert all(part in message for part in said)
    assert len(message.splitlines()) == 1


def test_the_step_that_is_named_as_a_mend_for_asperity_works() -> None:
    with pytest.raises(ParameterError) as raised:
        make_walker(thesis(ASPERITY, {"simulation.time_step": "0.003"}))
    step = str(raised.value).partition("steps up to ")[2].partition(" s")[0]
    make_walker(thesis(ASPERITY, {"simulation.time_step": step}))


@pytest.mark.parametrize("law", ["implicit", "semi_implicit"])
def test_effort_limits_bound_the_torque_only_where_the_scenario_has_them(law: PdLaw, joints: JointMap) -> None:
    excess = {}
    for kind in ("human", "none"):
        walked = Walked(thesis({"actuation.pd.effort_limits": kind, "actuation.pd.law": law}), 0.25)
        share = np.abs(walked.torque) / joints.effort_limits
        saturated = np.array(walked.saturated)
        excess[kind] = share.max() - 1.0
        at_limit = (share >= 1 - 1e-9) & (kind == "human")
        assert (saturated == at_limit).mean() >= (1.0 if kind == "none" else 0.98)
    # A semi-implicit joint also feels what its damping makes of the change of velocity within a step.
    assert excess["human"] <= (1e-9 if law == "implicit" else 0.25)
    assert excess["none"] > 0.5


def test_heavier_subject_is_heavier() -> None:
    plant = make_walker(thesis({"subject.mass": "90"})).GetSubsystemByName("plant")
    assert plant.CalcTotalMass(plant.CreateDefaultContext()) == pytest.approx(90.0, abs=1e-6)


# Determinism.


def test_same_scenario_gives_the_same_bits_and_another_seed_another_walk() -> None:
    noisy = {"start.joint_noise": "0.01"}
    first, again, other = (Walked(thesis(noisy, {"seed": seed}), 0.2).value("state").copy() for seed in ("1", "1", "2"))
    np.testing.assert_array_equal(first, again)
    assert np.abs(first - other).max() > 1e-4


def test_seed_without_noise_changes_nothing() -> None:
    states = [make_walker(thesis({"seed": seed})).GetOutputPort("state") for seed in ("1", "2")]
    first, other = (port.Eval(port.get_system().CreateDefaultContext()) for port in states)
    np.testing.assert_array_equal(first, other)


# Physics.


@pytest.fixture(
    scope="module",
    params=[(STAND,), (STAND, HYDROELASTIC), (STAND, ASPERITY)],
    ids=["point", "hydroelastic", "asperity"],
)
def stood(request: pytest.FixtureRequest) -> Walked:
    """A second of standing."""
    return Walked(thesis(*request.param), 1.0)


def test_standing_feet_and_support_carry_the_weight(stood: Walked) -> None:
    forces, support = stood.value("foot_forces").reshape(2, 8), stood.value("support_wrench")
    weight = 70.0 * GRAVITY
    assert forces[:, 2].sum() + support[5] == pytest.approx(weight, rel=0.01)
    assert forces[:, 2].sum() == pytest.approx(weight, rel=0.1)
    assert forces[0, 2] == pytest.approx(forces[1, 2], rel=0.02)
    np.testing.assert_array_equal(forces[:, 7], 1.0)


def test_standing_center_of_pressure_is_inside_each_sole(stood: Walked) -> None:
    forces, soles = stood.value("foot_forces").reshape(2, 8), stood.value("soles").reshape(2, 3)
    back, front = SOLE_PARTS[0].x[0], SOLE_PARTS[-1].x[1]
    for foot, sole in zip(forces, soles, strict=True):
        x, y = foot[3:5] - sole[:2]
        assert back < x < front
        assert abs(y) < 0.5 * SOLE_PARTS[0].width
        assert foot[5] == pytest.approx(0.0, abs=1e-12)


def test_standing_center_of_mass_stays(stood: Walked) -> None:
    com = stood.value("com")
    np.testing.assert_allclose(com[1], 0.0, atol=1e-3)
    np.testing.assert_allclose(com[3:], 0.0, atol=0.01)


def test_halving_the_time_step_hardly_moves_the_walk() -> None:
    coarse, fine = (
        np.array(Walked(thesis({"simulation.time_step": step}), 0.5).pelvis) for step in ("0.001", "0.0005")
    )
    at = [np.interp(coarse[:, 0], fine[:, 0], fine[:, axis]) for axis in (1, 2, 3)]
    assert np.abs(coarse[:, 1:] - np.transpose(at)).max() < 5e-3
