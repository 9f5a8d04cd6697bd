"""Contacts of the whole-body program: points under the feet, and the edges of their friction pyramids."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from humanwalk.body import SIDES, Side
from humanwalk.body.contact import ContactSphere
from humanwalk.body.limbs import LEGS
from humanwalk.control.body_dynamics import Dynamics
from humanwalk.control.whole_body_parameters import WholeBodyParameters
from humanwalk.numerics import Array, Indices, Mask
from humanwalk.numerics.rotation import cross_matrix
from humanwalk.quantity import GRAVITY
from humanwalk.terrain import Ground
from humanwalk.walking.walking_reference import FootReference, FootTask, WalkingReference

EDGES = 4
"""Number of edges of a friction pyramid."""

MIN_LOAD = 0.01
"""Smallest load by which the cost of a force is divided (our choice)."""


@dataclass(frozen=True)
class Soles:
    """The k contact points under both feet, followed by the middles of the heel and of the toes of each foot, all heels
    first, in the order of SIDES.

    Attributes:
        body: index of each point's body among those of `Dynamics`, (k + 4,).
        p_BP: in that body's frame [m], (k + 4, 3).
        side: index of the foot of each contact point in SIDES, (k,).
        is_heel: whether a contact point is under the hindfoot, (k,).
    """

    body: Indices
    p_BP: Array
    side: Indices
    is_heel: Mask

    @staticmethod
    def of(spheres: Sequence[ContactSphere], bodies: Sequence[str]) -> Soles:
        """The lowest points of contact spheres, in their order, with flat feet.

        Args:
            spheres: of both feet.
            bodies: names of the bodies of `Dynamics`.
        """
        points = np.array([(*sphere.center[:2], sphere.center[2] - sphere.radius) for sphere in spheres])
        under = np.array([sphere.body for sphere in spheres])
        hindfeet = [LEGS[side].hindfoot for side in SIDES]
        ends = [*hindfeet, *(LEGS[side].toe_segment for side in SIDES)]
        middles = [points[under == end].mean(axis=0) for end in ends]
        feet = [LEGS[side].foot_bodies for side in SIDES]
        return Soles(
            body=np.array([bodies.index(name) for name in (*under, *ends)]),
            p_BP=np.concatenate((points, middles)),
            side=np.array([[name in foot for foot in feet].index(True) for name in under]),
            is_heel=np.isin(under, hindfeet),
        )

    def on(self, ground: Ground, body: Dynamics) -> SolesOnGround:
        """The points of the soles relative to the ground below them."""
        X_WB = body.X_WB[self.body]
        r_W = (X_WB[:, :, :3] @ self.p_BP[:, :, None])[:, :, 0]
        p_W = X_WB[:, :, 3] + r_W
        xy = p_W[:, :2]
        R_SW = ground.axes(xy)
        return SolesOnGround(self, p_W, r_W, (p_W[:, 2] - ground.height(xy)) * R_SW[:, 2, 2], R_SW, ground.friction(xy))


class SolesOnGround(NamedTuple):
    """The points of `Soles` at one state.

    Attributes:
        soles: the points.
        p_W: in W [m], (k + 4, 3).
        r_W: from the origin of each point's body to the point, in W [m], (k + 4, 3).
        height: above the ground along its normal [m], (k + 4,).
        R_SW: axes of the ground below each point, (k + 4, 3, 3).
        friction: Coulomb coefficient of the ground below each point, (k + 4,).
    """

    soles: Soles
    p_W: Array
    r_W: Array
    height: Array
    R_SW: Array
    friction: Array

    def heel(self, side: Side) -> tuple[Array, float]:
        """Middle of a heel: position in the hindfoot's frame [m], height above the ground [m]."""
        i = SIDES.index(side) - 2 * len(SIDES)
        return self.soles.p_BP[i], float(self.height[i])

    def toes(self, side: Side) -> Array:
        """Middle of the contact points of the toes, in the frame of the toes [m]."""
        p_BP: Array = self.soles.p_BP[SIDES.index(side) - len(SIDES)]
        return p_BP

    def contacts(self, body: Dynamics, reference: WalkingReference, p: WholeBodyParameters) -> Contacts:
        """The points that can carry a force.

        Args:
            body: at this state.
            reference: loads of the feet.
            p: limits of friction, forces and the height of a point in contact.
        """
        soles = self.soles
        feet = [reference.foot(side) for side in SIDES]
        load = np.array([foot.load for foot in feet])[soles.side]
        is_near = self.height[: load.size] < p.contact_height
        limits = self._limits(feet, is_near, GRAVITY * body.mass, p)
        (points,) = np.nonzero(is_near & (limits[1] > 0.0))
        under = soles.body[points]
        J = body.J[under]
        # The velocity of a point is v + w x r.
        J_points = J[:, 3:] - cross_matrix(self.r_W[points]) @ J[:, :3]
        mu = np.minimum(p.friction, p.friction_use * self.friction[points])
        R_SW = self.R_SW[points]
        share = np.maximum(load[points], MIN_LOAD)
        edges_W = np.sqrt(share)[:, None, None] * (friction_edges(mu, p.force_unit) @ R_SW)
        J_edges = (edges_W @ J_points).reshape(-1, J.shape[-1])
        limits = limits[:, points] / (p.force_unit * np.sqrt(share))
        side = soles.side[points]
        on_ball = [i for i in np.unique(side).tolist() if feet[i].task is FootTask.HEEL_OFF]
        return Contacts(points, side, on_ball, self.p_W[points], limits, edges_W, J_edges)

    def _limits(self, feet: Sequence[FootReference], is_near: Mask, weight: float, p: WholeBodyParameters) -> Array:
        """Least and largest force along each edge of the contact points [N], (2, k).

        Args:
            feet: in the order of SIDES.
            is_near: whether a contact point is near the ground, (k,).
            weight: of the body [N].
            p: `max_contact_force`.
        """
        limits = np.zeros((2, is_near.size))
        for i, foot in enumerate(feet):
            near = is_near & (self.soles.side == i)
            heel = near & self.soles.is_heel
            limits[1, near] = foot.load * min(p.max_contact_force, foot.force * weight / (EDGES * max(near.sum(), 1)))
            heel_limits = weight / (EDGES * max(heel.sum(), 1)) * np.array(foot.heel)[:, None]
            limits[:, heel] = np.minimum(heel_limits, limits[1, heel])
        return limits


