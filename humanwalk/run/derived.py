"""Signals that follow from others.

They are worked out after the simulation: a system of Python that is asked while it goes on costs several times as much.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from pydrake.systems.framework import Diagram, System

from humanwalk.numerics import Array
from humanwalk.systems.body_observer import BodyObserver
from humanwalk.systems.command_source import CommandSource
from humanwalk.systems.foot_force_observer import FootForceObserver, friction_used
from humanwalk.systems.gait_spline_source import GaitSplineSource
from humanwalk.systems.pd_actuator_bank import PdActuatorBank

WHEN = "time"
"""Stands for the times of the samples among what signals follow from."""

SAMPLES = ("sample", "sample_time", "previous_sample", "previous_sample_time")
"""Ports with the samples that a PdActuatorBank follows, in the order in which it takes them; some walkers have two."""


@dataclass(frozen=True)
class Derived:
    """What the systems behind some ports of a walker would have shown.

    Attributes:
        ports: the ports' names.
        needs: the signals that they follow from: names of other ports, recorded or derived before, or WHEN.
        calculate: from the records of these, shape (rows, size) each, times (rows,), to those of the ports.
    """

    ports: tuple[str, ...]
    needs: tuple[str, ...]
    calculate: Callable[..., tuple[Array, ...]]


def derived_signals(walker: Diagram) -> list[Derived]:
    """What follows from other exported ports of a walker or playback, in an order in which it can be worked out."""
    known = {walker.get_output_port(i).get_name() for i in range(walker.num_output_ports())} | {WHEN}
    every = (derived for system in walker.GetSystems() for derived in _of(system, walker))
    return [derived for derived in every if known.issuperset(derived.ports + derived.needs)]


def _of(system: System, walker: Diagram) -> Iterator[Derived]:
    if isinstance(system, BodyObserver):
        yield Derived(("soles", "com"), ("state",), system.motions)
    elif isinstance(system, FootForceObserver):
        yield Derived(("friction_use",), ("foot_forces",), lambda forces: (_each(friction_used, forces),))
    elif isinstance(system, GaitSplineSource):
        yield Derived(("phase",), (WHEN,), lambda time: (_each(system.phases, time),))
        yield Derived(("contact_schedule",), (WHEN,), lambda time: (_each(system.schedule, time),))
    elif isinstance(system, CommandSource):
        yield Derived(("command",), (WHEN,), lambda time: (_each(system.command, time),))
    elif isinstance(system, PdActuatorBank):
        samples = [port for port in SAMPLES if walker.HasOutputPort(port)]
        if samples:
            yield Derived(("desired_state",), (WHEN, *samples), lambda *inputs: (system.held_states(*inputs),))
        yield Derived(("torque",), ("net_actuation", "state"), lambda net, state: (system.felt_torque(net, state),))
        if system.law != "semi_implicit" or not system.limited:
            yield Derived(("saturated",), ("net_actuation",), lambda net: (system.at_limit(net),))
        # What is fed from outside is not known afterwards.
        elif walker.HasOutputPort("feedforward"):
            yield Derived(
                ("saturated",),
                ("state", "desired_state", "feedforward"),
                lambda *inputs: (system.at_limit(system.law_torque(*inputs)),),
            )


def _each(function: Callable[..., list[float]], rows: Array) -> Array:
    return np.array([function(row) for row in rows])
