//! Cohesion of two spheres: a constant pull within reach, or the adhesion of Johnson, Kendall and Roberts.

use core::f64::consts::PI;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Contact, NormalForce, NormalLaw};
use crate::real::Real;

/// Attraction of touching spheres, of one of two kinds.
///
/// Linear: f_n - f_c, f_c = 4 R_ij (cohesion_force), constant while the spheres overlap and falling linearly to 0 where
/// they are cohesion_range apart. The pull-off force is f_c. It is proportional to R_ij, as for wet grains and for small hard grains
/// (Derjaguin, Mueller & Toporov). Making and breaking a contact loses no energy.
///
/// JKR (surface energy gamma > 0, with the Hertz law): xi = a^2/R_ij - (2 pi w a/E*)^(1/2),
/// f_n = 4 E* a^3/(3 R_ij) - (8 pi w E* a^3)^(1/2), a radius of contact \[d\], E* = Y/(2 (1 - nu^2)), w = 2 gamma the work of
/// adhesion. A contact is made where the spheres touch, xi = 0, with f_n = -8/9 of the pull-off force 3 pi gamma R_ij, and
/// breaks where [`PullOff`] says. Johnson, Kendall & Roberts, Proc. R. Soc. A 324, 301 (1971); Thornton & Ning, Powder
/// Technol. 99, 154 (1998). The Hertz law damps as if the spheres overlapped by a^2/R_ij.
///
/// Friction and rolling resistance are bounded by the repulsive part of f_n (linear), or by f_n + 6 pi gamma R_ij (JKR).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Cohesion {
    /// Linear cohesion: the force f_c that parts two grains of diameter 1; for others 4 R_ij f_c, R_ij the reduced radius.
    /// 0: none.
    #[schemars(extend("x-unit" = "m d t^-2", "minimum" = 0, "maximum" = 1e12))]
    pub cohesion_force: f64,
    /// Gap between surfaces at which linear cohesion ends; 0: it acts between spheres that overlap.
    #[schemars(extend("x-unit" = "d", "minimum" = 0, "maximum" = 1))]
    pub cohesion_range: f64,
    /// Surface energy gamma of JKR cohesion, half the work of adhesion: the force that parts two spheres is
    /// 3 pi gamma R_ij, R_ij the reduced radius. Needs the Hertz law. 0: none. Softer grains than the real ones stick
    /// in faster impacts: gamma/Y^(2/5) kept as it is keeps the speed up to which they stick, gamma alone the pull-off force.
    #[schemars(extend("x-unit" = "m t^-2", "minimum" = 0, "maximum" = 1e12))]
    pub surface_energy: f64,
    /// Where the neck of a JKR contact breaks.
    #[serde(skip_serializing_if = "PullOff::is_default")]
    pub pull_off: PullOff,
}

/// The gap at which the neck of a JKR contact breaks when the spheres are drawn apart.
///
/// The pull grows with the gap up to the pull-off force and then falls. Under a fixed load the neck breaks there; between
/// fixed grips it is drawn out until it has no equilibrium left. Maugis & Barquins, J. Phys. D 11, 1989 (1978).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PullOff {
    /// Displacement control, fixed grips: it breaks where its gap can grow no more, xi = -(3/4) (pi^2 w^2 R_ij/E*^2)^(1/3),
    /// at 5/9 of the pull-off force. Making and breaking loses 7.09 (w^5 R_ij^4/E*^2)^(1/3).
    #[default]
    Displacement,
    /// Force control, fixed load: it breaks at the pull-off force, at 0.48 of that gap. Making and breaking loses
    /// 3.50 (w^5 R_ij^4/E*^2)^(1/3). LAMMPS has this.
    Force,
}

impl PullOff {
    fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// y where the neck breaks: y^2 = a/a_0, a_0 the radius of contact where displacement control breaks it.
    fn root(self) -> f64 {
        match self {
            Self::Displacement => 1.0,
            Self::Force => CUBE_ROOT_OF_3,
        }
    }

    /// Gap where the neck breaks, 4 y - y^4 \[xi_0\].
    fn gap(self) -> f64 {
        match self {
            Self::Displacement => 3.0,
            Self::Force => CUBE_ROOT_OF_3,
        }
    }
}

/// A JKR contact in units of its own: lengths of xi_0 = (pi w)^(2/3) R_ij^(1/3)/(4 E*^(2/3)), forces of the pull-off force.
#[derive(Clone, Copy)]
struct Scale<R> {
    /// xi_0 \[d\]
    length: R,
    /// 3 pi gamma R_ij \[m d/t^2\]
    pull_off: R,
}

/// y^4 at first touch: y^3 = 4 there.
const TOUCH: f64 = 6.349_604_207_872_798;
/// y where the pull is largest: f_n = y^6/9 - 2 y^3/3 pull-off forces, which is least at y^3 = 3.
const CUBE_ROOT_OF_3: f64 = 1.442_249_570_307_408_3;

impl Cohesion {
    /// This attraction; `None` where cohesion_force and surface_energy are both 0.
    pub fn given(self) -> Option<Self> {
        (self.cohesion_force > 0.0 || self.surface_energy > 0.0).then_some(self)
    }

