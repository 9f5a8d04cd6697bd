"""LeafSystem: ground reaction force and centre of pressure of each foot."""

from collections.abc import Sequence

import numpy as np
from pydrake.common.value import Value
from pydrake.geometry import SceneGraphInspector
from pydrake.multibody.plant import ContactResults, MultibodyPlant
from pydrake.systems.framework import BasicVector, Context, LeafSystem

from humanwalk.body import SIDES
from humanwalk.body.contact import FRICTION
from humanwalk.body.limbs import LEGS
from humanwalk.contact.ground_force import foot_force, friction_use
from humanwalk.numerics import Array


class FootForceObserver(LeafSystem):
    """Sums the plant's contacts, point and hydroelastic, over the bodies of each foot.

    Inputs:
        contact_results: the plant's ContactResults.

    Outputs:
        foot_forces: (16) right foot, then left foot, each: force on the foot in W [N] x y z, centre of pressure in W
            [m] x y z, free moment [N m], loaded (1 or 0). The last five are 0 while the foot is unloaded.
        friction_use: (2) right, left: force along the ground over the friction coefficient times the force across it;
            0 while the foot is unloaded.
    """

    def __init__(self, plant: MultibodyPlant, inspector: SceneGraphInspector) -> None:
        """Make the observer of a finalised plant; `inspector` tells which body a contact surface belongs to."""
        super().__init__()
        # By the bodies A and B of a contact: the foot that touches the ground, and the sign that makes a force on B one
        # on the foot. Two legs against each other are not meant.
        self._foot: dict[tuple[int, int], tuple[int, float]] = {}
        world = int(plant.world_body().index())
        for place, side in enumerate(SIDES):
            for name in LEGS[side].foot_bodies:
                of_foot = int(plant.GetBodyByName(name).index())
                self._foot |= {(world, of_foot): (place, 1.0), (of_foot, world): (place, -1.0)}
        self._body_of_geometry = {
            geometry: int(body.index())
            for geometry in inspector.GetAllGeometryIds()
            if (body := plant.GetBodyFromFrameId(inspector.GetFrameId(geometry))) is not None
        }
        self._contacts = self.DeclareAbstractInputPort("contact_results", Value(ContactResults()))
        self._output = self.DeclareVectorOutputPort(
            "foot_forces",
            16,
            self._calc,
            prerequisites_of_calc={self.input_port_ticket(self._contacts.get_index())},
        )
        self._friction_use_output = self.DeclareVectorOutputPort(
            "friction_use",
            2,
            self._calc_friction_use,
            prerequisites_of_calc={self.input_port_ticket(self._contacts.get_index())},
        )

    def _calc(self, context: Context, output: BasicVector) -> None:
        results = self._contacts.Eval(context)
        # Of each foot, moment about the world's origin and force; in plain floats, which are quicker for so few.
        wrenches = [[0.0] * 6, [0.0] * 6]
        for i in range(results.num_point_pair_contacts()):
            pair = results.point_pair_contact_info(i)
            found = self._foot.get((int(pair.bodyA_index()), int(pair.bodyB_index())))
            if found is not None:
                foot, sign = found
                _add(wrenches[foot], sign, pair.contact_point().tolist(), pair.contact_force().tolist())
        for i in range(results.num_hydroelastic_contacts()):
            info = results.hydroelastic_contact_info(i)
            surface, F_Ac_W = info.contact_surface(), info.F_Ac_W()
            # The force is that on M, the first body here.
            found = self._foot.get((self._body_of_geometry[surface.id_N()], self._body_of_geometry[surface.id_M()]))
            if found is not None:
                foot, sign = found
                force, moment = F_Ac_W.translational().tolist(), F_Ac_W.rotational().tolist()
                _add(wrenches[foot], sign, surface.centroid().tolist(), force, moment)
        right, left = (foot_force(F[3:], F[:3]).vector for F in wrenches)
        output.SetFromVector(np.array((*right, *left)))

    def _calc_friction_use(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(friction_used(self._output.Eval(context)))


def friction_used(foot_forces: Array) -> list[float]:
    """Output friction_use (2) from the other output (16)."""
    return [friction_use(foot[:2], FRICTION * foot[2]) for foot in foot_forces.reshape(2, 8).tolist()]


def _add(wrench: list[float], sign: float, p: list[float], f: list[float], moment: Sequence[float] = (0, 0, 0)) -> None:
    """Add a force f at p, and a moment, to a wrench about the origin."""
    wrench[0] += sign * (p[1] * f[2] - p[2] * f[1] + moment[0])
    wrench[1] += sign * (p[2] * f[0] - p[0] * f[2] + moment[1])
    wrench[2] += sign * (p[0] * f[1] - p[1] * f[0] + moment[2])
    wrench[3] += sign * f[0]
    wrench[4] += sign * f[1]
    wrench[5] += sign * f[2]
