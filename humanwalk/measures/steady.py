"""Where the walk is steady: strides of a stop, a start or a change of speed are not compared with people's."""

import numpy as np
import pyarrow as pa

from humanwalk.choices.balanced import SETTLING
from humanwalk.measures.signals import TIME
from humanwalk.numerics import Mask
from humanwalk.scenario import Scenario
from humanwalk.walking.command import CommandProfile


def steady_rows(signals: pa.Table, scenario: Scenario) -> Mask:
    """Rows of a record in which the walk is steady, shape (rows,).

    The walk is steady from `Controller.steady_from` on. With a command, the commanded velocity must also be other than
    zero, and unchanged for SETTLING.
    """
    time, controller, subject = signals[TIME].to_numpy(), scenario.controller, scenario.subject
    begun: Mask = time >= controller.steady_from(subject)
    if controller.command is None:
        return begun
    forward, sideways, _ = CommandProfile(controller.command).over(time)
    velocity = forward + 1j * sideways
    changes = np.diff(velocity, prepend=velocity[:1]) != 0.0
    changed = np.maximum.accumulate(np.where(changes, time, -np.inf))
    steady: Mask = begun & (velocity != 0.0) & (time - changed >= subject.scale.time * SETTLING)
    return steady
