"""Array types and small numerical functions that belong to no other subject."""

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
"""Array of floats; docstrings state shape and unit."""

Indices = npt.NDArray[np.int_]
Mask = npt.NDArray[np.bool_]
Texts = npt.NDArray[np.str_]
