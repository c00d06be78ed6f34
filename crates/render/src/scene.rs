//! A scene and the view of it.

use glam::{DVec3, Vec3};

use crate::colour::Colour;

/// How a sphere's surface looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finish {
    /// Opaque.
    Opaque,
    /// Transparent but for its rim: for spheres before a cut.
    Glass,
}

/// A sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Centre \[d\].
    pub centre: DVec3,
    /// Radius \[d\].
    pub radius: f64,
    /// Colour of its surface.
    pub colour: Colour,
    /// How its surface looks.
    pub finish: Finish,
}

/// Spheres before a background.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// The spheres, in any order.
    pub spheres: Vec<Sphere>,
    /// Colour where no sphere is.
    pub background: Colour,
}

/// A parallel projection: lengths are the same wherever they are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The point in the middle of the picture \[d\].
    pub middle: DVec3,
    /// Direction on the picture to the right, a unit vector.
    pub right: DVec3,
    /// Direction on the picture upwards, a unit vector perpendicular to `right`.
    pub up: DVec3,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Pixels a unit of length \[1/d\].
    pub scale: f64,
}

impl View {
    /// A point as the eye sees it: to the right, up and towards the eye from the picture's middle \[d\].
    pub(crate) fn seen(&self, point: DVec3) -> Vec3 {
        let towards = self.right.cross(self.up);
        let along = [self.right, self.up, towards].map(|axis| (point - self.middle).dot(axis));
        DVec3::from_array(along).as_vec3()
    }
}
