"""Why a simulation ended: the values of `end` in a summary.

Where a solver or a run of a study failed, the end is the text of the error.
"""

COMPLETED = "completed"
"""The walker was up for the whole duration."""

FELL = "fell"
"""The pelvis sank below `humanwalk.run.monitor.FALL_HEIGHT_SHARE` of its height at the start."""

NOT_A_NUMBER = "not a number"
"""The state was not finite."""

INTERRUPTED = "interrupted"
"""Ctrl-C or another signal, or the loss of the live picture, ended the simulation."""

UNFINISHED = "unfinished"
"""A checkpoint of a simulation that had not ended; a program that is killed leaves it."""

CUT_SHORT = (INTERRUPTED, UNFINISHED)
"""The walker was up, and could have walked on."""

UP_AT_ITS_END = (COMPLETED, *CUT_SHORT)
"""The walker was up in the last sample."""
