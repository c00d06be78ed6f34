//! The file of a design: grain, tube and drive as an engineer has them, in SI; and the configuration that computes it.

use std::f64::consts::PI;
use std::sync::LazyLock;

use peristalsis_analysis::number::rounded;
use peristalsis_configuration::document::{self, Table};
use peristalsis_configuration::{
    Configuration, ConfigurationError, Grains, MATERIALS, MOST_GRAINS, Material, Observe, Problem,
    ProblemKind, Problems, SourceFile, WaveformName, check_against, file_with_overrides,
    grain_mass, material, schema_of, word,
};
use peristalsis_physics::wall::Waveform;
use peristalsis_run::{longest_time_step, samples_that_meet};
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::{Value, json};

/// Overlap of two grains that meet at the speed of the wave, over their diameter, at the stiffness that is chosen.
const OVERLAP_OF_AN_IMPACT: f64 = 0.02;
/// The same under the weight of the grains above and under the back pressure.
const OVERLAP_OF_A_LOAD: f64 = 0.01;
/// Wall spheres a ring for each diameter of the largest radius, and rings for each diameter of the wavelength: fewer leak.
const WALL_SPHERES: [f64; 2] = [7.5, 1.3];

/// Waveforms that a design may have.
const WAVEFORMS: [WaveformName; 4] = [
    WaveformName::Sine,
    WaveformName::Bolus,
    WaveformName::Roller,
    WaveformName::Segments,
];

/// A peristaltic pump for grains, in SI.
#[derive(Deserialize, JsonSchema)]
struct Keys {
    /// Gravity; 0 for none.
    #[serde(default = "earth")]
    #[schemars(extend("x-unit" = "m s^-2", "minimum" = 0, "maximum" = 1e3))]
    gravity: f64,
    grain: GrainKeys,
    tube: TubeKeys,
    drive: DriveKeys,
}

fn earth() -> f64 {
    9.81
}

/// The grains: a material, or density, friction and restitution, which hold beside a material too.
#[derive(Deserialize, JsonSchema)]
#[schemars(extend("additionalProperties" = false))]
struct GrainKeys {
    /// Mean diameter.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0, "maximum" = 1))]
    diameter: f64,
    /// Diameters are uniform within this part of the mean to either side; 0: all alike.
    #[serde(default)]
    #[schemars(extend("x-unit" = "1", "minimum" = 0, "maximum" = 0.9))]
    spread: f64,
    /// What they are made of.
    #[schemars(extend("enum" = names()))]
    material: Option<String>,
    /// Density of a grain.
    #[schemars(extend("x-unit" = "kg m^-3", "exclusiveMinimum" = 0, "maximum" = 1e5))]
    density: Option<f64>,
    /// Friction of two grains, and of a grain and the wall.
    #[schemars(extend("x-unit" = "1", "minimum" = 0, "maximum" = 10))]
    friction: Option<f64>,
    /// Restitution of two grains that meet.
    #[schemars(extend("x-unit" = "1", "minimum" = 1e-3, "maximum" = 1))]
    restitution: Option<f64>,
    /// Stiffness of a contact in the computation. Missing: the least at which grains pass for solid: two that meet at the
    /// speed of the wave overlap by 2 per cent of a diameter, those under weight and back pressure by 1 per cent.
    #[schemars(extend("x-unit" = "N m^-1", "exclusiveMinimum" = 0, "maximum" = 1e15))]
    stiffness: Option<f64>,
}

fn names() -> Vec<&'static str> {
    MATERIALS.iter().map(|material| material.name).collect()
}

/// The tube.
#[derive(Deserialize, JsonSchema)]
#[schemars(extend("additionalProperties" = false))]
struct TubeKeys {
    /// Clear bore of the straight tube: the mean one of a sine, the open one of the other waveforms.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0, "maximum" = 10))]
    diameter: f64,
    /// Length of a wave: the distance of two throats.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0, "maximum" = 1e3))]
    wavelength: f64,
    /// Length, rounded to whole waves. Missing: two of them. The tube goes on as it begins (it is periodic).
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0, "maximum" = 1e5))]
    length: Option<f64>,
    /// Occlusion, 1 - (clear throat)/(clear bore): towards 0 the tube is straight, and moves nothing; 1 is closed.
    #[schemars(extend("x-unit" = "1", "exclusiveMinimum" = 0, "maximum" = 1))]
    occlusion: f64,
    /// Volume of the grains over that of the clear bore of the straight tube. grains.volume_fraction counts the tube up to the
    /// centres of the wall spheres, and is smaller.
    #[schemars(extend("x-unit" = "1", "exclusiveMinimum" = 0, "maximum" = 0.7))]
    fill: f64,
    /// Angle at which the wave climbs: 0 is a tube that lies, 90 one that pumps upward, -90 one that pumps downward.
    #[serde(default)]
    #[schemars(extend("x-unit" = "degrees", "minimum" = -90, "maximum" = 90))]
    incline: f64,
}