    /// Whether it is the adhesion of Johnson, Kendall and Roberts.
    pub fn is_jkr(&self) -> bool {
        self.surface_energy > 0.0
    }

    /// Gap at which a contact breaks \[d\].
    pub fn range<R: Real>(&self, normal: &impl NormalLaw, reduced_radius: R) -> R {
        match self.is_jkr() {
            true => self.scale(normal, reduced_radius).length * R::splat(self.pull_off.gap()),
            false => R::splat(self.cohesion_range),
        }
    }

    /// The force that parts two spheres slowly \[m d/t^2\].
    pub fn pull_off<R: Real>(&self, reduced_radius: R) -> R {
        let per_radius = match self.is_jkr() {
            true => 3.0 * PI * self.surface_energy,
            false => 4.0 * self.cohesion_force,
        };
        reduced_radius * R::splat(per_radius)
    }

    /// Energy that is lost when a contact that was made breaks, and by which parting costs more than meeting gave.
    pub(super) fn bond<R: Real>(&self, normal: &impl NormalLaw, reduced_radius: R) -> R {
        match self.is_jkr() {
            true => energy(
                self.scale(normal, reduced_radius),
                R::splat(self.pull_off.root()),
            ),
            false => R::splat(0.0),
        }
    }

    /// Force along n with the attraction, and the force that bounds friction.
    pub(super) fn force<R: Real>(
        &self,
        normal: &impl NormalLaw,
        contact: &Contact<R>,
    ) -> (NormalForce<R>, R) {
        match self.is_jkr() {
            true => self.adhesion(normal, contact),
            false => self.constant_pull(normal, contact),
        }
    }

    fn constant_pull<R: Real>(
        &self,
        normal: &impl NormalLaw,
        contact: &Contact<R>,
    ) -> (NormalForce<R>, R) {
        let zero = R::splat(0.0);
        let Contact {
            overlap,
            reduced_radius,
            ..
        } = *contact;
        let touch = zero.less(overlap);
        let law = normal.force(
            overlap.positive_part(),
            contact.normal_velocity(),
            reduced_radius,
        );
        let repulsion = |force| R::select(touch, force, zero);
        let (most, range) = (self.pull_off(reduced_radius), R::splat(self.cohesion_range));
        // Within the range: the part of it that is left.
        let left = (range + overlap.min(zero)).positive_part();
        let part = R::select(touch, R::splat(1.0), left / range);
        let attraction = most * part;
        let stored = most * (R::splat(0.5) * part * left + overlap.positive_part());
        let force = NormalForce {
            force: repulsion(law.force) - attraction,
            elastic_force: repulsion(law.elastic_force) - attraction,
            energy: repulsion(law.energy) - stored,
        };
        (force, repulsion(law.force).positive_part())
    }

    fn adhesion<R: Real>(
        &self,
        normal: &impl NormalLaw,
        contact: &Contact<R>,
    ) -> (NormalForce<R>, R) {
        let scale = self.scale(normal, contact.reduced_radius);
        let y = root(contact.overlap / scale.length);
        let squared = y * y;
        let apparent = scale.length * squared * squared;
        let hertz = normal.force(apparent, contact.normal_velocity(), contact.reduced_radius);
        let attraction = scale.pull_off * R::splat(2.0 / 3.0) * squared * y;
        let force = NormalForce {
            force: hertz.force - attraction,
            elastic_force: hertz.elastic_force - attraction,
            energy: energy(scale, y),
        };
        let pressing = force.force + scale.pull_off * R::splat(2.0);
        (force, pressing.positive_part())
    }

    fn scale<R: Real>(&self, normal: &impl NormalLaw, reduced_radius: R) -> Scale<R> {
        // Of any two elastic spheres the stiffness is 2 E* a; without adhesion a^2 = R xi.
        let modulus = 0.5 * normal.stiffness(1.0, 1.0);
        let length = PI * 2.0 * self.surface_energy / (8.0 * modulus);
        Scale {
            length: (reduced_radius * R::splat(length * length)).cube_root(),
            pull_off: self.pull_off(reduced_radius),
        }
    }
}

/// The root y >= 1 of y^4 - 4 y = q, q >= -3, which is unique: Ferrari's method, without cancellation.
fn root<R: Real>(q: R) -> R {
    let number = R::splat;
    let third = q * number(1.0 / 3.0);
    let discriminant = (number(1.0) + third * third * third).positive_part();
    let s = (number(1.0) + discriminant.sqrt()).cube_root();
    let t = third / s;
    // m^3 + q m = 2
    let m = number(2.0) / (s * s + third + t * t);
    let side = (m + m).sqrt();
    let rest = (number(8.0) / side - m - m).positive_part().sqrt();
    number(0.5) * (side + rest)
}

/// Work done against the attraction and the spring since the spheres touched.
fn energy<R: Real>(Scale { length, pull_off }: Scale<R>, y: R) -> R {
    let number = R::splat;
    let cubed = y * y * y;
    let work = y * cubed * (number(1.5) - cubed + number(0.1) * cubed * cubed);
    pull_off * length * number(4.0 / 9.0) * (work + number(0.9 * TOUCH))
}
