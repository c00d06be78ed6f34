//! How near to a distant lamp the nearest sphere is, over a grid of parallel rays.

use glam::Vec3;

use crate::colour::Colour;

/// Most cells of a map.
const MOST_CELLS: f32 = (1 << 18) as f32;
/// How far a point is lifted off its own surface before it is looked for \[cells\].
const LIFT: f32 = 1.6;

/// A sphere as the eye sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Disc {
    pub(crate) centre: Vec3,
    pub(crate) radius: f32,
    pub(crate) colour: Colour,
}

/// Depths of the nearest surface along one direction.
#[derive(Debug)]
pub(crate) struct DepthMap {
    towards: Vec3,
    right: Vec3,
    up: Vec3,
    /// Side of a cell \[d\].
    cell: f32,
    /// Where the first cell begins \[d\].
    left: f32,
    bottom: f32,
    columns: usize,
    rows: usize,
    /// Place along the direction, row by row; minus infinity where nothing is.
    depth: Vec<f32>,
}

impl DepthMap {
    /// The map of spheres for light from `towards`, with cells of a side \[d\], or larger where they would be too many.
    pub(crate) fn new(towards: Vec3, spheres: &[Disc], cell: f32) -> Self {
        let (right, up) = towards.any_orthonormal_pair();
        let mut low = Vec3::INFINITY;
        let mut high = Vec3::NEG_INFINITY;
        for sphere in spheres {
            let place = Vec3::new(sphere.centre.dot(right), sphere.centre.dot(up), 0.0);
            low = low.min(place - sphere.radius);
            high = high.max(place + sphere.radius);
        }
        let size = (high - low).max(Vec3::ZERO);
        let cell = cell.max((size.x * size.y / MOST_CELLS).sqrt()).max(1e-6);
        // One cell more on each side, so that what is looked up between four cells always finds them.
        let cells = |length: f32| (length / cell).ceil().min(MOST_CELLS) as usize + 3;
        let mut map = Self {
            towards,
            right,
            up,
            cell,
            left: low.x - cell,
            bottom: low.y - cell,
            columns: cells(size.x),
            rows: cells(size.y),
            depth: Vec::new(),
        };
        if spheres.is_empty() {
            (map.left, map.bottom) = (0.0, 0.0);
        }
        map.depth = vec![f32::NEG_INFINITY; map.columns * map.rows];
        for sphere in spheres {
            map.add(sphere);
        }
        map
    }

    fn add(&mut self, sphere: &Disc) {
        let x = sphere.centre.dot(self.right) - self.left;
        let y = sphere.centre.dot(self.up) - self.bottom;
        let depth = sphere.centre.dot(self.towards);
        let square = sphere.radius * sphere.radius;
        let index = |place: f32| (place / self.cell - 0.5).max(0.0);
        let first = index(y - sphere.radius).ceil() as usize;
        let last = (index(y + sphere.radius) as usize).min(self.rows - 1);
        for row in first..=last {
            let dy = (row as f32 + 0.5) * self.cell - y;
            let room = square - dy * dy;
            if room <= 0.0 {
                continue;
            }
            let half = room.sqrt();
            let start = index(x - half).ceil() as usize;
            let end = (index(x + half) as usize).min(self.columns - 1);
            if start > end {
                continue;
            }
            let cells = &mut self.depth[row * self.columns + start..=row * self.columns + end];
            for (column, cell) in (start..).zip(cells) {
                let dx = (column as f32 + 0.5) * self.cell - x;
                *cell = cell.max(depth + (room - dx * dx).max(0.0).sqrt());
            }
        }
    }

    /// Part of the light from this direction that reaches a point of a surface, 0 to 1.
    #[inline]
    pub(crate) fn visible(&self, point: Vec3, normal: Vec3) -> f32 {
        let point = point + normal * (LIFT * self.cell);
        let x = ((point.dot(self.right) - self.left) / self.cell - 0.5).max(0.0);
        let y = ((point.dot(self.up) - self.bottom) / self.cell - 0.5).max(0.0);
        let (column, row) = (x as usize, y as usize);
        if column + 1 >= self.columns || row + 1 >= self.rows {
            return 1.0;
        }
        let depth = point.dot(self.towards);
        let at = row * self.columns + column;
        let lit = |index: usize| f32::from(u8::from(self.depth[index] <= depth));
        let (beside, above) = (x - column as f32, y - row as f32);
        let lower = lit(at) + beside * (lit(at + 1) - lit(at));
        let next = at + self.columns;
        let upper = lit(next) + beside * (lit(next + 1) - lit(next));
        lower + above * (upper - lower)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sphere_hides_what_is_behind_it_and_nothing_else() {
        let sphere = Disc {
            centre: Vec3::new(0.3, -0.2, 2.0),
            radius: 0.5,
            colour: Colour(Vec3::ONE),
        };
        for towards in [
            Vec3::Z,
            Vec3::new(0.6, 0.0, 0.8),
            Vec3::new(-0.6, 0.64, 0.48),
        ] {
            let map = DepthMap::new(towards, &[sphere], 0.02);
            let seen = |place: Vec3| map.visible(place, towards);
            let (beside, _) = towards.any_orthonormal_pair();
            assert_eq!(seen(sphere.centre - towards), 0.0);
            assert_eq!(seen(sphere.centre + towards), 1.0);
            assert_eq!(seen(sphere.centre - towards + 0.45 * beside), 0.0);
            assert_eq!(seen(sphere.centre - towards + 0.55 * beside), 1.0);
            // Its own surface towards the lamp is lit, the other side is not.
            assert_eq!(seen(sphere.centre + 0.5 * towards), 1.0);
            assert_eq!(map.visible(sphere.centre - 0.5 * towards, -towards), 0.0);
        }
    }

    #[test]
    fn nothing_hides_nothing_and_maps_stay_small() {
        assert_eq!(
            DepthMap::new(Vec3::Z, &[], 0.1).visible(Vec3::ONE, Vec3::X),
            1.0
        );
        let far = [-1e4, 1e4].map(|x| Disc {
            centre: Vec3::new(x, x, 0.0),
            radius: 0.5,
            colour: Colour(Vec3::ONE),
        });
        assert!(DepthMap::new(Vec3::Z, &far, 0.01).depth.len() < 2 << 18);
    }
}
