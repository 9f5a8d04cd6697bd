"""Small numerical tools without a subject of their own, and the array types."""

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
"""Array of numbers; docstrings give shape and unit."""

Indices = npt.NDArray[np.int_]
Mask = npt.NDArray[np.bool_]
