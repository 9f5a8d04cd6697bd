"""The same body in Drake and in MuJoCo: the same mass matrix, the same fall, the same walk, and what each costs.

    python benchmarks/mujoco_physics.py           # writes benchmarks/results/mujoco_physics.json

The thesis' walk is simulated in Drake and every step's joint targets and pelvis reference are kept. MuJoCo's body
follows them by the same law (kd as the joints' implicit damping, the rest as torque) and the same support. Costs are of
the physics alone, in the same run, by turns of 0.1 s: Drake's is the bare plant that repeats the walk, MuJoCo's is
mj_step, without the Python that feeds either.
"""

import argparse
import json
import logging
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder, EventStatus

from humanwalk.bench.bare_plant import BarePlant, record_plant
from humanwalk.bench.cost import Cost, cost_of, in_turns
from humanwalk.bench.result import machine
from humanwalk.body.joint_map import JointMap
from humanwalk.body.mjcf import to_mjcf
from humanwalk.body.plant import kinematics_plant
from humanwalk.choices import ThesisController
from humanwalk.control.balance_support import support_wrench
from humanwalk.diagrams.world import add_world
from humanwalk.exchange.mujoco_map import MujocoMap
from humanwalk.files import write_text
from humanwalk.quantity import GRAVITY, ParameterError
from humanwalk.run.simulate import prepare
from humanwalk.scenario import Scenario, load_scenario

Array = npt.NDArray[np.float64]

RESULTS = Path(__file__).parent / "results" / "mujoco_physics.json"
WINDOW = 0.02
"""Over which ground forces are averaged [s]."""


class Walk:
    """What Drake's walker did, at every step: targets, and what came of them."""

    def __init__(self, scenario: Scenario) -> None:
        prepared = prepare(scenario, record=False)
        walker, dt = prepared.walker, scenario.simulation.time_step
        names = ("desired_state", "pelvis_reference", "state", "com", "foot_forces", "support_wrench")
        steps = round(scenario.duration / dt) + 1
        kept: dict[str, Array] = {name: np.zeros((steps, walker.GetOutputPort(name).size())) for name in names}

        def keep(root_context: Any) -> EventStatus:
            context = walker.GetMyContextFromRoot(root_context)
            for name, rows in kept.items():
                rows[round(root_context.get_time() / dt)] = walker.GetOutputPort(name).Eval(context)
            return EventStatus.DidNothing()

        prepared.simulator.set_monitor(keep)
        prepared.simulator.Initialize()
        prepared.simulator.AdvanceTo(scenario.duration)
        self.desired, self.pelvis, self.state, self.com, forces, wrench = kept.values()
        self.ground_force = forces[:, :3] + forces[:, 8:11]
        self.support_force = wrench[:, 3:]


class MujocoWalk:
    """MuJoCo's body after the targets of a walk."""

    def __init__(self, scenario: Scenario, walk: Walk) -> None:
        assert isinstance(scenario.controller, ThesisController)
        self.support, self.walk = scenario.controller.balance.support, walk
        self.joints = JointMap.of(kinematics_plant(scenario.subject))
        self.model = mujoco.MjModel.from_xml_string(to_mjcf(scenario.subject.skeleton))
        self.model.opt.timestep = scenario.simulation.time_step
        # The scenario's actuators have no limits.
        self.model.actuator_ctrllimited[:] = 0
        self.map = MujocoMap.of(self.joints, self.model)
        world = add_world(DiagramBuilder(), scenario)
        self.kp, self.kd = world.kp, world.kd
        self.model.dof_damping[self.map.qvel] += self.kd
        self.data = mujoco.MjData(self.model)
        self.data.qpos[:] = self.map.to_qpos(walk.state[0, : self.joints.num_positions])
        self.step = 0
        steps = len(walk.state)
        self.angle, self.com = np.zeros((steps, self.kp.size)), np.zeros((steps, 3))
        self.ground_force, self.support_force = np.zeros((steps, 3)), np.zeros((steps, 3))

    def advance(self, until: float) -> Cost:
        cost = Cost(0.0, 0.0)
        while (self.step + 1) * self.model.opt.timestep <= until + 1e-9:
            self._feed()
            cost += cost_of(lambda: mujoco.mj_step(self.model, self.data))
            self._keep()
            self.step += 1
        return cost

    def _feed(self) -> None:
        n = self.kp.size
        qpos, qvel = self.data.qpos, self.data.qvel
        q = self.map.to_q(qpos)
        desired = self.walk.desired[self.step]
        # Motors are in the skeleton's order of joints, which is the actuators'.
        self.data.ctrl[:] = self.kp * (desired[:n] - self.joints.positions(q)) + self.kd * desired[n:]
        T = self.map.velocity_matrix(q)[:6, :6]
        wrench = support_wrench(q[:7], T @ qvel[:6], self.walk.pelvis[self.step], self.support)
        self.data.qfrc_applied[:6] = T.T @ wrench
        self.support_force[self.step] = wrench[3:]
        self.angle[self.step] = self.joints.positions(q)

    def _keep(self) -> None:
        # All of it is of the beginning of the step, at which MuJoCo finds its forces.
        self.com[self.step] = self.data.subtree_com[0]
        wrench = np.zeros(6)
        for i in range(self.data.ncon):
            mujoco.mj_contactForce(self.model, self.data, i, wrench)
            # The contact's axes are rows of its frame; its normal leads from the first geometry to the second.
            ground_first = self.model.geom(self.data.contact[i].geom1).name == "ground"
            force = self.data.contact[i].frame.reshape(3, 3).T @ wrench[:3]
            self.ground_force[self.step] += force if ground_first else -force


