"""The types of arrays that signatures name."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
"""Numbers; the shape and the unit stand in the docstring."""
Mask = NDArray[np.bool_]
"""Truth values, one for each sample or element."""
Index = NDArray[np.int64]
"""Positions in another array."""
