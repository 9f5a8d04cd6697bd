"""Why a simulation ended: the values of `end` in a summary.

Where a solver or a run of a study failed, the end is the text of the error.
"""

COMPLETED = "completed"
"""It was up for the whole duration."""

FELL = "fell"

NOT_A_NUMBER = "not a number"
"""The state was not finite."""

INTERRUPTED = "interrupted"
"""A signal such as Ctrl-C, or the loss of the live picture, has ended it."""

UNFINISHED = "unfinished"
"""It had not ended: a checkpoint, which is what is left after kill -9."""

CUT_SHORT = (INTERRUPTED, UNFINISHED)
"""The walker was up, and could have walked on."""

UP_AT_ITS_END = (COMPLETED, *CUT_SHORT)
