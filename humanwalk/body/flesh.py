"""What gives way where a body touches something, for Drake's contact models."""

from dataclasses import dataclass

from humanwalk.quantity import quantity


@dataclass(frozen=True)
class Flesh:
    """Soles and legs of the reference human; they scale with the body (all our choice)."""

    sole_stiffness: float = quantity(2.0e5, "N/m", 1.0, 1e9)
    """Point-contact stiffness of one sphere of a sole: in quiet standing twelve spheres sink 0.3 mm into rigid ground.
    With the thesis' normal stiffness of 0 they would sink at 1.9 m/s (erratum E8)."""

    sole_modulus: float = quantity(4.0e7, "Pa", 1.0, 1e12)
    """Hydroelastic modulus of the soles: one of its spheres sinks 1.6 mm under 200 N and 2.2 mm under 400 N. On point
    contact it sinks 1.2 and 2.4 mm."""

    sole_dissipation: float = quantity(1.0, "s/m", 0.0, 1e3)
    """Hunt-Crossley dissipation of the soles, with all other approximations."""

    sole_relaxation_time: float = quantity(0.02, "s", 0.0, 10.0)
    """Relaxation time of the soles' linear damping with `contact_approximation: sap`."""

    leg_stiffness: float = quantity(2.0e4, "N/m", 1.0, 1e9)
    """Point-contact stiffness of a leg that touches the other one."""

    leg_dissipation: float = quantity(1.0, "s/m", 0.0, 1e3)
    """Hunt-Crossley dissipation of the legs."""

    ground_stiffness: float = quantity(1.0e6, "N/m", 1.0, 1e12)
    """Point-contact stiffness of the ground below a sole, in series with the sole's: Drake's default. It is one of the
    contact between both, and scales with the body as the sole's does."""

    ground_dissipation: float = quantity(50.0, "s/m", 0.0, 1e4)
    """Hunt-Crossley dissipation of the ground below a sole: Drake's default."""

    ground_relaxation_time: float = quantity(0.1, "s", 0.0, 10.0)
    """Relaxation time of the ground below a sole: Drake's default."""

    slip_speed: float = quantity(1e-4, "m/s", 1e-6, 1.0)
    """Speed of slip at which friction is as large as in sliding: Drake's default."""
