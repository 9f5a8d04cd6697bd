"""Random numbers of a scenario: each noise has a stream of its own, so that a change of one leaves the others alone."""

from enum import Enum

import numpy as np


class RandomStream(Enum):
    """What is drawn from the seed of a scenario; a walk is repeatable only while the numbers stay."""

    START_ANGLES = 0
    START_RATES = 1
    ACTUATOR_GAINS = 2
    TASK_GAINS = 3
    KNOWLEDGE_ERRORS = 4
    PUSHES = 5

    def of(self, seed: int) -> np.random.Generator:
        """The stream's generator at its beginning."""
        return np.random.default_rng((seed, self.value))
