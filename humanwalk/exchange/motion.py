"""Motion and forces of a run in space: plant positions, marker paths, ground reaction force per foot."""

from dataclasses import dataclass

import numpy as np

from humanwalk.body import SIDES, Side
from humanwalk.body.joint_map import JointMap
from humanwalk.body.markers import Marker, markers
from humanwalk.body.plant import kinematics_plant
from humanwalk.measures.signals import TIME, matrix
from humanwalk.numerics import Array
from humanwalk.run.folder import Run
from humanwalk.systems.signal import state_columns


@dataclass(frozen=True)
class GroundForce:
    """Measurement of a force plate under one foot, in W; defined at every time.

    Attributes:
        force: Force on the foot [N], shape (rows, 3); zero while unloaded.
        point: Center of pressure [m], shape (rows, 3). While the foot is unloaded it is interpolated linearly from
            toe-off to touchdown, and constant before the first and after the last contact, so that filters and splines
            of other programs see no jump.
        free_moment: Moment about the normal of the ground through `point`, in W [N m], shape (rows, 3); zero while
            unloaded.
    """

    force: Array
    point: Array
    free_moment: Array


def positions(run: Run) -> Array:
    """Plant positions q of every row, shape (rows, 49)."""
    joints = JointMap.of(kinematics_plant(run.scenario.subject))
    return matrix(run.signals, state_columns(joints)[: joints.num_positions])


def marker_paths(run: Run) -> dict[str, Array]:
    """Position of every marker in W [m] by name, shape (rows, 3) each."""
    subject = run.scenario.subject
    plant = kinematics_plant(subject)
    context = plant.CreateDefaultContext()
    on_body: dict[str, list[Marker]] = {}
    for marker in markers(subject.skeleton):
        on_body.setdefault(marker.body, []).append(marker)
    bodies = [
        (plant.GetBodyByName(body), stuck, np.array([marker.position for marker in stuck]).T)
        for body, stuck in on_body.items()
    ]
    rows = positions(run)
    paths = {marker.name: np.empty((len(rows), 3)) for marker in markers(subject.skeleton)}
    for i, q in enumerate(rows):
        plant.SetPositions(context, q)
        for body, stuck, p_BM in bodies:
            for marker, p_WM in zip(stuck, (body.EvalPoseInWorld(context) @ p_BM).T, strict=True):
                paths[marker.name][i] = p_WM
    return paths


def ground_force(run: Run, side: Side) -> GroundForce:
    """Ground reaction force on one foot."""
    signals, foot = run.signals, f"{side.lower()}_foot"
    time = signals[TIME].to_numpy()
    loaded = signals[f"{foot}.loaded"].to_numpy() > 0.5
    force = matrix(signals, [f"{foot}.force_{axis}_N" for axis in "xyz"]) * loaded[:, None]
    point = np.zeros_like(force)
    if loaded.any():
        for i, axis in enumerate("xyz"):
            cop = signals[f"{foot}.cop_{axis}_m"].to_numpy()
            point[:, i] = np.interp(time, time[loaded], cop[loaded])
    normal = run.scenario.terrain.axes(point[:, :2])[:, 2]
    moment = signals[f"{foot}.free_moment_N_m"].to_numpy() * loaded
    return GroundForce(force, point, moment[:, None] * normal)


def ground_forces(run: Run) -> dict[Side, GroundForce]:
    """Ground reaction force on both feet."""
    return {side: ground_force(run, side) for side in SIDES}


def sample_rate(run: Run) -> float:
    """Sample rate of the signals [1/s]."""
    return 1.0 / run.scenario.recording.signal_period
