"""Types of columns and runs, as the estimators take them."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
#: Times, and whether there was a transition.
Runs = tuple[Array, npt.NDArray[np.bool_]]
#: Widths with such runs.
RunTable = tuple[Array, Runs]
