//! One run, shared by the threads of Python.

use std::path::PathBuf;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

use glam::DVec3;
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use parking_lot::Mutex;
use peristalsis_configuration::ScheduledParameter;
use peristalsis_engine::{Bodies, Instructions, processors};
use peristalsis_observe::View;
use peristalsis_run::{
    PlacedGrains, RunError, RunFolder, Status, Summary, profile_table, read_state,
    timeseries_table, waves_table, write_state,
};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use pythonize::pythonize;

use crate::configuration::Configuration;
use crate::error::{ConfigurationError, DivergedError, in_words, of_run};
use crate::heard::EACH_LOOK;
use crate::table::{Table, read_only};

/// A simulation with what was measured of it, behind a lock that is fair: who looks at it while another thread advances
/// it sees a whole step, and soon.
#[pyclass(frozen, module = "peristalsis._core")]
pub(crate) struct Run {
    run: Mutex<peristalsis_run::Run>,
    /// In words, once it has diverged: it goes no further.
    divergence: OnceLock<String>,
}

impl Run {
    /// One that has diverged goes no further.
    fn check_divergence(&self) -> PyResult<()> {
        let words = self.divergence.get();
        words.map_or(Ok(()), |words| Err(DivergedError::new_err(words.clone())))
    }

    fn of(run: peristalsis_run::Run) -> Self {
        Self {
            run: Mutex::new(run),
            divergence: OnceLock::new(),
        }
    }

    /// Looks at the run, without the interpreter.
    pub(crate) fn look<T: Send>(
        &self,
        py: Python<'_>,
        look: impl FnOnce(&mut peristalsis_run::Run) -> T + Send,
    ) -> T {
        py.detach(|| look(&mut self.run.lock()))
    }

    /// A quantity of each grain.
    fn of_grains<T: Clone + Send>(
        &self,
        py: Python<'_>,
        quantity: impl FnOnce(&Bodies) -> &[T] + Send,
    ) -> Vec<T> {
        self.look(py, |run| {
            let bodies = run.simulation().bodies();
            quantity(bodies)[..bodies.grains].to_vec()
        })
    }
}

/// Vectors as an array of shape (N, 3).
pub(crate) fn vectors<'py>(
    py: Python<'py>,
    vectors: impl IntoIterator<Item = DVec3>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let flat: Vec<f64> = vectors.into_iter().flat_map(|it| it.to_array()).collect();
    let number = flat.len() / 3;
    let array = PyArray1::from_vec(py, flat).reshape([number, 3])?;
    array.readwrite().make_nonwriteable();
    Ok(array)
}

/// The rows of an array of shape (N, 3).
fn rows(array: &PyReadonlyArray2<'_, f64>) -> Vec<DVec3> {
    let rows = array.as_array();
    let rows = rows.outer_iter();
    rows.map(|row| DVec3::new(row[0], row[1], row[2])).collect()
}

/// How a run stands. In Python one that may go on has not been interrupted.
#[derive(serde::Serialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Standing {
    /// At its end.
    Complete,
    /// Ended before by its own rule.
    Settled,
    /// It may go on.
    Running,
    /// A grain moved too far in one step.
    Diverged,
}

impl From<Status> for Standing {
    fn from(status: Status) -> Self {
        match status {
            Status::Complete => Self::Complete,
            Status::Settled => Self::Settled,
            Status::Interrupted => Self::Running,
            Status::Diverged => Self::Diverged,
        }
    }
}

/// A parameter of the drive by its name.
fn scheduled(name: &str) -> PyResult<ScheduledParameter> {
    match name {
        "width" => Ok(ScheduledParameter::Width),
        "force_amplitude" => Ok(ScheduledParameter::ForceAmplitude),
        "strain_rate" => Ok(ScheduledParameter::StrainRate),
        _ => Err(ConfigurationError::new_err(format!(
            "{name} cannot change during a run; width, force_amplitude and strain_rate can"
        ))),
    }
}

#[pymethods]
impl Run {
    /// Packs the grains.
    #[new]
    fn new(py: Python<'_>, configuration: &Configuration) -> PyResult<Self> {
        let configuration = configuration.inner.clone();
        let raised = Mutex::new((Instant::now(), None));
        // Packing asks often: a signal is looked for from time to time.
        let stop = || {
            let (looked, raised) = &mut *raised.lock();
            if raised.is_none() && looked.elapsed() > EACH_LOOK {
                *looked = Instant::now();
                *raised = Python::attach(|py| py.check_signals()).err();
            }
            raised.is_some()
        };
        let run = py.detach(|| peristalsis_run::Run::new_unless(configuration, &stop));
        match raised.into_inner().1 {
            Some(error) => Err(error),
            None => run.map(Self::of).map_err(of_run),
        }
    }

