//! Q12: why the critical width falls as the wave gets faster.

mod drags;

use core::f64::consts::PI;

use super::f7::SLOPE;
use super::prelude::*;
use drags::Drags;

const PROSE: Prose = Prose::new(include_str!("q12.md"));

/// Tubes that were computed after the predictions, to test them.
const TEST: &str = "wall-stiffness";
/// First those that were there before the predictions; then two of waves so slow that grains feel each sphere of the wall; the
/// last two have no critical width.
const STUDIES: &[&str] = &[
    "restitution",
    "softness",
    "wavelength",
    "radius",
    "roughness",
    "walls",
    TEST,
    "small-strain-rate-fine",
    "small-strain-rate-coarse",
    drags::WAVES,
    drags::WALL,
];

/// So many of them are of tubes with a critical width.
const TUBES: usize = 9;

/// What differs from tube to tube of a study.
fn varied(study: &str) -> &'static str {
    match study {
        "restitution" => "restitution",
        "softness" => "softness of the grains",
        "wavelength" => "wavelength",
        "radius" => "radius of the tube",
        "roughness" => "roughness of the wall",
        "walls" => "arrangement of the wall",
        "small-strain-rate-fine" => "small strain rate, 24 × 26",
        "small-strain-rate-coarse" => "small strain rate, 12 × 14",
        _ => "stiffness of the wall (tests)",
    }
}

fn is_known(study: &str) -> bool {
    STUDIES[..6].contains(&study)
}

pub(super) const CLAIM: Claim =
    Claim::new("Q12", PROSE, STUDIES, examine).varying("width", Q12_NEEDED);

/// What makes a tube: whether its spheres are staggered, spheres a ring and rings a wave, then a, lambda, strain rate, k and
/// eta.
type Key = (bool, [i64; 2], [f64; 5]);

/// A tube with its grains, in units of m and d, and what was measured in it.
struct Tube {
    key: Key,
    radius: f64,
    wavelength: f64,
    wave_speed: f64,
    stiffness: f64,
    damping: f64,
    restitution: f64,
    /// Wall spheres per area.
    density: f64,
    /// 2 a − w_c.
    narrowing: Uncertain,
}

impl Tube {
    /// The tubes of a study that hold their grains at a [sharp](Crossing::is_sharp) critical width.
    fn all_of(rows: Vec<Row<'_>>) -> Vec<Self> {
        let tube = |row: &Row<'_>| -> Key {
            let lattice = row.lattice();
            let lattice = [lattice.spheres_per_ring, lattice.rings_per_wave];
            let (radius, wavelength, rate) = (row.radius(), row.wavelength(), row.strain_rate());
            let numbers = [radius, wavelength, rate, row.stiffness(), row.damping()];
            (arrangement(row) == STAGGERED, lattice, numbers)
        };
        let groups = grouped(rows, tube).into_iter();
        let tubes = groups.filter_map(|(key, rows)| Self::of(key, &rows));
        tubes.collect()
    }

    fn of(key: Key, rows: &[Row<'_>]) -> Option<Self> {
        let crossing = Crossing::of(rows)?;
        let critical = crossing.width;
        let first = &rows[0];
        let is_tight = leak(rows, Some(critical.value)) <= MOST_ESCAPED;
        (is_tight && crossing.is_sharp()).then(|| Self {
            key,
            radius: first.radius(),
            wavelength: first.wavelength(),
            wave_speed: first.wave_speed(),
            stiffness: first.stiffness(),
            damping: first.damping(),
            restitution: first.restitution(),
            density: first.wall_density(),
            narrowing: Uncertain::normal(2.0 * first.radius() - critical.value, critical.error),
        })
    }

    /// How deep a grain as fast as the wave sinks into a wall of so many spheres per area: m c^2/2 = pi sigma k d h^3/3.
    fn depth_of_energy(&self) -> f64 {
        let Self {
            wave_speed,
            stiffness,
            density,
            ..
        } = self;
        (1.5 * wave_speed * wave_speed / (PI * density * stiffness)).cbrt()
    }

    /// c (m lambda a/(k sigma))^(1/2)/d^2.
    fn stiffness_of_wall(&self) -> f64 {
        let Self {
            wave_speed,
            stiffness,
            density,
            ..
        } = self;
        wave_speed * (self.wavelength * self.radius / (stiffness * density)).sqrt()
    }

    /// (lambda/pi) s_c with s_c = 2 eta c/(k d (1 − e^2)^(1/2)); NaN without dissipation.
    fn two_drags(&self) -> f64 {
        let loss = 1.0 - self.restitution * self.restitution;
        let slope = 2.0 * self.damping * self.wave_speed / (self.stiffness * loss.sqrt());
        self.wavelength / PI * slope
    }
}