/// How the tube is squeezed.
#[derive(Deserialize, JsonSchema)]
#[schemars(extend("additionalProperties" = false))]
struct DriveKeys {
    /// Squeezes a second at one place.
    #[schemars(extend("x-unit" = "Hz", "exclusiveMinimum" = 0, "maximum" = 1e6))]
    frequency: f64,
    /// Shape of the wave: sine, bolus (one smooth squeeze), roller, or segments that close in turn.
    #[serde(default)]
    #[schemars(with = "String", extend("enum" = WAVEFORMS.map(word)))]
    waveform: WaveformName,
    /// Segments a wavelength, with waveform = "segments".
    #[schemars(extend("x-unit" = "1", "minimum" = 2, "maximum" = 32))]
    segments: Option<u32>,
    /// Pressure rise over a wavelength that the grains are pumped against, beside their weight. It acts on the section
    /// pi a^2 of the straight tube, a to the centres of the wall's spheres, as pressure_rise in results.
    #[serde(default)]
    #[schemars(extend("x-unit" = "Pa", "minimum" = -1e9, "maximum" = 1e9))]
    back_pressure: f64,
    /// How long to compute, in periods.
    #[serde(default = "ten")]
    #[schemars(extend("x-unit" = "periods", "exclusiveMinimum" = 0, "maximum" = 1e6))]
    periods: f64,
}

fn ten() -> f64 {
    10.0
}

static SCHEMA: LazyLock<Value> = LazyLock::new(|| {
    let mut schema = schema_of::<Keys>();
    schema["title"] = json!("peristalsis design");
    schema["additionalProperties"] = json!(false);
    schema
});

/// JSON schema (draft 2020-12) of the file of a design.
pub fn schema() -> Value {
    SCHEMA.clone()
}

/// Whether a text is the file of a design, not a configuration.
pub fn is_design(text: &str) -> bool {
    let file = SourceFile { name: "", text };
    document::parse_file(file, &mut Problems::default()).contains_key("grain")
}

/// The configuration of a design as TOML, which `run` computes. Its lengths are in diameters of a mean grain.
///
/// # Errors
/// Everything that is wrong in the file, with its line.
pub fn configuration_text(
    file: SourceFile<'_>,
    overrides: &[String],
) -> Result<String, ConfigurationError> {
    let mut problems = Problems::default();
    let table = file_with_overrides(file, overrides, &mut problems);
    problems.check()?;
    check_against(&SCHEMA, &table, &mut problems);
    problems.place_in(file);
    problems.check()?;
    let keys = Keys::deserialize(document::to_toml(&table))
        .expect("a file that follows the schema can be read");
    check_together(&keys, &table, &mut problems);
    problems.check()?;
    let mut text = written(&keys, file.name);
    let read =
        |text: &str| Configuration::from_toml(&format!("the computation of {}", file.name), text);
    let configuration = read(&text)?;
    // Contacts of small grains among large ones are short.
    let longest = longest_time_step(&configuration);
    if configuration.run.time_step > longest {
        text += &format!("time_step = {:?}\n", rounded(0.99 * longest, 3));
        read(&text)?;
    }
    Ok(text)
}

