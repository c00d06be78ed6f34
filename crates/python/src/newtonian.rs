//! The Newtonian reference, point by point over arrays.

use numpy::{AllowTypeChange, IntoPyArray, PyArray1, PyArrayDyn, PyArrayLikeDyn, PyReadonlyArray1};
use peristalsis_physics::newtonian::{NewtonianPeristalsis, trapping_threshold};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyType;

/// Peristaltic flow of a Newtonian fluid at one amplitude and one pressure rise.
///
/// A long sine wave without inertia: Shapiro, Jaffrin & Weinberg, J. Fluid Mech. 37, 799 (1969), axisymmetric. Units: a
/// across, lambda along the tube, c, pi a^2 c for flow rates, 8 mu c lambda/a^2 for pressures.
///
/// Parameters
/// ----------
/// amplitude_ratio : float
///     phi = b/a, from 0 to 1.
/// pressure : float
///     P = a^2 Dp/(8 mu c lambda), the pressure rise over a wavelength.
///
/// Raises
/// ------
/// ValueError
///     For an amplitude ratio outside of its range, or a pressure that is not finite.
///
/// Examples
/// --------
/// >>> from peristalsis.newtonian import Newtonian
/// >>> Newtonian(1.0).flow_rate_ratio
/// 1.0
#[pyclass(frozen, eq, module = "peristalsis._core")]
#[derive(PartialEq)]
pub(crate) struct Newtonian {
    flow: NewtonianPeristalsis,
}

fn made(flow: Option<NewtonianPeristalsis>, range: &str) -> PyResult<Newtonian> {
    flow.map(|flow| Newtonian { flow })
        .ok_or_else(|| PyValueError::new_err(range.to_owned()))
}

const RANGE: &str = "the amplitude ratio phi = b/a is from 0 to 1, and the pressure finite";

#[pymethods]
impl Newtonian {
    #[new]
    #[pyo3(signature = (amplitude_ratio, pressure=0.0))]
    fn new(amplitude_ratio: f64, pressure: f64) -> PyResult<Self> {
        made(NewtonianPeristalsis::new(amplitude_ratio, pressure), RANGE)
    }

    /// The fluid in a tube whose bottleneck has a width: phi = 1 - w/(2 a).
    ///
    /// Parameters
    /// ----------
    /// width : float
    ///     w, from 0 to 2 a, in the unit of `radius`.
    /// radius : float
    ///     a.
    /// pressure : float
    ///     P, the pressure rise over a wavelength [8 mu c lambda/a^2].
    ///
    /// Returns
    /// -------
    /// Newtonian
    ///     The flow.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     For a width outside of 0 to 2 a, or a pressure that is not finite.
    ///
    /// Examples
    /// --------
    /// >>> from peristalsis.newtonian import Newtonian
    /// >>> Newtonian.from_width(1.5, 1.5).amplitude_ratio
    /// 0.5
    #[staticmethod]
    #[pyo3(signature = (width, radius, pressure=0.0))]
    fn from_width(width: f64, radius: f64, pressure: f64) -> PyResult<Self> {
        let flow = NewtonianPeristalsis::from_width(width, radius, pressure);
        let reason = if !(radius > 0.0 && radius.is_finite()) {
            format!("the radius is a finite number above 0, not {radius}")
        } else if !pressure.is_finite() {
            format!("the pressure is finite, not {pressure}")
        } else {
            format!("the width is from 0 to 2 a = {}, not {width}", 2.0 * radius)
        };
        made(flow, &reason)
    }

    /// The fluid that flows at a given mean rate: the inverse of `flow_rate`.
    ///
    /// Parameters
    /// ----------
    /// amplitude_ratio : float
    ///     phi, from 0 to below 1.
    /// flow_rate : float
    ///     Q [pi a^2 c].
    ///
    /// Returns
    /// -------
    /// Newtonian
    ///     The flow, with the pressure rise that it takes.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     For an amplitude ratio outside of its range, or a flow rate that is not finite.
    ///
    /// Examples
    /// --------
    /// >>> from peristalsis.newtonian import Newtonian
    /// >>> flow = Newtonian(0.5, 0.1)
    /// >>> round(Newtonian.from_flow_rate(0.5, flow.flow_rate).pressure, 12)
    /// 0.1
    #[staticmethod]
    fn from_flow_rate(amplitude_ratio: f64, flow_rate: f64) -> PyResult<Self> {
        let flow = NewtonianPeristalsis::from_flow_rate(amplitude_ratio, flow_rate);
        let range = "the amplitude ratio is from 0 to below 1, and the flow rate finite";
        made(flow, range)
    }

    /// phi = b/a, from 0 to 1.
    ///
    /// Examples
    /// --------
    /// >>> from peristalsis.newtonian import Newtonian
    /// >>> Newtonian(0.5).amplitude_ratio
    /// 0.5
    #[getter]
    fn amplitude_ratio(&self) -> f64 {
        self.flow.amplitude_ratio()
    }

