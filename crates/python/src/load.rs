//! What the grains of a run bear, and the shape of the tube about them.

use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1};
use peristalsis_observe::{Load, TubeShape, clear_volume};
use peristalsis_run::contacts_table;
use pyo3::prelude::*;

use crate::run::{Run, vectors};
use crate::table::{Table, read_only};

/// The contacts of the grains, one a row.
#[pyfunction]
pub(crate) fn contacts(py: Python<'_>, run: &Run) -> PyResult<Table> {
    Table::made(run.look(py, |run| contacts_table(run)))
}

/// Forces, torques (both of shape (N, 3)) and stress (shape (3, 3)).
#[pyfunction]
#[allow(
    clippy::type_complexity,
    reason = "three arrays, as Python unpacks them"
)]
pub(crate) fn load<'py>(
    py: Python<'py>,
    run: &Run,
) -> PyResult<(
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
)> {
    let load = run.look(py, |run| Load::of(run.simulation()));
    let rows = load
        .stress
        .transpose()
        .to_cols_array_2d()
        .map(glam::DVec3::from);
    Ok((
        vectors(py, load.forces)?,
        vectors(py, load.torques)?,
        vectors(py, rows)?,
    ))
}

/// Volume that the wall leaves clear.
#[pyfunction]
pub(crate) fn volume(py: Python<'_>, run: &Run) -> f64 {
    run.look(py, |run| clear_volume(run.simulation()))
}

/// The tube's radius at places along it, to the centres of the wall's spheres.
#[pyfunction]
pub(crate) fn wall_radius<'py>(
    py: Python<'py>,
    run: &Run,
    places: PyReadonlyArray1<'py, f64>,
) -> Bound<'py, PyArray1<f64>> {
    let places = places.as_array().to_vec();
    let radii = run.look(py, |run| {
        let simulation = run.simulation();
        let (shape, length) = (TubeShape::of(simulation), simulation.wall().length());
        let radius = |z: f64| shape.radius(z.rem_euclid(length));
        places.into_iter().map(radius).collect()
    });
    let radii = read_only(py, radii);
    // A new array, which belongs to the caller.
    PyArray1::from_vec(py, radii.to_vec().unwrap_or_default())
}
