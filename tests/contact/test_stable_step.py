"""The largest step at which the implicit contact step is stable."""

import numpy as np
import pytest

from humanwalk.contact import contact_step
from humanwalk.contact.asperity import AsperityParameters
from humanwalk.contact.stable_step import MAX_STEP, largest_contact_step, patch_impedance

LAW = AsperityParameters()
AREA = np.full((1, 4), 0.015)
R = np.array([[[x, y, -0.05] for x in (-0.1, 0.1) for y in (-0.07, 0.07)]])
MASS = np.diag([0.03, 0.08, 0.1, 10.0, 10.0, 10.0])
"""Of a block of 10 kg, 0.3 x 0.2 x 0.1 m, on four points; the joint's velocities are its spatial velocity."""


def block_bound(stiffness: float, damping: float) -> float:
    K, C = (
        patch_impedance(R, AREA, np.eye(3), normal, tangential)
        for normal, tangential in ((stiffness, LAW.spring_stiffness), (damping, LAW.velocity_stiffness))
    )
    free = np.zeros(6)
    return largest_contact_step(MASS, np.eye(6), K, C, lambda h: (free, free), free)


def test_impedance_of_a_patch_is_that_of_its_area_at_its_points() -> None:
    K = patch_impedance(R, AREA, np.eye(3), 5e7, 2e7)
    np.testing.assert_allclose(K[3:, 3:], np.diag((2e7, 2e7, 5e7)) * 0.06)
    tilt = 5e7 * 0.06 * 0.07**2 + 2e7 * 0.06 * 0.05**2
    assert K[0, 0] == pytest.approx(tilt)
    np.testing.assert_allclose(K, K.T)


@pytest.mark.parametrize("stiffness", [5e7, 2e8])
def test_a_free_block_is_stable_at_every_step_that_is_allowed(stiffness: float) -> None:
    assert block_bound(stiffness, 4e5) == MAX_STEP


def test_with_a_mobility_far_too_small_the_step_is_bounded_as_an_explicit_one(monkeypatch: pytest.MonkeyPatch) -> None:
    """x' = x + h v', v' = v - h (C v + h C a + K x) / m with the velocity extrapolated: C h < m / 2 or so."""
    monkeypatch.setattr(contact_step, "MOBILITY_MARGIN", 1e-6)
    bound = block_bound(5e7, 4e5)
    heaviest = 10.0 / (0.06 * LAW.velocity_stiffness)
    assert 0.1 * heaviest < bound < heaviest