def same_dynamics(scenario: Scenario, states: int = 50) -> dict[str, float]:
    """Greatest relative difference of mass matrix and of bias forces in random states."""
    plant = kinematics_plant(scenario.subject)
    context, joints = plant.CreateDefaultContext(), JointMap.of(plant)
    model = mujoco.MjModel.from_xml_string(to_mjcf(scenario.subject.skeleton))
    data, map_ = mujoco.MjData(model), MujocoMap.of(joints, model)
    rng = np.random.default_rng(0)
    mass, bias = [], []
    for _ in range(states):
        q = np.concatenate((rng.standard_normal(4), rng.standard_normal(plant.num_positions() - 4)))
        q[:4] /= np.linalg.norm(q[:4])
        q[joints.q] = rng.uniform(joints.lower, joints.upper)
        v = rng.standard_normal(plant.num_velocities())
        plant.SetPositions(context, q)
        plant.SetVelocities(context, v)
        T = map_.velocity_matrix(q)
        data.qpos[:], data.qvel[:] = map_.to_qpos(q), T.T @ v
        mujoco.mj_forward(model, data)
        M, in_mujoco = plant.CalcMassMatrix(context), np.zeros((v.size, v.size))
        mujoco.mj_fullM(model, data, in_mujoco)
        forces = plant.CalcBiasTerm(context) - plant.CalcGravityGeneralizedForces(context)
        mass.append(np.abs(T @ in_mujoco @ T.T - M).max() / np.abs(M).max())
        bias.append(np.abs(T @ data.qfrc_bias - forces).max() / np.abs(forces).max())
    return {"mass_matrix_relative": float(max(mass)), "bias_forces_relative": float(max(bias))}


