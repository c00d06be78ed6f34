//! F9: hysteresis.

use peristalsis_analysis::{Family, Transition, fit_lifetime};

use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("f9.md"));
const STUDIES: &[&str] = &["branches-*", "loop-*", "dense-jams", "jam-lifetime"];

/// J/Jmax to which the flow of a jam that broke up has fallen where its fall has ended.
const FALLEN: f64 = 0.1;

pub(super) const CLAIM: Claim = Claim::new("F9", PROSE, STUDIES, examine);

/// How the runs from either start ended at one width.
#[derive(Clone, Copy)]
struct Outcomes {
    width: f64,
    /// Runs that ended jammed, and all of them: from rest, and from jammed.
    rest: [u32; 2],
    jammed: [u32; 2],
}

impl Outcomes {
    fn of(width: f64, rows: &[Row<'_>], threshold: f64) -> Self {
        let ended = |start: Start| {
            let runs = rows.iter().filter(|row| {
                row.start() == start && row.flow_rate_ratio().is_finite() && !coasts(row, threshold)
            });
            let jams = runs.clone().filter(|row| row.flow_rate_ratio() > threshold);
            [jams.count() as u32, runs.count() as u32]
        };
        Self {
            width,
            rest: ended(Start::Rest),
            jammed: ended(Start::Jammed),
        }
    }

    /// Whether both starts have runs.
    fn is_compared(&self) -> bool {
        self.rest[1] > 0 && self.jammed[1] > 0
    }

    /// Probability that so many of the jams are of runs that began jammed, or more, if the start did not matter: Fisher's exact
    /// test of one side.
    fn probability(&self) -> f64 {
        let ([rest, rests], [jammed, jams]) = (self.rest, self.jammed);
        let all = rest + jammed;
        let with = |jammed: u32| choose(jams, jammed) * choose(rests, all - jammed);
        let possible = jammed..=jams.min(all);
        possible.map(with).sum::<f64>() / choose(rests + jams, all)
    }

    /// The same runs as they would differ most by their start.
    fn parted(&self) -> Self {
        Self {
            rest: [0, self.rest[1]],
            jammed: [self.jammed[1]; 2],
            ..*self
        }
    }

    /// Whether most runs that began jammed did not stay so.
    fn breaks_up(&self) -> bool {
        self.jammed[1] > 0 && 2 * self.jammed[0] < self.jammed[1]
    }
}

/// Ways to choose k of n.
fn choose(n: u32, k: u32) -> f64 {
    if k > n {
        return 0.0;
    }
    (0..k)
        .map(|one| f64::from(n - one) / f64::from(k - one))
        .product()
}

/// Whether a fast flow is no jam: grains that coast without contacts, or in a straight tube, which no wave can drive.
fn coasts(row: &Row<'_>, threshold: f64) -> bool {
    let is_free = is_straight(row) || row.number("contacts") < LEAST_CONTACTS;
    row.flow_rate_ratio() > threshold && is_free
}

/// Whether no wave runs along the tube.
fn is_straight(row: &Row<'_>) -> bool {
    row.width() >= 2.0 * row.radius() - 1e-9
}

/// Both flows at one strain rate.
struct Loop<'a> {
    flow: Branches<'a>,
    /// w_c, the fall of the flow from rest, and whether it jumps there.
    critical: Uncertain,
    jumps: bool,
    outcomes: Vec<Outcomes>,
    rows: Vec<Row<'a>>,
}

impl<'a> AtRate<'a> for Loop<'a> {
    fn of(runs: &Runs<'a>) -> Option<Self> {
        let flow = runs.flow();
        let critical = flow.rest.step()?.place();
        let threshold = flow.rest.threshold()?;
        let widths = grouped(runs.branches.iter().copied(), Row::width).into_iter();
        let outcomes = widths.map(|(width, rows)| Outcomes::of(width, &rows, threshold));
        Some(Self {
            jumps: flow.rest.jumps(),
            outcomes: outcomes.collect(),
            rows: runs.branches.clone(),
            critical,
            flow,
        })
    }

    fn statistics(&self) -> Statistics {
        // A width at which replicates ended in both flows is on no branch, but the test compares its runs.
        let of = |start: Start| {
            let rows = self.rows.iter().filter(|row| row.start() == start);
            Statistics::at_one_rate(rows.map(Row::width))
        };
        let both = [of(Start::Rest), of(Start::Jammed)];
        Statistics::weakest_at_one_rate(both.into_iter())
    }
}

