//! Draws every figure from made-up data into a folder: `cargo run --example gallery -- FOLDER`.

mod charts;

use std::error::Error;
use std::f64::consts::TAU;
use std::fs;
use std::path::PathBuf;

use peristalsis_figures::{
    Drawing, FlowFigure, LateMean, NewtonianReference, Profile, ProfileFigure, Scale, Series,
    SnapshotFigure, SnapshotGrain, SnapshotSphere, SnapshotStack, SnapshotWall, Transition,
    WallFigure, Width,
};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(
        std::env::args()
            .nth(1)
            .ok_or("which folder shall the figures go to?")?,
    );
    fs::create_dir_all(&folder)?;
    let save = |name: &str, drawing: Drawing| -> Result<(), Box<dyn Error>> {
        fs::write(folder.join(format!("{name}.svg")), drawing.svg())?;
        fs::write(folder.join(format!("{name}.png")), drawing.png()?)?;
        Ok(())
    };
    save("flow_short", flow(40, Width::SingleColumn)?)?;
    save("flow_long", flow(5000, Width::DoubleColumn)?)?;
    save("flow_bare", bare_flow()?)?;
    save("back_flow", back_flow()?)?;
    save("profile", profile(24, Scale::Linear)?)?;
    save("profile_fine", profile(200, Scale::Logarithmic)?)?;
    save("wall", wall()?)?;
    save("snapshot_long", snapshot(100.0, Width::DoubleColumn)?)?;
    save("snapshot_short", snapshot(20.0, Width::SingleColumn)?)?;
    save("snapshot_wide", wide_snapshot()?)?;
    save("snapshot_stack", stacked_snapshots(Width::SingleColumn)?)?;
    save(
        "snapshot_stack_wide",
        stacked_snapshots(Width::DoubleColumn)?,
    )?;
    for (name, drawing) in charts::all()? {
        save(&name, drawing)?;
    }
    Ok(())
}

/// Numbers between -1 and 1 that look random and are always the same.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// A run that jams after a third of its time.
fn flow(periods: usize, width: Width) -> Result<Drawing, Box<dyn Error>> {
    let mut noise = Noise(7);
    let onset = 0.36 * periods as f64;
    let level = |period: f64| {
        0.2 + 0.06 * libm::sin(period / 9.0) + 0.76 / (1.0 + libm::exp(-(period - onset) / 0.9))
    };
    let mut samples = (Vec::new(), Vec::new());
    let mut averages = (Vec::new(), Vec::new());
    for period in 0..periods {
        let mut sum = 0.0;
        for part in 0..20 {
            let time = period as f64 + f64::from(part) / 20.0;
            let jammed = time > onset;
            let value = level(time)
                + (if jammed { 0.015 } else { 0.07 })
                    * (noise.next() + libm::sin(TAU * 2.0 * time));
            samples.0.push(time);
            samples.1.push(if time < 0.2 {
                value * time * 5.0
            } else {
                value
            });
            sum += value;
        }
        averages.0.push(period as f64 + 0.5);
        averages.1.push(sum / 20.0);
    }
    let figure = FlowFigure {
        title: "*w* = 2.75 *d*, *ε\u{307}* = 0.05, *ρ* = 0.15, *N* = 202",
        samples: Series {
            x: &samples.0,
            y: &samples.1,
        },
        averages: Some(Series {
            x: &averages.0,
            y: &averages.1,
        }),
        threshold: Some(0.5),
        transition: Some(Transition {
            period: onset,
            time: onset * 20.0,
            unit: "(*m*/*k*)^{1/2}",
        }),
        newtonian: Some(NewtonianReference {
            ratio: 0.052,
            clear_bore: Some(0.113),
        }),
        late_mean: Some(LateMean {
            mean: 0.961,
            error: 0.012,
        }),
        width,
    };
    Ok(figure.draw()?)
}

/// The least that the figure needs, with a gap in the samples.
fn bare_flow() -> Result<Drawing, Box<dyn Error>> {
    let time: Vec<f64> = (0..400).map(|step| f64::from(step) / 20.0).collect();
    let ratio: Vec<f64> = time
        .iter()
        .map(|time| {
            if (8.0..9.0).contains(time) {
                f64::NAN
            } else {
                0.3 + 0.1 * libm::sin(TAU * time)
            }
        })
        .collect();
    Ok(FlowFigure {
        samples: Series {
            x: &time,
            y: &ratio,
        },
        ..FlowFigure::default()
    }
    .draw()?)
}