    /// Puts grains where the caller wants them.
    #[staticmethod]
    fn placed(
        py: Python<'_>,
        configuration: &Configuration,
        positions: PyReadonlyArray2<'_, f64>,
        velocities: PyReadonlyArray2<'_, f64>,
        diameters: PyReadonlyArray1<'_, f64>,
    ) -> PyResult<Self> {
        let configuration = configuration.inner.clone();
        let grains = PlacedGrains {
            positions: rows(&positions),
            velocities: rows(&velocities),
            diameters: diameters.as_array().to_vec(),
        };
        let run = py.detach(|| peristalsis_run::Run::placed(configuration, grains));
        run.map(Self::of).map_err(of_run)
    }

    /// Goes on from the folder of a run, or from the file of a state.
    #[staticmethod]
    fn open(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let run = py.detach(|| match path.is_dir() {
            true => RunFolder::open(&path).map(|(_, run)| run),
            false => read_state(&path),
        });
        run.map(Self::of).map_err(of_run)
    }

    /// Goes on from the bytes of a snapshot; of one that has diverged the words of that may be said.
    #[staticmethod]
    #[pyo3(signature = (bytes, divergence=None))]
    fn from_bytes(py: Python<'_>, bytes: &[u8], divergence: Option<String>) -> PyResult<Self> {
        let run = py.detach(|| peristalsis_run::Run::from_snapshot(bytes));
        let divergence = divergence.map(OnceLock::from).unwrap_or_default();
        run.map(|run| Self {
            divergence,
            ..Self::of(run)
        })
        .map_err(of_run)
    }