/// A prediction of 2 a − w_c.
struct Prediction {
    name: &'static str,
    axis: &'static str,
    /// Without its constant.
    shape: fn(&Tube) -> f64,
    /// Fitted to the known tubes, with its scatter over them, or exact.
    constant: Uncertain,
}

impl Prediction {
    /// All, their constants fitted to these tubes.
    fn all_from(known: &[&Tube]) -> [Self; 3] {
        let fitted = |shape: fn(&Tube) -> f64| {
            let ratios = sorted(known.iter().map(|tube| tube.narrowing.value / shape(tube)));
            let last = ratios.len().saturating_sub(1) as f64;
            let at = |part: f64| {
                let place = (part * last).round() as usize;
                ratios.get(place).copied().unwrap_or(f64::NAN)
            };
            Uncertain::normal(at(0.5), 0.5 * (at(0.84) - at(0.16)))
        };
        let of = |name, axis, shape, constant| Self {
            name,
            axis,
            shape,
            constant,
        };
        [
            of(
                "the energy",
                "*C* *h*/*d*, energy",
                Tube::depth_of_energy,
                fitted(Tube::depth_of_energy),
            ),
            of(
                "the stiffness of the wall",
                "*C* *c*(*mλa*/*kσ*)^{1/2}/*d*^3, stiffness of the wall",
                Tube::stiffness_of_wall,
                fitted(Tube::stiffness_of_wall),
            ),
            of(
                "two drags",
                "*λs*_{c}/(*πd*), two drags",
                Tube::two_drags,
                Uncertain::normal(1.0, 0.0),
            ),
        ]
    }

    fn of(&self, tube: &Tube) -> f64 {
        self.constant.value * (self.shape)(tube)
    }

    /// Measured over predicted, ascending.
    fn ratios<'a>(&self, tubes: impl IntoIterator<Item = &'a Tube>) -> Vec<f64> {
        let ratios = tubes
            .into_iter()
            .map(|tube| tube.narrowing.value / self.of(tube));
        sorted(ratios)
    }

    /// How many of some tubes lie near it, of those for which it says something.
    fn within<'a>(&self, tubes: impl IntoIterator<Item = &'a Tube>) -> String {
        let ratios = self.ratios(tubes);
        let near = ratios
            .iter()
            .filter(|ratio| (*ratio - 1.0).abs() <= PREDICTED_WITHIN);
        format!("{} of {}", near.count(), ratios.len())
    }

    /// Median, least and largest of measured over predicted.
    fn cell(&self, tubes: &[Tube]) -> String {
        let ratios = self.ratios(tubes);
        let Some((least, most)) = ends(ratios.iter().copied()) else {
            return cell_of(ratios.first(), |only| number(*only, 2));
        };
        let half = ratios.len() / 2;
        let median = 0.5 * (ratios[(ratios.len() - 1) / 2] + ratios[half]);
        let [median, least, most] = [median, least, most].map(|ratio| number(ratio, 2));
        format!("{median} ({least}–{most})")
    }

    /// Measured against predicted.
    fn panel(&self, groups: &[Group]) -> ChartPanel {
        let points = groups.iter().map(|group| {
            let told = group.tubes.iter().filter(|tube| self.of(tube).is_finite());
            let points = points(
                varied(group.study),
                told.map(|tube| (self.of(tube), tube.narrowing)),
            )?;
            let known = is_known(group.study);
            Some(if known { points } else { points.open() })
        });
        ChartPanel::new(self.axis, "measured, (2*a* − *w*_{c})/*d*")
            .x_scale(Scale::Logarithmic)
            .y_scale(Scale::Logarithmic)
            .with(Curve::new("as predicted", &DIAGONAL, &DIAGONAL).tint(Tint::Black))
            .with_all(numbered(points))
    }
}

/// Finite numbers, ascending.
fn sorted(numbers: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut numbers: Vec<f64> = numbers.filter(|one| one.is_finite()).collect();
    numbers.sort_by(f64::total_cmp);
    numbers
}