/// What values must be together.
fn check_together(keys: &Keys, table: &Table, problems: &mut Problems) {
    let mut refuse = |kind, key: &str, message: String, help: &str| {
        let mut problem = Problem::new(kind, message).key(key).help(help);
        if let Some(entry) = document::entry(table, key) {
            problem = problem.at(&entry.item.origin, "this value");
        }
        problems.push(problem);
    };
    let (grain, tube, drive) = (&keys.grain, &keys.tube, &keys.drive);
    let given = [
        ("grain.density", grain.density),
        ("grain.friction", grain.friction),
        ("grain.restitution", grain.restitution),
    ];
    let missing = given.into_iter().filter(|(_, value)| value.is_none());
    let missing: Vec<&str> = missing.map(|(key, _)| key).collect();
    if grain.material.is_none() && !missing.is_empty() {
        refuse(
            ProblemKind::Missing,
            "grain.diameter",
            format!("grains without grain.material need {}", missing.join(", ")),
            &format!("give them, or grain.material: {}", names().join(", ")),
        );
    }
    let largest = grain.diameter * (1.0 + grain.spread);
    if tube.diameter < largest {
        refuse(
            ProblemKind::Inconsistent,
            "tube.diameter",
            format!(
                "tube.diameter = {} is less than a grain, {}",
                tube.diameter,
                rounded(largest, 6)
            ),
            "tube.diameter is at least grain.diameter (1 + grain.spread)",
        );
    }
    if let Some(length) = tube.length.filter(|it| *it < 0.5 * tube.wavelength) {
        refuse(
            ProblemKind::Inconsistent,
            "tube.length",
            format!(
                "tube.length = {length} holds no wave of {}",
                tube.wavelength
            ),
            "tube.length is whole waves, one at least; left out, it is two",
        );
    }
    let number = number_of_grains(keys);
    if number > MOST_GRAINS as f64 {
        let waves = match tube.length {
            Some(length) => format!("tube.length = {length} m"),
            None => format!("tube.wavelength = {} m", tube.wavelength),
        };
        refuse(
            ProblemKind::Inconsistent,
            "tube.diameter",
            format!(
                "tube.diameter = {} m and {waves} hold {number:.1e} grains of {} m, more than {:.0e}",
                tube.diameter, grain.diameter, MOST_GRAINS as f64
            ),
            "lengths are in metres: 8 mm are 8e-3",
        );
    }
    let pressed = drive.back_pressure.abs() * grain.diameter;
    if let Some(stiffness) = grain.stiffness
        && pressed > stiffness
    {
        refuse(
            ProblemKind::Inconsistent,
            "grain.stiffness",
            format!(
                "grain.stiffness = {stiffness} N/m is so soft that drive.back_pressure = {} Pa would squeeze grains by more \
                 than their diameter",
                drive.back_pressure
            ),
            &format!(
                "at least {} N/m, for overlaps of {} %; left out, it is chosen so",
                rounded(pressed / OVERLAP_OF_A_LOAD, 3),
                100.0 * OVERLAP_OF_A_LOAD
            ),
        );
    }
    if drive.segments.is_some() && drive.waveform != WaveformName::Segments {
        refuse(
            ProblemKind::Conflict,
            "drive.segments",
            format!(
                "drive.segments belongs to drive.waveform = \"segments\", but here it is {:?}",
                word(drive.waveform)
            ),
            "remove drive.segments, or set drive.waveform = \"segments\"",
        );
    }
}

/// Stiffness of a contact \[N/m\] at which grains pass for solid.
fn stiffness(keys: &Keys, density: f64) -> f64 {
    let (grain, tube) = (&keys.grain, &keys.tube);
    let d = grain.diameter;
    let mass = grain_mass(density, d);
    let speed = keys.drive.frequency * tube.wavelength;
    // m c^2/4 = k xi^2/2, two grains that meet at c.
    let overlap = OVERLAP_OF_AN_IMPACT * d;
    let of_impact = 0.5 * mass * speed * speed / (overlap * overlap);
    let standing = tube.wavelength * tube.incline.to_radians().sin().abs();
    let column = tube.diameter.max(standing) / d;
    let weight = mass * keys.gravity * column;
    let pressed = keys.drive.back_pressure.abs() * d * d;
    of_impact.max(weight.max(pressed) / (OVERLAP_OF_A_LOAD * d))
}

/// Wavelengths in the tube.
fn waves(tube: &TubeKeys) -> f64 {
    let waves = |length: f64| (length / tube.wavelength).round().max(1.0);
    tube.length.map_or(2.0, waves)
}

/// Their diameters in units of the mean one.
fn sizes(grain: &GrainKeys) -> Grains {
    Grains {
        number: 0,
        diameter_min: 1.0 - grain.spread,
        diameter_max: 1.0 + grain.spread,
        ..Grains::default()
    }
}

fn number_of_grains(keys: &Keys) -> f64 {
    let (tube, d) = (&keys.tube, keys.grain.diameter);
    let (bore, length) = (tube.diameter / d, waves(tube) * tube.wavelength / d);
    let volume = 1.5 * bore * bore * length / sizes(&keys.grain).mean_cubed_diameter();
    (tube.fill * volume).round().max(1.0)
}

