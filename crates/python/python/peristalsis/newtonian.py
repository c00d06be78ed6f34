"""Newtonian peristalsis, the reference: Shapiro, Jaffrin & Weinberg, J. Fluid Mech. 37, 799 (1969), axisymmetric.

A viscous fluid in a tube with a long sine wave, without inertia. Radial lengths are in a, axial ones in lambda,
velocities in c, flow rates in pi a^2 c, pressures in 8 mu c lambda/a^2; x = (z - c t)/lambda has the belly at 1/4 and the
throat at 3/4.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ._arrays import Array
from ._core import Newtonian, trapping_threshold
from ._given import numeric

__all__ = ["Newtonian", "field", "flow_rate_ratio", "trapping_threshold"]


def __dir__() -> list[str]:
    return sorted(__all__)


def flow_rate_ratio(
    width: npt.ArrayLike, radius: float = 1.5, pressure: float = 0.0
) -> Array:
    """J/Jmax of a fluid against the width of the bottleneck, Q/(1 + phi^2/2) with phi = 1 - w/(2 a).

    Parameters
    ----------
    width : array_like
        w, in the unit of `radius`, from 0 to 2 a.
    radius : float
        a; 1.5 in the frictionless presets. For the clear bore between spheres of diameter d take w - d and a - d/2.
    pressure : float
        P = a^2 Dp/(8 mu c lambda).

    Returns
    -------
    ndarray
        Of the shape of `width`.

    Raises
    ------
    ValueError
        For a width outside of its range, or a pressure that is not finite.

    Examples
    --------
    >>> from peristalsis.newtonian import flow_rate_ratio
    >>> float(flow_rate_ratio(0.0))
    1.0
    """
    numeric("width", width)
    widths = np.asarray(width, dtype=np.float64)
    ratios = [Newtonian.from_width(w, radius, pressure).flow_rate_ratio for w in widths.flat]
    return np.array(ratios, dtype=np.float64).reshape(widths.shape)


def field(
    flow: Newtonian, radius: npt.ArrayLike, position: npt.ArrayLike
) -> tuple[Array, Array, Array]:
    """Axial and radial velocity in the laboratory, and the stream function in the frame of the wave.

    Parameters
    ----------
    flow : Newtonian
        The flow.
    radius, position : array_like
        r [a] and x = (z - c t)/lambda, broadcast against each other. The belly is at x = 1/4, the throat at 3/4. In
        profiles of simulations a sine has its throat at 1/4: they are half a wavelength apart.

    Returns
    -------
    tuple of ndarray
        Axial velocity [c], radial velocity [c a/lambda] and Stokes' stream function psi [c a^2], of the common shape; NaN
        beyond the wall, where there is no fluid. In the frame of the wave the flow is steady and follows lines of constant
        psi: d psi/dr = r (v_z - c).

    Examples
    --------
    >>> from peristalsis import newtonian
    >>> axial, radial, stream = newtonian.field(newtonian.Newtonian(0.5), [[0.0], [0.5]], [0.25, 0.75])
    >>> axial.shape
    (2, 2)
    """
    numeric("radius", radius)
    numeric("position", position)
    r, x = np.broadcast_arrays(
        np.asarray(radius, dtype=np.float64), np.asarray(position, dtype=np.float64)
    )
    axial, radial, stream = flow.field(np.ascontiguousarray(r).ravel(), np.ascontiguousarray(x).ravel())
    return axial.reshape(r.shape), radial.reshape(r.shape), stream.reshape(r.shape)