/// A stress-controlled run that starts jammed and turns back.
fn back_flow() -> Result<Drawing, Box<dyn Error>> {
    let mut noise = Noise(3);
    let time: Vec<f64> = (0..800).map(|step| f64::from(step) / 40.0).collect();
    let level = |time: f64| 0.74 - 0.83 / (1.0 + libm::exp(-(time - 9.0) / 0.6));
    let ratio: Vec<f64> = time
        .iter()
        .map(|&time| level(time) + 0.06 * noise.next())
        .collect();
    let middles: Vec<f64> = (0..20).map(|period| f64::from(period) + 0.5).collect();
    let means: Vec<f64> = middles.iter().map(|&middle| level(middle)).collect();
    let figure = FlowFigure {
        title: "*f^P* = 0.004 *Yd*^{\\*2}, *ε\u{307}* = 4.01×10^{−3}, *n* = 0.71, *N* = 1093",
        samples: Series {
            x: &time,
            y: &ratio,
        },
        averages: Some(Series {
            x: &middles,
            y: &means,
        }),
        threshold: Some(0.5),
        transition: Some(Transition {
            period: 8.4,
            time: 2095.0,
            unit: "*t*\\*",
        }),
        late_mean: Some(LateMean {
            mean: -0.09,
            error: 0.008,
        }),
        ..FlowFigure::default()
    };
    Ok(figure.draw()?)
}

fn profile(bins: usize, temperature_scale: Scale) -> Result<Drawing, Box<dyn Error>> {
    let mut noise = Noise(11);
    let position: Vec<f64> = (0..bins)
        .map(|bin| (bin as f64 + 0.5) / bins as f64)
        .collect();
    let belly: Vec<f64> = position
        .iter()
        .map(|position| libm::cos(TAU * (position - 0.5)))
        .collect();
    let column =
        |of: &dyn Fn(f64) -> f64| belly.iter().map(|&belly| of(belly)).collect::<Vec<f64>>();
    let radius = column(&|belly| 3.5 + 1.1 * belly);
    let mut density = column(&|belly| 0.55 + 0.4 * belly);
    density
        .iter_mut()
        .for_each(|density| *density += 0.02 * noise.next());
    let velocity = column(&|belly| 0.15 - 0.42 * belly);
    let temperature = column(&|belly| 0.02 * libm::exp(-2.5 * belly));
    let density_error = vec![0.03; bins];
    let velocity_error = vec![0.04; bins];
    let temperature_error: Vec<f64> = temperature
        .iter()
        .map(|temperature| 0.15 * temperature)
        .collect();
    let profile = |value, error, label| Profile {
        position: &position,
        value,
        error,
        label,
    };
    let figure = ProfileFigure {
        title: "unjammed flow, *f^P* = 0.004 *Y d*^2, periods 40 to 60",
        wall_radius: profile(&radius, None, "*r*/*d*"),
        density: profile(&density, Some(&density_error), "density, *nd*^3"),
        axial_velocity: profile(&velocity, Some(&velocity_error), "velocity, *v_z*/*c*"),
        temperature: profile(
            &temperature,
            Some(&temperature_error),
            "temperature, *θ*/*c*^2",
        ),
        temperature_scale,
        wall_pressure: None,
        wall_shear: None,
        width: Width::SingleColumn,
    };
    Ok(figure.draw()?)
}

fn wall() -> Result<Drawing, Box<dyn Error>> {
    let phase: Vec<f64> = (0..100).map(|step| f64::from(step) / 99.0).collect();
    let mean: Vec<f64> = phase
        .iter()
        .map(|phase| 3.5 + 1.2 * libm::sin(TAU * phase) - 0.15 * libm::cos(2.0 * TAU * phase))
        .collect();
    let least: Vec<f64> = mean
        .iter()
        .map(|radius| radius - 0.06 * radius * radius / 3.5)
        .collect();
    let largest: Vec<f64> = mean
        .iter()
        .map(|radius| radius + 0.08 * radius * radius / 3.5)
        .collect();
    let figure = WallFigure {
        title: "*k_w* = 0.018 *Yd*, *f^P* = 0.005 *Yd*^2",
        phase: &phase,
        mean: &mean,
        least: &least,
        largest: &largest,
        reference: Some(3.5),
        length_unit: "*d*",
        width: Width::SingleColumn,
    };
    Ok(figure.draw()?)
}

