//! Pictures of spheres without a display: spheres in, pixels out.
//!
//! [`Scene`] holds the spheres, [`View`] says from where and how finely they are seen, [`render`] casts a ray a subpixel
//! (spheres are met analytically, so that no mesh is ever seen), and lights what it meets from a sky and a wide lamp, with
//! the shadows of everything: ambient occlusion and soft shadows that are free of noise. [`FilmFormat`] makes films of
//! pictures.

#![forbid(unsafe_code)]

mod caster;
mod colour;
mod depth_map;
mod error;
mod film;
mod glass;
mod light;
mod picture;
mod scene;

pub use caster::render;
pub use colour::Colour;
pub use error::RenderError;
pub use film::{Film, FilmFormat, FilmPlan};
pub use picture::Picture;
pub use scene::{Finish, Scene, Sphere, View};