def side_by_side(scenario: Scenario) -> dict[str, float]:
    """Simulate a scenario in both by turns, and compare motion, forces and cost."""
    prepared = prepare(scenario, record=False)
    record = record_plant(prepared)
    prepared.simulator.Initialize()
    prepared.simulator.AdvanceTo(scenario.duration)
    walk = Walk(scenario)
    drake, other = BarePlant(scenario, record), MujocoWalk(scenario, walk)
    turns = in_turns({"drake": drake.advance, "mujoco": other.advance}, scenario.duration)
    cost = {name: np.array([turn.cpu for turn in costs]) for name, costs in turns.items()}
    last = other.step
    window = round(WINDOW / scenario.simulation.time_step)

    def means(force: Array) -> Array:
        return force[: last // window * window].reshape(-1, window, 3).mean(axis=1)

    def rms(difference: Array) -> float:
        return float(np.sqrt((difference**2).sum(axis=-1).mean()))

    weight = scenario.subject.mass * GRAVITY
    final = slice(last - round(0.5 / scenario.simulation.time_step), last)
    angle = np.array([other.joints.positions(state) for state in walk.state[:last]])
    wanted = walk.desired[:last, : other.kp.size]
    return {
        "drake_ms_per_step": float(1e3 * cost["drake"].sum() / last),
        "mujoco_ms_per_step": float(1e3 * cost["mujoco"].sum() / last),
        "cost_ratio_median": float(np.median(cost["drake"] / cost["mujoco"])),
        "angle_rms_rad": rms(angle - other.angle[:last]) / other.kp.size**0.5,
        "tracking_rms_rad_drake": rms(angle - wanted) / other.kp.size**0.5,
        "tracking_rms_rad_mujoco": rms(other.angle[:last] - wanted) / other.kp.size**0.5,
        "com_rms_m": rms(walk.com[:last, :3] - other.com[:last]),
        "force_rms_N": rms(means(walk.ground_force) - means(other.ground_force)),
        "force_size_rms_N": rms(means(walk.ground_force)),
        "final_vertical_over_weight_drake": _vertical(walk.ground_force, walk.support_force, final) / weight,
        "final_vertical_over_weight_mujoco": _vertical(other.ground_force, other.support_force, final) / weight,
    }


def _vertical(ground: Array, support: Array, rows: slice) -> float:
    return float((ground + support)[rows, 2].mean())


def free_fall(scenario: Scenario, duration: float = 0.3) -> dict[str, float]:
    """Let a limp, turning body fall in both: how far each ends from where the other does, and from the parabola."""
    plant = kinematics_plant(scenario.subject)
    joints, rng = JointMap.of(plant), np.random.default_rng(1)
    simulator = Simulator(plant)
    context = simulator.get_mutable_context()
    plant.get_actuation_input_port().FixValue(context, np.zeros(joints.q.size))
    q, v = plant.GetPositions(context), 0.3 * rng.standard_normal(plant.num_velocities())
    q[6] += 5.0
    q[joints.q] = 0.5 * (joints.lower + joints.upper)
    plant.SetPositions(context, q)
    plant.SetVelocities(context, v)
    start = plant.CalcCenterOfMassPositionInWorld(context)
    parabola = start + duration * plant.CalcCenterOfMassTranslationalVelocityInWorld(context)
    parabola[2] -= 0.5 * GRAVITY * duration**2
    model = mujoco.MjModel.from_xml_string(to_mjcf(scenario.subject.skeleton))
    model.opt.timestep, model.opt.integrator = 1e-4, mujoco.mjtIntegrator.mjINT_RK4
    data, map_ = mujoco.MjData(model), MujocoMap.of(joints, model)
    data.qpos[:], data.qvel[:] = map_.to_qpos(q), map_.velocity_matrix(q).T @ v
    mujoco.mj_step(model, data, nstep=round(duration / model.opt.timestep))
    mujoco.mj_forward(model, data)
    simulator.get_mutable_integrator().set_target_accuracy(1e-9)
    simulator.AdvanceTo(duration)
    angle = joints.positions(plant.GetPositions(context))
    return {
        "com_off_parabola_m_drake": float(np.linalg.norm(plant.CalcCenterOfMassPositionInWorld(context) - parabola)),
        "com_off_parabola_m_mujoco": float(np.linalg.norm(data.subtree_com[0] - parabola)),
        "angle_difference_rad": float(np.abs(angle - joints.positions(map_.to_q(data.qpos))).max()),
    }


def main() -> None:
    logging.getLogger("drake").setLevel(logging.ERROR)
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--duration", type=float, default=3.0, help="of the walk [s]")
    duration = parser.parse_args().duration
    if duration < 1.0:
        raise ParameterError(f"--duration: {duration:g} is out of range; allowed: from 1 s on; give more")
    thesis = load_scenario("thesis", {"duration": repr(duration)})
    standing = load_scenario("thesis", {"duration": repr(duration), "controller.thesis.gait.ramp.speed": "0"})
    results = {
        "dynamics": same_dynamics(thesis),
        "fall": free_fall(thesis),
        "stand": side_by_side(standing),
        "walk": side_by_side(thesis),
    }
    for name, values in results.items():
        for key, value in values.items():
            print(f"{name:10s}{key:36s}{value:12.4g}")
    write_text(RESULTS, json.dumps({"machine": machine() | {"mujoco": mujoco.__version__}} | results, indent=1) + "\n")


if __name__ == "__main__":
    main()
