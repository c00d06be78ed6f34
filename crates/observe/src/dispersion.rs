//! Axial dispersion: how fast grains that began together drift apart along the tube.

use crate::sample::Observer;
use crate::view::View;

/// Origins kept at most, an even number; when there are more, every other one goes.
const MOST_ORIGINS: usize = 16;
/// Ends of periods kept at most, an even number; when there are more, every other one goes.
const MOST_TIMES: usize = 1 << 16;

/// Variances of axial displacements since origins spread over the whole run, taken at the end of each period.
///
/// Where a run changes its kind of flow, displacements since its start say little about how grains disperse late. So
/// origins are taken at equal distances all along the run, ever wider apart: the late part has some of its own.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct AxialDispersion {
    /// End of each period, or of every so many of a long run, the start of the run before them \[t\].
    times: Vec<f64>,
    /// Periods from one of these times to the next.
    each: u64,
    /// Periods since the last of them.
    since: u64,
    /// Times from one origin to the next.
    stride: usize,
    origins: Vec<Origin>,
}

/// Where the grains were, and how far apart they have moved since.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
struct Origin {
    /// Number of times before it.
    period: usize,
    /// z of the grains, turns round the tube counted \[d\].
    place: Vec<f64>,
    /// Variance of their displacements at each time since, of the grains inside then \[d^2\].
    variances: Vec<f64>,
}

impl AxialDispersion {
    /// Begins at the present places.
    pub fn new(observer: &Observer) -> Self {
        let mut dispersion = Self {
            stride: 1,
            each: 1,
            ..Self::default()
        };
        dispersion.begin(observer);
        dispersion
    }

    /// Whether a run of `grains` grains can have come to this state, read from a file.
    pub fn fits(&self, grains: usize) -> bool {
        let times = self.times.len();
        (1..=2 * times).contains(&self.stride)
            && self.each.is_power_of_two()
            && self.since < self.each
            && self.origins.iter().all(|origin| {
                origin.place.len() == grains
                    && origin.period < times
                    && origin.variances.len() < times - origin.period
            })
    }

    /// Ends a period now, with an observer that has just taken its sample.
    pub fn end_period(&mut self, observer: &Observer, view: &View<'_>) {
        self.since += 1;
        if self.since < self.each {
            return;
        }
        self.since = 0;
        let inside: Vec<usize> = (0..observer.unfolded.len())
            .filter(|&grain| view.inside[grain])
            .collect();
        for origin in &mut self.origins {
            let moved = |&grain: &usize| observer.unfolded[grain] - origin.place[grain];
            let number = inside.len() as f64;
            let mean = inside.iter().map(moved).sum::<f64>() / number;
            let squares = inside.iter().map(moved).map(|z| (z - mean) * (z - mean));
            let variance = squares.sum::<f64>() / number;
            origin.variances.push(variance);
        }
        self.begin(observer);
    }

    /// Notes the time, and an origin where one is due.
    fn begin(&mut self, observer: &Observer) {
        if self.times.len() == MOST_TIMES {
            self.halve();
        }
        let period = self.times.len();
        self.times.push(observer.time);
        if !period.is_multiple_of(self.stride) {
            return;
        }
        self.origins.push(Origin {
            period,
            place: observer.unfolded.clone(),
            variances: Vec::new(),
        });
        if self.origins.len() > MOST_ORIGINS {
            self.stride *= 2;
            let stride = self.stride;
            self.origins
                .retain(|origin| origin.period.is_multiple_of(stride));
        }
    }

    /// Keeps every second time, so that the periods between two of them double.
    fn halve(&mut self) {
        fn every_other(values: &[f64], first: usize) -> Vec<f64> {
            values.iter().copied().skip(first).step_by(2).collect()
        }
        self.times = every_other(&self.times, 0);
        self.origins
            .retain(|origin| origin.period.is_multiple_of(2));
        for origin in &mut self.origins {
            origin.period /= 2;
            // The first is of the time after the origin.
            origin.variances = every_other(&origin.variances, 1);
        }
        self.stride = (self.stride / 2).max(1);
        self.each *= 2;
    }

    /// Half the rates at which the variance grows from period to period, d var(z)/(2 dt), from the time `start` \[t\] on
    /// \[d^2/t\]: their mean is the coefficient of dispersion D.
    ///
    /// Displacements count from the first origin after `start`; its first period is left out, as grains then still remember
    /// how they moved. Where no such origin has two more periods behind it, they count from the last origin before.
    pub fn rates_from(&self, start: f64) -> Vec<f64> {
        // Rounding must not make an origin at the start itself one before it.
        let earliest = start - 1e-9 * start.abs();
        let is_late = |origin: &&Origin| self.times[origin.period] >= earliest;
        let of_late_part = self.origins.iter().find(is_late);
        let origin = of_late_part
            .filter(|origin| origin.variances.len() > 2)
            .or_else(|| self.origins.iter().rfind(|origin| !is_late(origin)))
            .or(self.origins.first());
        let Some(origin) = origin else {
            return Vec::new();
        };
        let times = self.times[origin.period + 1..].windows(2);
        let variances = origin.variances.windows(2);
        variances
            .zip(times)
            .filter(|(_, times)| times[0] >= earliest)
            .map(|(variances, times)| 0.5 * (variances[1] - variances[0]) / (times[1] - times[0]))
            .collect()
    }
}
