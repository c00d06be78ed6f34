//! Pictures of spheres without a display: spheres in, pixels out.
//!
//! [`Scene`] holds the spheres, [`View`] says from where and how finely they are seen, [`render`] casts a ray a subpixel
//! (spheres are met analytically, so that no mesh is ever seen), and lights what it meets: ambient occlusion and soft
//! shadows from the solid angles of the spheres around, exact enough to be free of noise. [`Picture::png`] encodes it.

mod caster;
mod colour;
mod error;
mod light;
mod picture;
mod scene;

pub use caster::render;
pub use colour::{Colour, diverging};
pub use error::RenderError;
pub use picture::Picture;
pub use scene::{Finish, Scene, Sphere, View};