impl Loop<'_> {
    /// The width at which the starts part most clearly.
    fn clearest(&self) -> Option<&Outcomes> {
        let compared = self.outcomes.iter().filter(|one| one.is_compared());
        compared.min_by(|one, other| one.probability().total_cmp(&other.probability()))
    }

    /// Widths at which both starts have runs.
    fn compared(&self) -> f64 {
        let compared = self.outcomes.iter().filter(|one| one.is_compared());
        compared.count() as f64
    }

    /// Probability of [`Self::clearest`] among all widths that are compared.
    fn probability(&self) -> Option<f64> {
        Some((self.clearest()?.probability() * self.compared()).min(1.0))
    }

    /// Whether both flows exist at some width. `None` where the flow from rest does not jump, and where no width just beyond
    /// the jump has enough runs from both starts to tell that there is one flow.
    fn is_bistable(&self) -> Option<bool> {
        let is_bistable = self.probability()? < ONE_FLOW_BY_CHANCE;
        let beyond = |one: &Outcomes| one.width - self.critical.value;
        let is_next = |one: &Outcomes| (0.0..=NEXT_TO_THE_FALL).contains(&beyond(one));
        let could_tell =
            |one: &Outcomes| one.parted().probability() * self.compared() < ONE_FLOW_BY_CHANCE;
        let mut compared = self.outcomes.iter().filter(|one| one.is_compared());
        let is_told = is_bistable || compared.any(|one| is_next(one) && could_tell(one));
        (self.jumps && is_told).then_some(is_bistable)
    }

    /// The first width beyond w_c at which jams break up; not asked where the flow does not jump.
    fn break_up(&self) -> Option<f64> {
        if !self.jumps {
            return None;
        }
        let mut beyond = self
            .outcomes
            .iter()
            .filter(|one| one.width > self.critical.value);
        beyond.find(|one| one.breaks_up()).map(|one| one.width)
    }

    /// The least and the largest width at which the starts part, where both flows exist.
    fn both(&self) -> Option<(f64, f64)> {
        let exist = self.is_bistable() == Some(true);
        let parted = |one: &&Outcomes| one.is_compared() && one.probability() < ONE_FLOW_BY_CHANCE;
        let parted = self.outcomes.iter().filter(|one| exist && parted(one));
        let widths: Vec<f64> = parted.map(|one| one.width).collect();
        Some((*widths.first()?, *widths.last()?))
    }

    fn row(wall: &str, shown: &Shown<Self>) -> Vec<String> {
        let one = &shown.found;
        let of = |[jams, runs]: [u32; 2]| format!("{jams} of {runs}");
        let clearest = one.clearest();
        vec![
            wall.to_owned(),
            number(shown.strain_rate, 3),
            one.critical.to_string(),
            cell_of(clearest, |clearest| number(clearest.width, 4)),
            cell_of(clearest, |clearest| of(clearest.rest)),
            cell_of(clearest, |clearest| of(clearest.jammed)),
            cell_of(one.probability(), probability),
            cell_of(one.break_up(), |width| number(width, 4)),
            number(shown.escaped, 2),
        ]
    }
}

fn examine(evidence: &Evidence) -> Result<Finding> {
    let walls = OnWall::<Loop<'_>>::all(evidence)?;
    let (mut draft, mut rows) = (Draft::of(PROSE), Vec::new());
    for one in &walls {
        rows.extend(one.all.iter().map(|shown| Loop::row(&one.name, shown)));
        for shown in one.tight() {
            let (wall, rate) = (&one.name, shown.strain_rate);
            let distance = shown
                .found
                .both()
                .map(|(_, last)| last - shown.found.critical.value);
            let distance =
                distance.map(|least| Uncertain::normal(least, shown.found.critical.error));
            draft.quantity("loop", values!(wall, rate), distance);
        }
    }
    let judgement = Judgement::of(walls.iter().map(part).collect(), &CLAIM.needed);
    if rows.is_empty() {
        return Ok(PROSE.nothing(judgement.statistics));
    }
    let periods = walls.iter().map(|one| one.periods).fold(0.0, f64::max);
    let summary = PROSE.text("summary", values!(periods));
    let (contacts, chance, next) = (LEAST_CONTACTS, ONE_FLOW_BY_CHANCE, NEXT_TO_THE_FALL);
    draft.finding.paragraphs = PROSE.paragraphs("method", values!(contacts, chance, next));
    draft.table("loops", &[], rows);
    of_dense_grains(&mut draft, evidence.study("dense-jams")?.rows());
    of_lifetimes(&mut draft, &walls, evidence.study("jam-lifetime")?.rows());
    draft.finding.weaknesses = PROSE.paragraphs("weaknesses", values!(periods));
    let panels: Vec<ChartPanel> = walls.iter().filter_map(widest).collect();
    if !panels.is_empty() {
        let chart = grid(2, panels).share_y();
        draft.chart("hysteresis", &[], chart)?;
    }
    Ok(draft.judged(judgement, &summary))
}

