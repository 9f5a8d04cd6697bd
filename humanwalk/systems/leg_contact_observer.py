"""LeafSystem: force between the legs."""

import numpy as np
from pydrake.common.value import Value
from pydrake.multibody.plant import ContactResults, MultibodyPlant
from pydrake.systems.framework import BasicVector, Context, LeafSystem

from humanwalk.body.limbs import LEGS
from humanwalk.systems.signal import Signal


class LegContactObserver(LeafSystem):
    """Sums the contacts between the capsules of both legs (`contact/leg_contact.py`), which are point contacts.

    Inputs:
        contact_results: the plant's ContactResults.

    Outputs:
        leg_contact: (1) magnitude of the force of one leg on the other [N].
    """

    def __init__(self, plant: MultibodyPlant) -> None:
        """Initialize the observer of a finalized plant."""
        super().__init__()
        self._leg = {
            plant.GetBodyByName(body).index(): sign
            for sign, leg in zip((1.0, -1.0), LEGS.values(), strict=True)
            for body in leg.touching_bodies
        }
        contacts = self.DeclareAbstractInputPort("contact_results", Value(ContactResults()))
        force = self.DeclareVectorOutputPort("leg_contact", 1, self._calc_force, {contacts.ticket()})
        self.signals = [Signal("leg_contact", force, ("leg_contact.force_N",))]

    def _calc_force(self, context: Context, output: BasicVector) -> None:
        results, total = self.GetInputPort("contact_results").Eval(context), np.zeros(3)
        for i in range(results.num_point_pair_contacts()):
            pair = results.point_pair_contact_info(i)
            # The force is that on B.
            A, B = (self._leg.get(body, 0.0) for body in (pair.bodyA_index(), pair.bodyB_index()))
            if A * B < 0.0:
                total += B * pair.contact_force()
        output.SetAtIndex(0, float(np.linalg.norm(total)))