    /// Configuration and state.
    fn to_bytes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = self.look(py, |run| run.to_snapshot()).map_err(of_run)?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// Writes configuration and state to a file, whole or not at all.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        self.look(py, |run| write_state(run, &path)).map_err(of_run)
    }

    /// A run that goes on by itself from here.
    fn copy(&self, py: Python<'_>) -> Self {
        let divergence = self.divergence.clone();
        let run = Self::of(self.look(py, |run| run.clone()));
        Self { divergence, ..run }
    }

    /// How it diverged, in words, where it has.
    #[getter]
    fn divergence(&self) -> Option<String> {
        self.divergence.get().cloned()
    }

    /// Advances by `steps` steps, or until so many seconds are over; answers the steps done.
    fn advance(&self, py: Python<'_>, steps: u64, seconds: f64) -> PyResult<u64> {
        self.check_divergence()?;
        let limit = Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX);
        self.look(py, |run| {
            let (begin, first) = (Instant::now(), run.simulation().step());
            let mut piece = 8;
            loop {
                let done = run.simulation().step() - first;
                if done >= steps || begin.elapsed() >= limit {
                    return Ok(done);
                }
                run.advance_at_most(piece.min(steps - done))?;
                // Short pieces at first, so that the limit holds for large tubes as well.
                piece = piece.saturating_mul(2);
            }
        })
        .map_err(|error: RunError| {
            if error.against_divergence().is_some() {
                self.divergence.get_or_init(|| in_words(&error));
            }
            of_run(error)
        })
    }

    /// Leads a parameter of the drive to a value within so many periods; within 0 it jumps there with the next step.
    fn drive_to(&self, py: Python<'_>, name: &str, value: f64, periods: f64) -> PyResult<()> {
        self.check_divergence()?;
        let parameter = scheduled(name)?;
        self.look(py, |run| run.drive_to(parameter, value, periods))
            .map_err(of_run)
    }

    /// Whether a parameter of the drive could be led to a value.
    fn check_drive(&self, py: Python<'_>, name: &str, value: f64) -> PyResult<()> {
        self.check_divergence()?;
        let parameter = scheduled(name)?;
        let checked = self.look(py, |run| run.check_drive(parameter, value).map(drop));
        checked.map_err(of_run)
    }

    /// Value of a parameter of the drive for the next step; `None` where there is no such parameter.
    fn driven(&self, py: Python<'_>, name: &str) -> PyResult<Option<f64>> {
        let parameter = scheduled(name)?;
        Ok(self.look(py, |run| run.driven(parameter)))
    }

    /// Time until the wave has run so many wavelengths more; `None` where it never does.
    fn time_of_periods(&self, py: Python<'_>, periods: f64) -> Option<f64> {
        self.look(py, |run| run.time_of_periods(periods))
    }

    /// Computes with so many threads from now on; without a number with as many as pay.
    fn compute_with(&self, py: Python<'_>, threads: Option<usize>) -> PyResult<()> {
        let outcome = self.look(py, |run| match threads {
            Some(threads) => run.compute_with(Instructions::widest(), threads),
            None => run.compute_with_threads_that_pay(processors()),
        });
        outcome.map_err(of_run)
    }

    /// What looks doubtful about the configuration and what was seen, as (key, message).
    fn warnings(&self, py: Python<'_>) -> Vec<(&'static str, String)> {
        let warnings = self.look(py, |run| run.warnings()).into_iter();
        warnings.map(|it| (it.key, it.message)).collect()
    }

    /// Grains outside the tube.
    #[getter]
    fn escaped(&self, py: Python<'_>) -> usize {
        self.look(py, |run| View::of(run.simulation()).escaped())
    }

    /// Largest overlap of a grain's contact at any step.
    #[getter]
    fn largest_overlap(&self, py: Python<'_>) -> f64 {
        self.look(py, |run| run.simulation().ledger().largest_overlap)
    }

    /// The configuration, changes of the drive included.
    #[getter]
    fn configuration(&self, py: Python<'_>) -> Configuration {
        let inner = self.look(py, |run| run.configuration().clone());
        Configuration { inner }
    }

    /// Centres of the grains.
    #[getter]
    fn positions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        vectors(py, self.of_grains(py, |bodies| &bodies.position))
    }

    /// Velocities of the grains.
    #[getter]
    fn velocities<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        vectors(py, self.of_grains(py, |bodies| &bodies.velocity))
    }

    /// Angular velocities of the grains.
    #[getter]
    fn angular_velocities<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        vectors(py, self.of_grains(py, |bodies| &bodies.angular_velocity))
    }

    /// Centres of the wall's spheres.
    #[getter]
    fn wall_positions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let positions: Vec<DVec3> = self.look(py, |run| {
            let bodies = run.simulation().bodies();
            let prescribed = run.simulation().wall().prescribed_spheres();
            let prescribed = prescribed.map(|sphere| sphere.position);
            let mobile = bodies.position[bodies.grains..].iter().copied();
            mobile.chain(prescribed).collect()
        });
        vectors(py, positions)
    }

    /// Diameters of the grains.
    #[getter]
    fn diameters<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        read_only(py, self.of_grains(py, |bodies| &bodies.diameter))
    }

    /// Turns of the grains round the tube.
    #[getter]
    fn turns<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i32>> {
        read_only(py, self.of_grains(py, |bodies| &bodies.turns))
    }

    /// Steps done.
    #[getter]
    fn steps(&self, py: Python<'_>) -> u64 {
        self.look(py, |run| run.simulation().step())
    }

    /// Steps from one sample to the next.
    #[getter]
    fn steps_per_sample(&self, py: Python<'_>) -> u64 {
        self.look(py, |run| run.configuration().run.steps_per_sample)
    }

    /// Time since the start.
    #[getter]
    fn time(&self, py: Python<'_>) -> f64 {
        self.look(py, |run| run.simulation().time())
    }

    /// Wavelengths that the wave has run.
    #[getter]
    fn period(&self, py: Python<'_>) -> f64 {
        self.look(py, |run| run.simulation().wall().cycles())
    }

    /// Length of the tube, of an open one between its ends.
    #[getter]
    fn length(&self, py: Python<'_>) -> f64 {
        self.look(py, |run| run.simulation().length())
    }

    /// +1 where the wave runs towards +z, -1 where towards -z.
    #[getter]
    fn heading(&self, py: Python<'_>) -> f64 {
        self.look(py, |run| run.simulation().wall().heading())
    }

    /// J/Jmax of the last whole period, or of the last sample before there is one.
    #[getter]
    fn flow_rate_ratio(&self, py: Python<'_>) -> f64 {
        self.look(py, |run| run.progress().flow_rate_ratio)
    }

    /// Time of the transition, if it has been found.
    #[getter]
    fn transition_time(&self, py: Python<'_>) -> Option<f64> {
        self.look(py, |run| run.recorder().transition_time())
    }

    /// Where energy is, where it came from and where it went.
    #[getter]
    fn energy_ledger<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (ledger, now) = self.look(py, |run| {
            let simulation = run.simulation();
            let (bodies, tally) = (simulation.bodies(), simulation.tally());
            let wall = bodies.grains..bodies.number();
            let now = [
                ("kinetic_energy", bodies.kinetic_energy(0..bodies.grains)),
                ("rotational_energy", bodies.rotational_energy()),
                ("wall_kinetic_energy", bodies.kinetic_energy(wall)),
                ("potential_energy", tally.potential_energy()),
                ("energy", simulation.energy()),
                ("energy_residual", simulation.energy_residual()),
            ];
            (*simulation.ledger(), now)
        });
        let answer = pythonize(py, &ledger)?.cast_into::<PyDict>()?;
        answer.del_item("initial_moment")?;
        for (name, value) in now {
            answer.set_item(name, value)?;
        }
        Ok(answer)
    }

    /// The time series so far.
    fn timeseries(&self, py: Python<'_>) -> PyResult<Table> {
        Table::made(self.look(py, |run| timeseries_table(run)))
    }

    /// The late profile in the wave frame.
    fn profile(&self, py: Python<'_>) -> PyResult<Table> {
        Table::made(self.look(py, |run| profile_table(run)))
    }

    /// The flow of each wave over each period.
    fn waves(&self, py: Python<'_>) -> PyResult<Table> {
        Table::made(self.look(py, |run| waves_table(run)))
    }

    /// The outcome so far.
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let divergence = self.divergence();
        let summary = self.look(py, |run| {
            let status = match (&divergence, run.is_complete()) {
                (Some(_), _) => Status::Diverged,
                (None, true) => Status::Complete,
                (None, false) => Status::Interrupted,
            };
            Summary::of(run, status, divergence)
        });
        let standing = Standing::from(summary.status);
        let summary = pythonize(py, &summary)?;
        summary.set_item("status", pythonize(py, &standing)?)?;
        Ok(summary)
    }
}