/// A component of a unit vector; one that is 0 but for rounding is 0.
fn component(value: f64) -> f64 {
    if value.abs() < 1e-15 { 0.0 } else { value }
}

fn written(keys: &Keys, name: &str) -> String {
    let (grain, tube, drive) = (&keys.grain, &keys.tube, &keys.drive);
    let d = grain.diameter;
    let known: Option<&Material> = grain.material.as_deref().and_then(material);
    let of = |given: Option<f64>, of_material: fn(&Material) -> f64| {
        given.or(known.map(of_material)).unwrap_or_default()
    };
    let density = of(grain.density, |it| it.density);
    let stiffness = grain
        .stiffness
        .unwrap_or_else(|| rounded(stiffness(keys, density), 3));
    let bore = tube.diameter / d;
    // Half a wall sphere is within the radius on either side.
    let radius = 0.5 * (bore + 1.0);
    let width = (1.0 - tube.occlusion) * bore + 1.0;
    let wavelength = tube.wavelength / d;
    let (waves, sizes) = (waves(tube), sizes(grain));
    let number = number_of_grains(keys);
    // a + b g, g the largest contraction and b = a - w/2.
    let largest = drive.waveform.travelling().map_or(0.0, Waveform::largest);
    let widest = (1.0 + largest) * radius - 0.5 * largest * width;
    let segments = drive.segments.unwrap_or(4);
    let is_segmented = drive.waveform == WaveformName::Segments;
    let least_rings = if is_segmented { 2 * segments } else { 2 };
    let ring = (WALL_SPHERES[0] * widest).ceil().max(6.0);
    let rings = 2.0 * (0.5 * WALL_SPHERES[1] * wavelength).ceil();
    let rings = rings.max(f64::from(least_rings));
    let angle = tube.incline.to_radians();
    let [across, along] = [angle.cos(), angle.sin()].map(component);
    // One zero, not two.
    let gravity = [0.0, 0.0 - keys.gravity * across, keys.gravity * along];
    // Dp in the unit of pressure, k/d, as a body force.
    let pressure = drive.back_pressure * d / stiffness;
    let body_force =
        -pressure * waves * PI * radius * radius / (number * sizes.mean_cubed_diameter());
    let [friction, restitution] = [
        of(grain.friction, |it| it.friction),
        of(grain.restitution, |it| it.restitution),
    ];
    let mut text = format!(
        "# The computation of {name}: lengths are in diameters of a mean grain, {d} m; radii and widths run between the\n\
         # centres of the wall's spheres.\n\n\
         [units]\ngrain_diameter = {d:?}\ndensity = {density:?}\nstiffness = {stiffness:?}\nwave_frequency = {:?}\n",
        drive.frequency
    );
    if keys.gravity > 0.0 {
        text += &format!("acceleration = {gravity:?}\n");
    }
    text += &format!(
        "\n[grains]\nnumber = {number}\ndiameter_min = {:?}\ndiameter_max = {:?}\n\n\
         [contact]\nlaw = \"linear\"\nrestitution = {restitution:?}\nstatic_friction = {friction:?}\n\n\
         [tube]\nradius = {radius:?}\nwavelength = {wavelength:?}\nwaves = {waves}\nspheres_per_ring = {ring}\n\
         rings_per_wave = {rings}\n\n\
         [drive]\ncontrol = \"strain\"\nwidth = {width:?}\nwaveform = {:?}\n",
        sizes.diameter_min,
        sizes.diameter_max,
        word(drive.waveform)
    );
    if is_segmented {
        text += &format!("segments = {segments}\n");
    }
    if body_force != 0.0 {
        text += &format!("body_force = {body_force:?}\n");
    }
    // The back pressure moves grains along a lying tube unless friction holds them.
    let weight = keys.gravity * grain_mass(density, d) / (stiffness * d);
    let settles = tube.incline == 0.0 && body_force.abs() < friction * weight;
    let state = if settles { "settled" } else { "rest" };
    let usual = Observe::default();
    let samples = samples_that_meet(rings as u32, usual.profile_bins, usual.samples_per_period);
    if samples != usual.samples_per_period {
        text += &format!("\n[observe]\nsamples_per_period = {samples}\n");
    }
    text + &format!(
        "\n[initial]\nstate = {state:?}\n\n[run]\nperiods = {:?}\n",
        drive.periods
    )
}
