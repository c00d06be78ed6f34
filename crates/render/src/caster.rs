//! Rays that meet spheres.

use glam::Vec3;
use rayon::prelude::*;

use crate::colour::Colour;
use crate::depth_map::Disc;
use crate::error::RenderError;
use crate::glass;
use crate::light::Light;
use crate::picture::Picture;
use crate::scene::{Finish, Scene, Sphere, View};

/// Rays across and down in a pixel.
const RAYS: usize = 3;
/// Rays in a pixel.
const RAYS_A_PIXEL: usize = RAYS * RAYS;
/// Most pixels of a picture.
const MOST_PIXELS: u64 = 1 << 28;
/// Fineness of shadows: a part of the smallest sphere's radius, but not less than so many pixels.
const FINENESS: (f32, f32) = (0.13, 1.2);

/// Where a ray meets a sphere: its number, how near to the eye, and the place from the sphere's centre.
type Meeting = Option<(usize, f32, Vec3)>;

/// Draws a scene.
///
/// # Errors
/// [`RenderError::Size`] where there are no pixels, or too many.
pub fn render(scene: &Scene, view: &View) -> Result<Picture, RenderError> {
    let (width, height) = (view.width, view.height);
    let pixels = u64::from(width) * u64::from(height);
    if pixels == 0 || pixels > MOST_PIXELS {
        let most = MOST_PIXELS;
        return Err(RenderError::Size {
            width,
            height,
            most,
        });
    }
    let opaque = seen(scene, view, Finish::Opaque);
    let glass = seen(scene, view, Finish::Glass);
    let light = Light::among(&opaque, fineness(&opaque, view));
    let rows: Vec<Vec<u8>> = (0..height)
        .into_par_iter()
        .map(|row| {
            let row = Row::new(view, row, &opaque, &glass);
            draw_row(&row, &opaque, &glass, &light, scene.background)
        })
        .collect();
    Ok(Picture::new(width, height, rows.concat()))
}

/// The spheres of a finish that are in the picture or cast a shadow into it.
fn seen(scene: &Scene, view: &View, finish: Finish) -> Vec<Disc> {
    let half = 0.5 / view.scale as f32 * Vec3::new(view.width as f32, view.height as f32, 0.0);
    let is_sound = |it: &&Sphere| it.finish == finish && it.radius > 0.0 && it.centre.is_finite();
    let spheres = scene.spheres.iter().filter(is_sound);
    let discs = spheres.map(|sphere| Disc {
        centre: view.seen(sphere.centre),
        radius: sphere.radius as f32,
        colour: sphere.colour,
    });
    let is_near = |disc: &Disc| {
        let margin = 4.0 * disc.radius;
        disc.centre.x.abs() < half.x + margin && disc.centre.y.abs() < half.y + margin
    };
    discs.filter(is_near).collect()
}

fn fineness(spheres: &[Disc], view: &View) -> f32 {
    let smallest = spheres
        .iter()
        .map(|it| it.radius)
        .fold(f32::INFINITY, f32::min);
    let by_pixels = FINENESS.1 / view.scale as f32;
    by_pixels.max(FINENESS.0 * if smallest.is_finite() { smallest } else { 1.0 })
}

/// The rays of a row of pixels, and the spheres that they can meet.
struct Row {
    /// Rays across.
    across: usize,
    /// Distance of rays \[d\], and the leftmost.
    pitch: f32,
    left: f32,
    heights: [f32; RAYS],
    opaque: Vec<usize>,
    glass: Vec<usize>,
}

impl Row {
    fn new(view: &View, row: u32, opaque: &[Disc], glass: &[Disc]) -> Self {
        let pitch = 1.0 / (view.scale * RAYS as f64);
        let across = view.width as usize * RAYS;
        let down = f64::from(view.height) * RAYS as f64;
        let height = |ray: usize| {
            ((0.5 * down - (f64::from(row) * RAYS as f64 + ray as f64 + 0.5)) * pitch) as f32
        };
        let heights: [f32; RAYS] = std::array::from_fn(height);
        let meets = |sphere: &Disc| {
            sphere.centre.y - sphere.radius <= heights[0]
                && sphere.centre.y + sphere.radius >= heights[RAYS - 1]
        };
        let of = |spheres: &[Disc]| {
            let all = 0..spheres.len();
            all.filter(|&it| meets(&spheres[it])).collect()
        };
        Self {
            across,
            pitch: pitch as f32,
            left: ((0.5 - 0.5 * across as f64) * pitch) as f32,
            heights,
            opaque: of(opaque),
            glass: of(glass),
        }
    }

