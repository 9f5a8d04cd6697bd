"""How often a running simulation is saved.

The help of the command line shows it, and does not wait for Drake: nothing is imported here.
"""

CHECKPOINT_PERIOD = 60.0
"""Wall-clock time between two checkpoints unless another is given [s] (our choice)."""
