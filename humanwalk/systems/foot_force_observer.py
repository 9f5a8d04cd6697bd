"""LeafSystem: ground reaction force and centre of pressure of each foot."""

import numpy as np
import numpy.typing as npt
from pydrake.common.value import Value
from pydrake.geometry import SceneGraphInspector
from pydrake.multibody.plant import ContactResults, MultibodyPlant
from pydrake.systems.framework import BasicVector, Context, InputPort, LeafSystem, OutputPort

from humanwalk.body import SIDES
from humanwalk.body.contact import FRICTION
from humanwalk.body.groups import FOOT_BODIES
from humanwalk.control.ground_force import foot_force, friction_use, moments

Array = npt.NDArray[np.float64]


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
        self._world = plant.world_body().index()
        self._side_of_body = {
            int(plant.GetBodyByName(name).index()): place
            for place, side in enumerate(SIDES)
            for name in FOOT_BODIES[side]
        }
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
        f_W, tau_Wo = np.zeros((2, 3)), np.zeros((2, 3))
        # Of every contact with the ground, by foot: point of action and force on the foot.
        points: tuple[list[Array], ...] = ([], [])
        forces: tuple[list[Array], ...] = ([], [])
        for i in range(results.num_point_pair_contacts()):
            pair = results.point_pair_contact_info(i)
            found = self._foot(pair.bodyA_index(), pair.bodyB_index())
            if found is not None:
                foot, sign = found
                points[foot].append(pair.contact_point())
                forces[foot].append(sign * pair.contact_force())
        for i in range(results.num_hydroelastic_contacts()):
            info = results.hydroelastic_contact_info(i)
            surface = info.contact_surface()
            # The force is that on M, the first body here.
            found = self._foot(*(self._body_of_geometry[id] for id in (surface.id_N(), surface.id_M())))
            if found is not None:
                foot, sign = found
                points[foot].append(surface.centroid())
                forces[foot].append(sign * info.F_Ac_W().translational())
                tau_Wo[foot] += sign * info.F_Ac_W().rotational()
        for foot in range(2):
            if forces[foot]:
                f = np.array(forces[foot])
                f_W[foot] = f.sum(axis=0)
                tau_Wo[foot] += moments(np.array(points[foot]), f)

        output.SetFromVector(np.concatenate([foot_force(f_W[i], tau_Wo[i]).vector for i in range(2)]))

    def _foot(self, body_A: int, body_B: int) -> tuple[int, float] | None:
        """The foot that touches the ground, and the sign that makes a force on B one on the foot; None if none does."""
        # Either may be the ground; two legs against each other are not meant.
        if body_A == self._world:
            foot, sign = self._side_of_body.get(int(body_B)), 1.0
        elif body_B == self._world:
            foot, sign = self._side_of_body.get(int(body_A)), -1.0
        else:
            return None
        return None if foot is None else (foot, sign)

    def _calc_friction_use(self, context: Context, output: BasicVector) -> None:
        feet = self._output.Eval(context).reshape(2, 8)
        output.SetFromVector([friction_use(foot[:2], FRICTION * foot[2]) for foot in feet])

    def get_contact_results_input_port(self) -> InputPort:
        """Input contact_results."""
        return self._contacts

    def get_foot_forces_output_port(self) -> OutputPort:
        """Output foot_forces."""
        return self._output

    def get_friction_use_output_port(self) -> OutputPort:
        """Output friction_use."""
        return self._friction_use_output