def friction_edges(mu: Array, unit: float) -> Array:
    """Edges of friction pyramids along the third axis, (n, 4, 3), for n friction coefficients; as long as a unit of
    force [N] along that axis.
    """
    edges = np.zeros((mu.size, EDGES, 3))
    edges[:, :, 2] = 1.0
    edges[:, 0, 0] = edges[:, 2, 1] = mu
    edges[:, 1, 0] = edges[:, 3, 1] = -mu
    edges *= unit
    return edges


class Contacts(NamedTuple):
    """The points that can carry a force, c of them.

    Attributes:
        points: indices of the points, (c,).
        side: index of the foot of each point in SIDES, (c,).
        on_ball: indices of the feet with points whose heel is up.
        p_W: the points in W [m], (c, 3).
        limits: least and largest force along each edge, per length of the edge, (2, c).
        edges_W: edges of each point's friction pyramid in W, (c, edges, 3).
        J_edges: Jacobian of the velocities along all edges, (c x edges, nv).
    """

    points: Indices
    side: Indices
    on_ball: Sequence[int]
    p_W: Array
    limits: Array
    edges_W: Array
    J_edges: Array

    def forces(self, edge_forces: Array) -> Array:
        """Force on each point in W, (c, 3), from the forces along all edges, (c x edges,)."""
        forces: Array = (edge_forces.reshape(*self.edges_W.shape[:2], 1) * self.edges_W).sum(axis=1)
        return forces

    def twist(self, arm: float) -> Array:
        """Limits of the twist: rows whose products with the edge forces must not be positive, (2 x feet, c x edges).

        The moment of a foot whose heel is up, about the vertical through the mean of its contact points, is at most an
        arm [m] times its vertical force, in both directions.
        """
        rows = np.zeros((len(self.on_ball), 2, *self.edges_W.shape[:2]))
        for row, foot in zip(rows, self.on_ball, strict=True):
            of_foot = self.side == foot
            edges = self.edges_W[of_foot]
            x, y, _ = (self.p_W[of_foot] - self.p_W[of_foot].mean(axis=0)).T[:, :, None]
            moment = x * edges[:, :, 1] - y * edges[:, :, 0]
            row[:, of_foot] = np.array((moment, -moment)) - arm * edges[:, :, 2]
        return rows.reshape(2 * len(self.on_ball), len(self.J_edges))

    def across(self, p_WV: Array) -> Array:
        """Components of the edges across the lines from their points to a point V, in W, (c x edges, 3 per foot).

        Those of an edge are in the columns of its foot, so that edge_forces @ across is the force of each foot across
        its line.

        Args:
            p_WV: position of V [m].
        """
        along = p_WV - self.p_W
        along /= np.linalg.norm(along, axis=1, keepdims=True)
        across = self.edges_W - (self.edges_W @ along[:, :, None]) * along[:, None, :]
        is_of_foot = self.side[:, None] == np.arange(len(SIDES))
        by_foot: Array = across[:, :, None, :] * is_of_foot[:, None, :, None]
        return by_foot.reshape(-1, 3 * len(SIDES))