fn part(one: &OnWall<Loop<'_>>) -> Part {
    let judged = |one: &OnWall<Loop<'_>>| one.rates(Loop::is_bistable);
    let rates = judged(one);
    let broken = one.tight().filter(|shown| shown.found.break_up().is_some());
    let broken = listed(broken.map(|shown| shown.strain_rate));
    let broken = match broken.is_empty() {
        true => "none".to_owned(),
        false => format!("*ε̇* = {broken}"),
    };
    let count = PROSE.text("count", values!(count = rates.count()));
    let why = PROSE.text("why", values!(rates = rates.in_words(), broken));
    one.part(|one| judged(one).hold(), count, why)
}

/// Denser grains from both starts at one width.
struct Dense {
    fraction: f64,
    width: f64,
    /// J/Jmax from rest, and from jammed.
    flows: [Uncertain; 2],
    /// Contacts a grain of the runs that began jammed.
    contacts: f64,
}

impl Dense {
    fn of((fraction, width): (f64, f64), rows: &[Row<'_>]) -> Option<Self> {
        let from = |start: Start| -> Vec<Row<'_>> {
            let settled = |row: &&Row<'_>| row.start() == start && row.is_stationary();
            rows.iter().filter(settled).copied().collect()
        };
        let [rest, jammed] = [Start::Rest, Start::Jammed].map(from);
        (rest.len() > 1 && jammed.len() > 1).then(|| Self {
            fraction,
            width,
            contacts: scattered(&jammed, |row| row.number("contacts")).value,
            flows: [rest, jammed].map(|rows| scattered(&rows, Row::flow_rate_ratio)),
        })
    }

    /// Difference of the flows.
    fn apart(&self) -> Uncertain {
        self.flows[1] - self.flows[0]
    }

    /// Whether the late flow depends on the start.
    fn depends_on_start(&self) -> bool {
        let apart = self.apart();
        apart.value > LEAST_FALL && apart.deviations_from(0.0) > CLEAR
    }

    fn row(&self) -> Vec<String> {
        let [rest, jammed] = self.flows.map(|flow| cell(Some(flow)));
        let numbers =
            [(self.fraction, 2), (self.width, 4)].map(|(one, digits)| number(one, digits));
        let [fraction, width] = numbers;
        vec![fraction, width, rest, jammed, number(self.contacts, 1)]
    }
}

/// Whether the late flow of denser grains, which touch one another for long, depends on the start.
fn of_dense_grains(draft: &mut Draft, rows: Vec<Row<'_>>) {
    let key = |row: &Row<'_>| (row.volume_fraction(), row.width());
    let groups = grouped(rows, key).into_iter();
    let found: Vec<Dense> = groups
        .filter_map(|(at, rows)| Dense::of(at, &rows))
        .collect();
    let clearest = found
        .iter()
        .max_by(|one, other| one.apart().value.total_cmp(&other.apart().value));
    let Some(clearest) = clearest else {
        return;
    };
    let both = grouped(found.iter(), |one| one.fraction).into_iter();
    let of_both = |is: bool| {
        let those = both
            .clone()
            .filter(|(_, widths)| widths.iter().any(|one| one.depends_on_start()) == is);
        match listed(those.map(|(fraction, _)| fraction)) {
            none if none.is_empty() => "none".to_owned(),
            some => some,
        }
    };
    let (two, one) = (of_both(true), of_both(false));
    let Dense {
        fraction, width, ..
    } = clearest;
    let [rest, jammed] = clearest.flows;
    let contacts = number(clearest.contacts, 1);
    draft.paragraph(
        "dense",
        values!(two, one, fraction, width, rest, jammed, contacts),
    );
    draft.table("dense", &[], found.iter().map(Dense::row));
}

/// Jams in one tube too wide for them.
struct Lifetime {
    lattice: Lattice,
    strain_rate: f64,
    width: f64,
    /// Runs whose grains do not coast in the end.
    jams: usize,
    /// J/Jmax at the end of those that broke up.
    broken: Vec<f64>,
    /// Runs whose grains coast in the end, which are no jams.
    void: usize,
    /// Mean number of periods until then, the others counted as censored; `None` where none broke up.
    mean: Option<Uncertain>,
    /// For how many periods they were watched.
    watched: f64,
    /// J/Jmax at the end.
    flow: Uncertain,
}