    /// Calls `meet` with ray, height of the sphere's surface over its centre, and place beside it, for each ray at
    /// `height` that meets the sphere.
    fn for_each_meeting(&self, sphere: &Disc, height: f32, mut meet: impl FnMut(usize, Vec3)) {
        let dy = height - sphere.centre.y;
        let room = sphere.radius * sphere.radius - dy * dy;
        if room <= 0.0 {
            return;
        }
        let half = room.sqrt();
        let ray = |x: f32| (x - self.left) / self.pitch;
        let first = ray(sphere.centre.x - half).ceil().max(0.0) as usize;
        let end = (ray(sphere.centre.x + half).floor() + 1.0).clamp(0.0, self.across as f32);
        for ray in first..end as usize {
            let dx = self.left + ray as f32 * self.pitch - sphere.centre.x;
            let depth = room - dx * dx;
            if depth > 0.0 {
                meet(ray, Vec3::new(dx, dy, depth.sqrt()));
            }
        }
    }
}

/// The pixels of a row as bytes.
fn draw_row(
    row: &Row,
    opaque: &[Disc],
    glass: &[Disc],
    light: &Light,
    background: Colour,
) -> Vec<u8> {
    let mut nearest: Vec<Meeting> = vec![None; row.across * RAYS];
    let mut before: Vec<Meeting> = vec![None; row.across * RAYS];
    for (line, height) in row.heights.iter().enumerate() {
        let rays = line * row.across..(line + 1) * row.across;
        let (nearest, before) = (&mut nearest[rays.clone()], &mut before[rays]);
        meet(row, *height, opaque, &row.opaque, nearest);
        meet(row, *height, glass, &row.glass, before);
    }
    let pixel = |pixel: usize| {
        let ray = |it: usize| it / RAYS * row.across + pixel * RAYS + it % RAYS;
        let met: [Meeting; RAYS_A_PIXEL] = std::array::from_fn(|it| nearest[ray(it)]);
        let mut colours = behind(&met, opaque, light, background);
        for (it, colour) in colours.iter_mut().enumerate() {
            let depth = met[it].map_or(f32::NEG_INFINITY, |(_, depth, _)| depth);
            if let Some((index, near, beside)) = before[ray(it)]
                && near > depth
            {
                let sphere = &glass[index];
                *colour = glass::before(*colour, beside / sphere.radius, sphere.colour);
            }
        }
        Colour(colours.iter().sum::<Vec3>() / RAYS_A_PIXEL as f32).to_srgb()
    };
    (0..row.across / RAYS).flat_map(pixel).collect()
}

/// Keeps those of the spheres, by their numbers, that are nearer than what the rays at a height have met.
fn meet(row: &Row, height: f32, spheres: &[Disc], numbers: &[usize], nearest: &mut [Meeting]) {
    for &index in numbers {
        let sphere = &spheres[index];
        row.for_each_meeting(sphere, height, |ray, beside| {
            let depth = sphere.centre.z + beside.z;
            if nearest[ray].is_none_or(|(_, before, _)| depth > before) {
                nearest[ray] = Some((index, depth, beside));
            }
        });
    }
}