/// Ends of the line on which predictions come true \[d\].
const DIAGONAL: [f64; 2] = [0.045, 1.2];

/// The tubes of one study.
struct Group {
    study: &'static str,
    tubes: Vec<Tube>,
}

fn examine(evidence: &Evidence) -> Result<Finding> {
    let (mut groups, mut all) = (Vec::new(), Vec::new());
    for study in &STUDIES[..TUBES] {
        let rows = evidence.study(study)?.rows();
        if !rows.is_empty() {
            all.push(behind(&rows, Row::width));
        }
        let tubes = Tube::all_of(rows);
        groups.push(Group { study, tubes });
    }
    groups.retain(|group| !group.tubes.is_empty());
    let of = |is_of: fn(&str) -> bool| -> Vec<&Tube> {
        let those = groups.iter().filter(|group| is_of(group.study));
        let mut tubes: Vec<&Tube> = Vec::new();
        // A tube of several studies counts once.
        for tube in those.flat_map(|group| &group.tubes) {
            if tubes.iter().all(|known| known.key != tube.key) {
                tubes.push(tube);
            }
        }
        tubes
    };
    let (known, tests) = (of(is_known), of(|study| study == TEST));
    let statistics = Statistics::weakest_at_one_rate(all.into_iter());
    if known.is_empty() {
        return Ok(PROSE.nothing(statistics));
    }
    let predictions = Prediction::all_from(&known);
    let mut draft = Draft::of(PROSE);
    let density = density_of_the_source(&predictions[1].constant);
    draft.quantity("density of the source", &[], density);
    let mut words = Vec::new();
    for one in &predictions {
        let name = one.name;
        let [known, tests] = [&known, &tests].map(|tubes| one.within(tubes.iter().copied()));
        words.push(PROSE.text("told", values!(known, tests, name)));
        if one.constant.error > 0.0 {
            draft.quantity("constant", values!(name), one.constant);
        }
    }
    let rows = groups.iter().map(|group| {
        let first = [group.study.to_owned(), group.tubes.len().to_string()];
        let cells = predictions.iter().map(|one| one.cell(&group.tubes));
        first.into_iter().chain(cells).collect()
    });
    draft.table("predictions", &[], rows);
    let drags = Drags::all(evidence)?;
    let told = drags
        .iter()
        .filter_map(|one| Some((one.temperature, one.explains()?)));
    let met = grouped(told, |(temperature, _)| *temperature).into_iter();
    let met = met.map(|(temperature, told)| {
        let (met, all) = (told.iter().filter(|(_, met)| *met).count(), told.len());
        PROSE.text("met", values!(met, all, temperature))
    });
    let met: Vec<String> = met.collect();
    if !met.is_empty() {
        draft.paragraph("measured", values!(met = met.join(", ")));
        draft.table("drags", &[], drags.iter().map(Drags::row));
    }
    let panels = predictions.iter().map(|one| one.panel(&groups));
    let chart = grid(3, panels).share_y().legend(LegendPlace::Below);
    draft.chart("predictions", &[], chart)?;
    let nearest = WALLS.iter().map(|wall| {
        let ours = wall.lattice.density(RADIUS, WAVELENGTH);
        ((ours - density.value).abs(), wall.name(), number(ours, 2))
    });
    let nearest = nearest.min_by(|one, other| one.0.total_cmp(&other.0));
    let nearest = nearest.map_or_else(String::new, |(_, wall, ours)| format!("{wall} has {ours}"));
    let summary = PROSE.text(
        "summary",
        values!(density, told = words.join("; "), nearest),
    );
    let verdict = Verdict::answered_if(tests.len() >= LEAST_TESTS);
    Ok(draft.concluded(verdict, summary, statistics))
}

/// a and lambda of the presets \[d\], whose grains have k = 1.
const RADIUS: f64 = 1.5;
const WAVELENGTH: f64 = 10.0;

/// Wall spheres per area at which the stiffness of the wall gives the slope of the source in the presets' tube:
/// slope = −C lambda (m lambda a/(k sigma))^(1/2)/d^2.
fn density_of_the_source(constant: &Uncertain) -> Uncertain {
    let slope = constant.value * WAVELENGTH / SLOPE;
    let density = slope * slope * WAVELENGTH * RADIUS;
    Uncertain::normal(density, 2.0 * density * constant.error / constant.value)
}