    /// P = a^2 Dp/(8 mu c lambda), pressure rise over a wavelength; the wave pumps against a positive one.
    ///
    /// Examples
    /// --------
    /// >>> from peristalsis.newtonian import Newtonian
    /// >>> Newtonian(0.5, 0.1).pressure
    /// 0.1
    #[getter]
    fn pressure(&self) -> f64 {
        self.flow.pressure()
    }

    /// Mean flow rate Q [pi a^2 c], positive along the wave.
    ///
    /// Q = 1 + phi^2/2 + q with the flow in the wave frame q = -[(1 - phi^2)^2 + P (1 - phi^2)^(7/2)]/(1 + 3 phi^2/2).
    ///
    /// Examples
    /// --------
    /// >>> from peristalsis.newtonian import Newtonian
    /// >>> round(Newtonian(0.5).flow_rate, 6)
    /// 0.715909
    #[getter]
    fn flow_rate(&self) -> f64 {
        self.flow.flow_rate()
    }

    /// J/Jmax = Q/(1 + phi^2/2): 1 where the fluid travels with the wave as a whole.
    ///
    /// Examples
    /// --------
    /// >>> from peristalsis.newtonian import Newtonian
    /// >>> Newtonian(1.0).flow_rate_ratio
    /// 1.0
    #[getter]
    fn flow_rate_ratio(&self) -> f64 {
        self.flow.flow_rate_ratio()
    }

    /// Pressure rise at which the mean flow vanishes, phi^2 (16 - phi^2)/(4 (1 - phi^2)^(7/2)) [8 mu c lambda/a^2].
    ///
    /// Infinite at phi = 1, where the closed throat holds any pressure.
    ///
    /// Examples
    /// --------
    /// >>> from peristalsis.newtonian import Newtonian
    /// >>> flow = Newtonian(0.5)
    /// >>> round(Newtonian(0.5, flow.zero_flow_pressure).flow_rate, 9) == 0
    /// True
    #[getter]
    fn zero_flow_pressure(&self) -> f64 {
        self.flow.zero_flow_pressure()
    }

    /// Mean flow rate without a pressure rise [pi a^2 c], phi^2 (16 - phi^2)/(2 (2 + 3 phi^2)).
    ///
    /// Examples
    /// --------
    /// >>> from peristalsis.newtonian import Newtonian
    /// >>> round(Newtonian(0.5, 0.1).free_pumping_flow_rate, 6), round(Newtonian(0.5).flow_rate, 6)
    /// (0.715909, 0.715909)
    #[getter]
    fn free_pumping_flow_rate(&self) -> f64 {
        self.flow.free_pumping_flow_rate()
    }

    /// Useful power Q P over the wall's power, from 0 to 1; `None` where the wave does not pump (unless P > 0 and Q > 0).
    ///
    /// Examples
    /// --------
    /// >>> from peristalsis.newtonian import Newtonian
    /// >>> 0 < Newtonian(0.5, 0.1).efficiency < 1
    /// True
    #[getter]
    fn efficiency(&self) -> Option<f64> {
        self.flow.efficiency()
    }

    /// Mean power of the wall on the fluid of a wavelength [8 pi mu c^2 lambda], P (1 + phi^2/2) + 1 + q (1 - phi^2)^(-3/2).
    ///
    /// Examples
    /// --------
    /// >>> from peristalsis.newtonian import Newtonian
    /// >>> Newtonian(0.5).wall_power > 0
    /// True
    #[getter]
    fn wall_power(&self) -> f64 {
        self.flow.wall_power()
    }

    /// Volume fraction of the fluid in a trapped bolus, which travels with the wave: 0 without one.
    ///
    /// Examples
    /// --------
    /// >>> from peristalsis.newtonian import Newtonian
    /// >>> Newtonian(0.2).trapped_volume_fraction, Newtonian(0.6).trapped_volume_fraction > 0
    /// (0.0, True)
    #[getter]
    fn trapped_volume_fraction(&self) -> f64 {
        self.flow.trapping().map_or(0.0, |(_, volume)| volume)
    }

    /// Volume fraction of the fluid near the wall that moves back on average: 0 without any.
    ///
    /// Examples
    /// --------
    /// >>> from peristalsis.newtonian import Newtonian
    /// >>> Newtonian(0.5, 0.3).reflux_volume_fraction > Newtonian(0.5).reflux_volume_fraction
    /// True
    #[getter]
    fn reflux_volume_fraction(&self) -> f64 {
        let layer = self.flow.reflux();
        layer.map_or(0.0, |layer| layer.volume_fraction)
    }