impl Lifetime {
    fn of(rows: &[Row<'_>]) -> Self {
        let first = &rows[0];
        let is_void = |row: &&Row<'_>| coasts(row, row.number("transition_threshold"));
        let (void, jams): (Vec<Row<'_>>, Vec<Row<'_>>) = rows.iter().partition(is_void);
        let transitions: Vec<Transition> = jams.iter().map(Row::transition).collect();
        let broken = jams.iter().zip(&transitions);
        let broken = broken.filter(|(_, one)| one.observed().is_some());
        let fit = fit_lifetime(Family::Gamma, &transitions)
            .or_else(|_| fit_lifetime(Family::Exponential, &transitions));
        Self {
            lattice: first.lattice(),
            strain_rate: first.strain_rate(),
            width: first.width(),
            jams: jams.len(),
            broken: broken.map(|(row, _)| row.flow_rate_ratio()).collect(),
            void: void.len(),
            mean: fit.ok().map(|fit| fit.mean.scaled(first.strain_rate())),
            watched: largest(rows, |row| row.watched() * row.strain_rate()),
            flow: scattered(rows, Row::flow_rate_ratio),
        }
    }

    fn row(&self) -> Vec<String> {
        let lasting = || format!("> {}", number(self.watched, 0));
        vec![
            wall_name(self.lattice, STAGGERED),
            number(self.strain_rate, 3),
            number(self.width, 2),
            format!("{} of {}", self.broken.len(), self.jams),
            self.void.to_string(),
            self.mean.map_or_else(lasting, |mean| mean.to_string()),
            self.flow.to_string(),
        ]
    }
}

/// How long jams last in tubes wider than the w_c of their wall. In a straight tube there are none.
fn of_lifetimes(draft: &mut Draft, walls: &[OnWall<Loop<'_>>], mut rows: Vec<Row<'_>>) {
    let critical = |row: &Row<'_>| {
        let name = wall_name(row.lattice(), STAGGERED);
        let wall = walls.iter().find(|one| one.name == name)?;
        let mut rates = wall.all.iter();
        let shown = rates.find(|shown| shown.strain_rate == row.strain_rate())?;
        Some(shown.found.critical.value)
    };
    let is_wide =
        |row: &Row<'_>| !is_straight(row) && critical(row).is_none_or(|w_c| row.width() > w_c);
    rows.retain(|row| row.start() == Start::Jammed && is_wide(row));
    let key = |row: &Row<'_>| (row.lattice(), row.strain_rate(), row.width());
    let groups = grouped(rows, key).into_iter();
    let found: Vec<Lifetime> = groups.map(|(_, rows)| Lifetime::of(&rows)).collect();
    let watched = found.iter().map(|one| one.watched).fold(0.0, f64::max);
    if found.is_empty() {
        return;
    }
    let sum = |of: fn(&Lifetime) -> usize| found.iter().map(of).sum::<usize>();
    let (void, ended, jams) = (
        sum(|one| one.void),
        sum(|one| one.broken.len()),
        sum(|one| one.jams),
    );
    let (tubes, all) = (found.len(), jams + void);
    let broken = found.iter().filter(|one| !one.broken.is_empty());
    let places = grouped(broken, |one| one.lattice).into_iter();
    let places = places.map(|(lattice, tubes)| {
        let wall = wall_name(lattice, STAGGERED);
        let rates = grouped(tubes, |one| one.strain_rate).into_iter();
        format!("{wall} at *ε̇* = {}", listed(rates.map(|(rate, _)| rate)))
    });
    let places = places.collect::<Vec<_>>().join(", ");
    let falling = found.iter().flat_map(|one| one.broken.iter().copied());
    let falling: Vec<f64> = falling.filter(|flow| *flow > FALLEN).collect();
    let falling = match falling.len() {
        0 => String::new(),
        number_of => {
            let [least, most] = extremes(falling).map(|flow| number(flow, 2));
            PROSE.text("falling", values!(falling = number_of, least, most))
        }
    };
    let places = match &*places {
        "" => String::new(),
        places => format!(" ({places}{falling})"),
    };
    draft.paragraph(
        "lifetimes",
        values!(
            watched = number(watched, 0),
            tubes,
            void,
            ended,
            all,
            places
        ),
    );
    draft.table("lifetimes", &[], found.iter().map(Lifetime::row));
}

/// The widest window with both flows on a wall.
fn widest(one: &OnWall<Loop<'_>>) -> Option<ChartPanel> {
    let windows = one
        .tight()
        .filter_map(|shown| Some((shown, shown.found.both()?)));
    let width = |(first, last): (f64, f64)| last - first;
    let (shown, (first, last)) =
        windows.max_by(|one, other| width(one.1).total_cmp(&width(other.1)))?;
    let title = format!("{}, *ε̇* = {}", one.name, shown.strain_rate);
    let mut panel = flow_panel().title(&title);
    if last > first {
        panel = panel.with(Window::new("both states", first, last));
    }
    Some(panel.with_all(both_starts(&shown.found.flow).into_iter().flatten()))
}
