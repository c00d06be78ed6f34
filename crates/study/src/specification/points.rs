//! The points of a study's axes, and the plan of their runs.

use peristalsis_configuration::document::Item;
use peristalsis_configuration::{ConfigurationError, InitialState};

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
        plan.check_distinct()?;
        Ok(plan)
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
