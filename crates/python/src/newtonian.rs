//! The Newtonian reference, point by point over arrays.

use numpy::{PyArray1, PyReadonlyArray1};
use peristalsis_physics::newtonian::{NewtonianPeristalsis, Trapping, trapping_threshold};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Peristaltic flow of a Newtonian fluid at one amplitude and one pressure rise.
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

    #[staticmethod]
    #[pyo3(signature = (width, radius, pressure=0.0))]
    fn from_width(width: f64, radius: f64, pressure: f64) -> PyResult<Self> {
        let flow = NewtonianPeristalsis::from_width(width, radius, pressure);
        made(flow, "the width is from 0 to 2 a, and the pressure finite")
    }

    #[staticmethod]
    fn from_flow_rate(amplitude_ratio: f64, flow_rate: f64) -> PyResult<Self> {
        let flow = NewtonianPeristalsis::from_flow_rate(amplitude_ratio, flow_rate);
        let range = "the amplitude ratio is from 0 to below 1, and the flow rate finite";
        made(flow, range)
    }

    #[getter]
    fn amplitude_ratio(&self) -> f64 {
        self.flow.amplitude_ratio()
    }

    #[getter]
    fn pressure(&self) -> f64 {
        self.flow.pressure()
    }

    #[getter]
    fn flow_rate(&self) -> f64 {
        self.flow.flow_rate()
    }

    #[getter]
    fn flow_rate_ratio(&self) -> f64 {
        self.flow.flow_rate_ratio()
    }

    #[getter]
    fn zero_flow_pressure(&self) -> f64 {
        self.flow.zero_flow_pressure()
    }

    #[getter]
    fn free_pumping_flow_rate(&self) -> f64 {
        self.flow.free_pumping_flow_rate()
    }

    #[getter]
    fn efficiency(&self) -> Option<f64> {
        self.flow.efficiency()
    }

    #[getter]
    fn wall_power(&self) -> f64 {
        self.flow.wall_power()
    }

    /// Volume fraction of the trapped bolus: 0 without one.
    #[getter]
    fn trapped_volume_fraction(&self) -> f64 {
        match self.flow.trapping() {
            Trapping::Absent => 0.0,
            Trapping::Bolus(region) | Trapping::Ring(region) => region.volume_fraction,
        }
    }

    /// Volume fraction of the fluid near the wall that moves back on average: 0 without any.
    #[getter]
    fn reflux_volume_fraction(&self) -> f64 {
        let layer = self.flow.reflux();
        layer.map_or(0.0, |layer| layer.volume_fraction)
    }

    fn wall_radius<'py>(
        &self,
        py: Python<'py>,
        phase: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        along(py, &phase, |phase| self.flow.wall_radius(phase))
    }

    fn pressure_along_wave<'py>(
        &self,
        py: Python<'py>,
        phase: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        along(py, &phase, |phase| self.flow.pressure_along_wave(phase))
    }

    /// Axial and radial velocity and stream function at (radius, phase), which have the same length.
    fn field<'py>(
        &self,
        py: Python<'py>,
        radius: PyReadonlyArray1<'py, f64>,
        phase: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<[Bound<'py, PyArray1<f64>>; 3]> {
        let (radius, phase) = (radius.as_slice()?, phase.as_slice()?);
        let each = |value: &dyn Fn(f64, f64) -> f64| {
            let values = radius.iter().zip(phase).map(|(&r, &x)| value(r, x));
            PyArray1::from_iter(py, values)
        };
        Ok([
            each(&|r, x| self.flow.axial_velocity(r, x)),
            each(&|r, x| self.flow.radial_velocity(r, x)),
            each(&|r, x| self.flow.stream_function(r, x)),
        ])
    }
}

/// A quantity at each phase.
fn along<'py>(
    py: Python<'py>,
    phase: &PyReadonlyArray1<'py, f64>,
    quantity: impl Fn(f64) -> f64,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let phase = phase.as_slice()?;
    Ok(PyArray1::from_iter(py, phase.iter().copied().map(quantity)))
}

/// Amplitude ratio from which on a bolus is trapped at a pressure rise.
#[pyfunction(name = "trapping_threshold")]
#[pyo3(signature = (pressure=0.0))]
pub(crate) fn trapping_threshold_at(pressure: f64) -> Option<f64> {
    trapping_threshold(pressure)
}
