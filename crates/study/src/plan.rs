//! The runs of a study: points of its axes, and replicates of each.

use std::cmp::Ordering;
use std::collections::HashMap;

use peristalsis_configuration::document::Node;
use peristalsis_configuration::{Configuration, InitialState, word};
use peristalsis_run::Stopping;

use crate::identity::{Identity, Record};

/// The value of a key of an axis.
#[derive(Clone, Debug, PartialEq)]
pub enum SettingValue {
    /// A number with a point or an exponent.
    Number(f64),
    /// A whole number.
    Whole(i64),
    /// A name, or a list of numbers as it is written in TOML.
    Text(String),
    /// True or false.
    Boolean(bool),
}

impl SettingValue {
    pub(crate) fn of(node: &Node) -> Self {
        match node {
            Node::Integer(whole) => Self::Whole(*whole),
            Node::Float(number) => Self::Number(*number),
            Node::Boolean(boolean) => Self::Boolean(*boolean),
            Node::Text(text) => Self::Text(text.clone()),
            Node::Array(items) => {
                let numbers = items.iter().map(|item| Self::of(&item.node).to_string());
                Self::Text(format!("[{}]", numbers.collect::<Vec<_>>().join(", ")))
            }
            other => unreachable!("no value of an axis is {}", other.description()),
        }
    }

    /// The value as a number, if it is one.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(number) => Some(*number),
            Self::Whole(whole) => Some(*whole as f64),
            _ => None,
        }
    }

    fn order(&self, other: &Self) -> Ordering {
        match (self.number(), other.number()) {
            (Some(one), Some(other)) => one.total_cmp(&other),
            (Some(_), None) => Ordering::Less,
            (None, Some(_)) => Ordering::Greater,
            (None, None) => self.to_string().cmp(&other.to_string()),
        }
    }
}

impl std::fmt::Display for SettingValue {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Number(number) => number.fmt(formatter),
            Self::Whole(whole) => whole.fmt(formatter),
            Self::Text(text) => formatter.write_str(text),
            Self::Boolean(boolean) => boolean.fmt(formatter),
        }
    }
}

/// A key of the configuration and what a point sets it to.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// Full name of the key.
    pub key: String,
    /// Its value.
    pub value: SettingValue,
}

/// One point of a study: a configuration but for the seed.
#[derive(Clone, Debug)]
pub struct Point {
    /// The keys of the axes, in the order of the file.
    pub settings: Vec<Setting>,
    /// The initial state.
    pub state: InitialState,
    /// The configuration, with the seed of its base.
    pub configuration: Configuration,
    /// The row of each axis; without meaning for a refined axis.
    pub(crate) rows: Vec<usize>,
}

impl Point {
    /// The settings in words, such as "drive.width 2.7, from rest".
    pub fn in_words(&self) -> String {
        self.in_words_without(usize::MAX)
    }

    /// The settings in words but for the one at this place.
    pub(crate) fn in_words_without(&self, left_out: usize) -> String {
        let settings = self.settings.iter().enumerate();
        let mut words: Vec<String> = settings
            .filter(|(place, _)| *place != left_out)
            .map(|(_, setting)| format!("{} {}", setting.key, setting.value))
            .collect();
        words.push(format!("from {}", word(self.state)));
        words.join(", ")
    }

    fn order(&self, other: &Self) -> Ordering {
        let pairs = self.settings.iter().zip(&other.settings);
        let mut orders = pairs.map(|(one, other)| one.value.order(&other.value));
        let by_state = || word(other.state).cmp(&word(self.state));
        orders.find(|order| order.is_ne()).unwrap_or_else(by_state)
    }
}

/// One run of a study.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlannedRun {
    /// Its identity.
    pub identity: Identity,
    /// Index into [`Plan::points`].
    pub point: usize,
    /// Number of the replicate, from 0.
    pub replicate: u32,
    /// Seed of its random numbers.
    pub seed: u64,
}

/// The runs of a study, the first replicate of every point before the second of any.
#[derive(Clone, Debug, Default)]
pub struct Plan {
    points: Vec<Point>,
    runs: Vec<PlannedRun>,
    replicates: u32,
    /// When a run may end before its time.
    pub stopping: Option<Stopping>,
    /// Tables that are kept of each run.
    pub record: Record,
}

impl Plan {
    /// Without points yet.
    pub(crate) fn new(replicates: u32, stopping: Option<Stopping>, record: Record) -> Self {
        Self {
            replicates,
            stopping,
            record,
            ..Self::default()
        }
    }

    /// Adds points and the runs of each.
    pub(crate) fn add(&mut self, points: Vec<Point>) {
        for point in points {
            let index = self.points.len();
            let configuration = &point.configuration;
            let runs = Identity::of(configuration, self.stopping, &self.record, self.replicates);
            let planned = |(replicate, (identity, seed))| PlannedRun {
                identity,
                point: index,
                replicate,
                seed,
            };
            self.runs.extend((0..).zip(runs).map(planned));
            self.points.push(point);
        }
        self.runs.sort_by_key(|run| (run.replicate, run.point));
    }

    /// Identity of the first run of a point, the same for points that are the same run.
    pub(crate) fn first_run(&self, point: &Point) -> Identity {
        let configuration = &point.configuration;
        let (identity, _) = Identity::of(configuration, self.stopping, &self.record, 1)[0];
        identity
    }

    /// The same points with some of the runs.
    pub(crate) fn part(&self, is_in: impl Fn(&PlannedRun) -> bool) -> Self {
        let mut part = self.clone();
        part.runs.retain(is_in);
        part
    }

    /// The first two points that are the same run.
    pub(crate) fn twins(&self) -> Option<[&Point; 2]> {
        let mut seen: HashMap<Identity, &Point> = HashMap::new();
        self.points.iter().find_map(|point| {
            let start = point.configuration.at_its_start();
            let (identity, _) = Identity::of(&start, self.stopping, &self.record, 1)[0];
            Some([seen.insert(identity, point)?, point])
        })
    }

    /// The points; refinement's come after the others.
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// The runs in the order in which they are begun.
    pub fn runs(&self) -> &[PlannedRun] {
        &self.runs
    }

    /// The runs in the order of the values of the axes, as tables list them.
    pub fn sorted_runs(&self) -> Vec<PlannedRun> {
        let mut runs = self.runs.clone();
        runs.sort_by(|one, other| {
            self.points[one.point]
                .order(&self.points[other.point])
                .then(one.replicate.cmp(&other.replicate))
        });
        runs
    }

    /// The point of a run.
    pub fn point(&self, run: &PlannedRun) -> &Point {
        &self.points[run.point]
    }

    /// The configuration of a run, its seed included.
    pub fn configuration(&self, run: &PlannedRun) -> Configuration {
        let mut configuration = self.points[run.point].configuration.clone();
        configuration.run.seed = run.seed;
        configuration
    }
}