/// Radius of a made-up wall and its spheres, in staggered rings.
fn wall_spheres(
    mean: f64,
    amplitude: f64,
    wavelength: f64,
    length: f64,
    ring: usize,
    spacing: f64,
) -> Vec<SnapshotSphere> {
    let rings = (length / spacing).round() as usize;
    (0..rings)
        .flat_map(|index| {
            let along = index as f64 * length / rings as f64;
            let radius = mean + amplitude * libm::sin(TAU * along / wavelength);
            (0..ring).map(move |place| {
                let angle = TAU * (place as f64 + 0.5 * (index % 2) as f64) / ring as f64;
                SnapshotSphere {
                    along,
                    across: radius * libm::cos(angle),
                    depth: radius * libm::sin(angle),
                    diameter: 1.0,
                }
            })
        })
        .collect()
}

/// Grains at random places that keep apart, within a wavy tube.
fn grains(
    count: usize,
    mean: f64,
    amplitude: f64,
    wavelength: f64,
    length: f64,
    least_distance: f64,
) -> Vec<SnapshotGrain> {
    let mut noise = Noise(5);
    let mut grains: Vec<SnapshotGrain> = Vec::new();
    let mut trials = 0;
    while grains.len() < count && trials < 200_000 {
        trials += 1;
        let along = (noise.next() + 1.0) / 2.0 * length;
        let wave = libm::sin(TAU * along / wavelength);
        let bore = mean + amplitude * wave - 1.0;
        let (across, depth) = (mean * noise.next() * 1.4, mean * noise.next() * 1.4);
        let free = grains.iter().all(|other| {
            let (dz, dx, dy) = (
                other.sphere.along - along,
                other.sphere.across - across,
                other.sphere.depth - depth,
            );
            dz * dz + dx * dx + dy * dy > least_distance * least_distance
        });
        if bore > 0.0 && across * across + depth * depth < bore * bore && free {
            let sphere = SnapshotSphere {
                along,
                across,
                depth,
                diameter: 0.9 + 0.1 * noise.next(),
            };
            grains.push(SnapshotGrain {
                sphere,
                axial_velocity: 0.2 - 0.9 * wave + 0.3 * noise.next(),
            });
        }
    }
    grains
}

fn snapshot(length: f64, width: Width) -> Result<Drawing, Box<dyn Error>> {
    let spheres = wall_spheres(1.9, 0.5, 10.0, length, 12, 0.714);
    let grains = grains((length * 2.1) as usize, 2.0, 0.5, 10.0, length, 0.75);
    let figure = SnapshotFigure {
        title: "*w* = 2.75 *d*, *ε\u{307}* = 0.05, *ρ* = 0.15, *t* = 300 (*m*/*k*)^{1/2}",
        grains: &grains,
        wall: SnapshotWall::Spheres(&spheres),
        length,
        period: Some(length),
        width,
        ..SnapshotFigure::default()
    };
    Ok(figure.draw()?)
}

fn wide_snapshot() -> Result<Drawing, Box<dyn Error>> {
    let along: Vec<f64> = (0..=400).map(|step| f64::from(step) / 10.0).collect();
    let radius: Vec<f64> = along
        .iter()
        .map(|along| 3.5 + 1.4 * libm::sin(TAU * along / 20.0) - 0.5)
        .collect();
    let grains = grains(900, 3.5, 1.4, 20.0, 40.0, 0.85);
    let figure = SnapshotFigure {
        title: "*f^P* = 0.004 *Yd*^2, *ε\u{307}* = 4.01×10^{−3}",
        grains: &grains,
        wall: SnapshotWall::Outline(Series {
            x: &along,
            y: &radius,
        }),
        length: 40.0,
        period: Some(40.0),
        ..SnapshotFigure::default()
    };
    Ok(figure.draw()?)
}

/// Unjammed flow above jammed, two of ten waves of each.
fn stacked_snapshots(width: Width) -> Result<Drawing, Box<dyn Error>> {
    let spheres = wall_spheres(1.9, 0.5, 10.0, 20.0, 12, 0.714);
    let unjammed = grains(45, 2.0, 0.5, 10.0, 20.0, 0.75);
    let mut jammed = unjammed.clone();
    for grain in &mut jammed {
        grain.axial_velocity = 0.95 + 0.1 * grain.sphere.depth;
    }
    let snapshot = |grains| SnapshotFigure {
        grains,
        wall: SnapshotWall::Spheres(&spheres),
        length: 20.0,
        period: Some(100.0),
        wavelength: Some(10.0),
        ..SnapshotFigure::default()
    };
    let figure = SnapshotStack {
        title: "*w* = 2.75 *d*, *ε\u{307}* = 0.05, *ρ* = 0.15",
        snapshots: &[
            ("(a)  unjammed, *t*/*T* = 3", snapshot(&unjammed)),
            ("(b)  jammed, *t*/*T* = 40", snapshot(&jammed)),
        ],
        width,
    };
    Ok(figure.draw()?)
}