    /// Radius of the wall [a], 1 + phi sin(2 pi x).
    ///
    /// Parameters
    /// ----------
    /// position : ndarray
    ///     x = (z - c t)/lambda, shape (n,), float64: the belly is at 1/4, the throat at 3/4.
    ///
    /// Returns
    /// -------
    /// ndarray
    ///     In the shape of position.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np
    /// >>> from peristalsis.newtonian import Newtonian
    /// >>> Newtonian(0.5).wall_radius(np.array([0.25, 0.75])).tolist()
    /// [1.5, 0.5]
    fn wall_radius<'py>(
        &self,
        py: Python<'py>,
        position: PyArrayLikeDyn<'py, f64, AllowTypeChange>,
    ) -> Bound<'py, PyArrayDyn<f64>> {
        along(py, &position, |position| self.flow.wall_radius(position))
    }

    /// Pressure along the wave less that at x = 0 [8 mu c lambda/a^2].
    ///
    /// Parameters
    /// ----------
    /// position : array_like
    ///     x = (z - c t)/lambda.
    ///
    /// Returns
    /// -------
    /// ndarray
    ///     In the shape of position.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np
    /// >>> from peristalsis.newtonian import Newtonian
    /// >>> Newtonian(0.5, 0.1).pressure_along_wave(np.array([0.0, 1.0])).round(6).tolist()
    /// [0.0, 0.1]
    fn pressure_along_wave<'py>(
        &self,
        py: Python<'py>,
        position: PyArrayLikeDyn<'py, f64, AllowTypeChange>,
    ) -> Bound<'py, PyArrayDyn<f64>> {
        along(py, &position, |position| {
            self.flow.pressure_along_wave(position)
        })
    }

    /// Axial and radial velocity in the laboratory, and the stream function in the frame of the wave, point by point;
    /// `field` of the module broadcasts.
    ///
    /// Parameters
    /// ----------
    /// radius : ndarray
    ///     r [a], shape (n,), float64.
    /// position : ndarray
    ///     x = (z - c t)/lambda from the mean radius before the belly, shape (n,), float64: the belly is at 1/4, the throat at
    ///     3/4. In profiles of simulations a sine has its throat at 1/4: they are half a wavelength apart.
    ///
    /// Returns
    /// -------
    /// list of ndarray
    ///     Axial velocity [c], radial velocity [c a/lambda] and stream function [c a^2], each of shape (n,); NaN beyond the
    ///     wall.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     For arrays of unequal length.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np
    /// >>> from peristalsis.newtonian import Newtonian
    /// >>> axial, radial, stream = Newtonian(0.5).field(np.array([0.0]), np.array([0.25]))
    /// >>> bool(axial[0] > 0)
    /// True
    fn field<'py>(
        &self,
        py: Python<'py>,
        radius: PyReadonlyArray1<'py, f64>,
        position: PyArrayLikeDyn<'py, f64, AllowTypeChange>,
    ) -> PyResult<[Bound<'py, PyArray1<f64>>; 3]> {
        let (radius, position) = (radius.as_slice()?, position.as_slice()?);
        if radius.len() != position.len() {
            let (radii, positions) = (radius.len(), position.len());
            let reason = format!("{radii} radii, but {positions} positions");
            return Err(PyValueError::new_err(reason));
        }
        let each = |value: &dyn Fn(f64, f64) -> f64| {
            let values = radius.iter().zip(position).map(|(&r, &x)| {
                // Up to rounding the wall itself is within.
                let is_within = r.abs() <= self.flow.wall_radius(x) * (1.0 + 4.0 * f64::EPSILON);
                if is_within { value(r, x) } else { f64::NAN }
            });
            PyArray1::from_iter(py, values)
        };
        Ok([
            each(&|r, x| self.flow.axial_velocity(r, x)),
            each(&|r, x| self.flow.radial_velocity(r, x)),
            each(&|r, x| self.flow.stream_function(r, x)),
        ])
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> (Bound<'py, PyType>, (f64, f64)) {
        let flow = &slf.get().flow;
        (slf.get_type(), (flow.amplitude_ratio(), flow.pressure()))
    }

    fn __repr__(&self) -> String {
        let (amplitude_ratio, pressure) = (self.amplitude_ratio(), self.pressure());
        format!("Newtonian(amplitude_ratio={amplitude_ratio:?}, pressure={pressure:?})")
    }
}

/// A quantity at each position.
fn along<'py>(
    py: Python<'py>,
    position: &PyArrayLikeDyn<'py, f64, AllowTypeChange>,
    quantity: impl Fn(f64) -> f64,
) -> Bound<'py, PyArrayDyn<f64>> {
    position.as_array().mapv(quantity).into_pyarray(py)
}

/// Amplitude ratio from which on a bolus is trapped at a pressure rise.
///
/// Parameters
/// ----------
/// pressure : float
///     P = a^2 Dp/(8 mu c lambda).
///
/// Returns
/// -------
/// float or None
///     phi; `None` where no amplitude traps one.
///
/// Raises
/// ------
/// ValueError
///     For a pressure that is not finite.
///
/// Examples
/// --------
/// >>> from peristalsis import newtonian
/// >>> round(newtonian.trapping_threshold(), 6) == round(4 - 14**0.5, 6)
/// True
#[pyfunction(name = "trapping_threshold")]
#[pyo3(signature = (pressure=0.0))]
pub(crate) fn trapping_threshold_at(pressure: f64) -> PyResult<Option<f64>> {
    if !pressure.is_finite() {
        let reason = format!("the pressure is finite, not {pressure}");
        return Err(PyValueError::new_err(reason));
    }
    Ok(trapping_threshold(pressure))
}
