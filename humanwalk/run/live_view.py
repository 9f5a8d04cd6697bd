"""The loss of a live view: Meshcat's thread ends at a message that it cannot read, which any web page may send."""

import time

from pydrake.geometry import Meshcat

SETTLE = 0.1
"""Time in which the thread logs why it ends [s]. It needs the interpreter for that, and does not end without."""


def is_lost(meshcat: Meshcat) -> bool:
    """Whether Meshcat's thread has ended; every call raises RuntimeError then."""
    try:
        meshcat.GetNumActiveConnections()
    except RuntimeError:
        time.sleep(SETTLE)
        return True
    return False
