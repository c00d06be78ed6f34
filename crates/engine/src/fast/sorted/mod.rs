//! The fast kernel for equal frictionless grains in a tube with a prescribed wall.
//!
//! The grains are kept in the order of z, in a wide tube strip by strip along it. A grain's partners are then few places
//! that follow one another, so that eight grains meet eight partners at a time without gathering: a list for each eight
//! grains says where their partners begin. Copies of the grains near the ends, one period on, close the tube. Order and
//! list are made anew when grains may have come closer by more than the skin.
//!
//! Forces are added up tile by tile, and the tiles in their order, so that neither the number of threads nor the set of
//! instructions changes a bit.

mod candidates;
mod distances;
mod forces;
mod keys;
mod listing;
mod motion;
mod order;
mod pairs;
mod rows;
mod state;
mod stepping;
mod strips;
mod tile;
mod wall;

pub use self::order::Sorting;
pub(crate) use self::state::Sorted;
