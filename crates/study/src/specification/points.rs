//! The points of a study's axes, and the plan of their runs.

use peristalsis_configuration::document::Item;
use peristalsis_configuration::{ConfigurationError, InitialState, Problem, ProblemKind};

use super::{Choice, Specification, joined};
use crate::plan::{Plan, Point, Setting, SettingValue};

impl Specification {
    /// The runs of the study before refinement.
    ///
    /// # Errors
    /// Faults of the configurations of its points, and points that are the same.
    pub(super) fn planned(&self) -> Result<Plan, ConfigurationError> {
        let states = match &self.states {
            None => vec![None],
            Some(states) => states.iter().copied().map(Some).collect(),
        };
        let (mut points, mut errors) = (Vec::new(), Vec::new());
        for rows in self.grid() {
            let choice = self.choice(&rows);
            for state in &states {
                match self.point(&choice, &rows, *state) {
                    Ok(point) => points.push(point),
                    Err(error) => errors.push(error),
                }
            }
        }
        joined(errors)?;
        let mut plan = Plan::new(self.replicates, self.stopping, self.record.clone());
        plan.add(points);
        self.check_distinct(&plan)?;
        Ok(plan)
    }

    /// Refuses two points that are the same run.
    fn check_distinct(&self, plan: &Plan) -> Result<(), ConfigurationError> {
        let Some(twins) = plan.twins() else {
            return Ok(());
        };
        let [one, other] = twins.map(Point::in_words);
        let message = format!("two points of the axes are the same run: {one}; {other}");
        let mut problem = Problem::new(ProblemKind::Conflict, message)
            .key("axes")
            .help("an axis names a value once, and a key that changes something: not an amplitude that drive.schedule leads from t = 0 on, nor a run.time_step that becomes the same one, for a sample has a whole number of steps");
        for (place, axis) in self.axes.iter().enumerate() {
            let [one, other] = twins.map(|point| point.rows[place]);
            if one != other {
                let [one, other] = [one, other].map(|row| &axis.rows[row][0].origin);
                problem = problem.at(one, "this value").at(other, "and this one");
            }
        }
        Err(problem.into())
    }

    /// The value of each key at one row of each axis.
    pub(crate) fn choice(&self, rows: &[usize]) -> Choice<'_> {
        let axes = self.axes.iter().zip(rows);
        axes.flat_map(|(axis, row)| {
            let keys = axis.keys.iter().zip(&axis.rows[*row]);
            keys.map(|((key, origin), value)| (key.as_str(), origin, value))
        })
        .collect()
    }

    /// The point that a choice makes.
    pub(crate) fn point(
        &self,
        choice: &Choice<'_>,
        rows: &[usize],
        state: Option<InitialState>,
    ) -> Result<Point, ConfigurationError> {
        let configuration = self.configuration(choice, state)?;
        let setting = |(key, _, value): &(&str, _, &Item)| Setting {
            key: (*key).to_owned(),
            value: SettingValue::of(&value.node),
        };
        Ok(Point {
            settings: choice.iter().map(setting).collect(),
            state: configuration.initial.state,
            configuration,
            rows: rows.to_vec(),
        })
    }
}