/// The colour of each ray of a pixel; the light on a sphere is computed once for all its rays.
fn behind(
    met: &[Meeting; RAYS_A_PIXEL],
    opaque: &[Disc],
    light: &Light,
    background: Colour,
) -> [Vec3; RAYS_A_PIXEL] {
    let mut colours = [background.0; RAYS_A_PIXEL];
    let mut done = [false; RAYS_A_PIXEL];
    for first in 0..RAYS_A_PIXEL {
        let Some((index, ..)) = met[first].filter(|_| !done[first]) else {
            continue;
        };
        let is_same = |it: usize| met[it].is_some_and(|(other, ..)| other == index);
        let rays = (first..RAYS_A_PIXEL).filter(|&it| is_same(it));
        let places = rays.filter_map(|it| met[it].map(|(_, _, beside)| beside));
        let normal = places.sum::<Vec3>().normalize_or(Vec3::Z);
        let sphere = &opaque[index];
        let place = sphere.centre + normal * sphere.radius;
        let seen = light.shade(place, normal, sphere.colour);
        for it in (first..RAYS_A_PIXEL).filter(|&it| is_same(it)) {
            (colours[it], done[it]) = (seen, true);
        }
    }
    colours
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    fn sphere(x: f64, depth: f64, colour: Colour, finish: Finish) -> Sphere {
        Sphere {
            centre: DVec3::new(x, 0.0, depth),
            radius: 0.5,
            colour,
            finish,
        }
    }

    fn front(width: u32) -> View {
        View {
            middle: DVec3::ZERO,
            right: DVec3::X,
            up: DVec3::Y,
            width,
            height: 40,
            scale: 20.0,
        }
    }

    const WHITE: [u8; 3] = [255; 3];

    fn on_white(spheres: Vec<Sphere>) -> Scene {
        let background = Colour::srgb(255, 255, 255);
        Scene {
            spheres,
            background,
        }
    }

    #[test]
    fn the_nearer_sphere_is_seen_and_nothing_beside_them() {
        let (red, blue) = (Colour::srgb(200, 30, 30), Colour::srgb(30, 30, 200));
        for (red_depth, expected) in [(1.0, 0), (-1.0, 2)] {
            let red = sphere(0.0, red_depth, red, Finish::Opaque);
            let scene = on_white(vec![red, sphere(0.0, 0.0, blue, Finish::Opaque)]);
            let picture = render(&scene, &front(60)).unwrap();
            let middle = picture.pixel(30, 20);
            assert!(middle[expected] > 2 * middle[2 - expected], "{middle:?}");
            // A sphere of diameter 1 is 20 pixels across.
            assert_ne!(picture.pixel(21, 20), WHITE);
            assert_eq!(picture.pixel(18, 20), WHITE);
            assert_eq!(picture.pixel(30, 8), WHITE);
        }
    }

    #[test]
    fn glass_lets_what_is_behind_through() {
        let (red, grey) = (Colour::srgb(200, 30, 30), Colour::srgb(180, 180, 180));
        let mut scene = on_white(vec![sphere(0.0, 0.0, red, Finish::Opaque)]);
        let plain = render(&scene, &front(60)).unwrap();
        scene.spheres.push(sphere(0.3, 2.0, grey, Finish::Glass));
        let veiled = render(&scene, &front(60)).unwrap();
        assert_ne!(plain.pixel(36, 20), veiled.pixel(36, 20));
        assert!(veiled.pixel(36, 20)[0] > 2 * veiled.pixel(36, 20)[2]);
        // Glass behind an opaque surface is not seen.
        scene.spheres[1].centre.z = -2.0;
        let hidden = render(&scene, &front(60)).unwrap();
        assert_eq!(plain.pixel(36, 20), hidden.pixel(36, 20));
    }

    #[test]
    fn spheres_shade_their_neighbours() {
        let white = Colour::srgb(230, 230, 230);
        let mut scene = on_white(vec![sphere(0.0, 0.0, white, Finish::Opaque)]);
        let alone = render(&scene, &front(60)).unwrap();
        scene.spheres.push(sphere(1.0, 0.0, white, Finish::Opaque));
        let beside = render(&scene, &front(60)).unwrap();
        let (one, other) = (alone.pixel(36, 20)[0], beside.pixel(36, 20)[0]);
        assert!(u32::from(other) + 5 < u32::from(one), "{one} {other}");
    }

    #[test]
    fn a_picture_has_pixels_and_not_too_many() {
        let scene = Scene {
            spheres: Vec::new(),
            background: Colour::srgb(1, 2, 3),
        };
        let mut view = front(3);
        let picture = render(&scene, &view).unwrap();
        assert_eq!((picture.width(), picture.height()), (3, 40));
        assert_eq!(picture.pixel(2, 39), [1, 2, 3]);
        assert_eq!(picture.pixels(), [1, 2, 3].repeat(120));
        for (width, height) in [(0, 4), (1 << 20, 1 << 20)] {
            (view.width, view.height) = (width, height);
            let refused = render(&scene, &view).unwrap_err().to_string();
            assert!(refused.contains("pixels"), "{refused}");
        }
    }
}
