//! Faults of an elastic wall: buckled, collapsed or blown up.

use peristalsis_engine::Simulation;

/// Distance of a wall sphere from the axis below which it counts as collapsed, in its diameters.
const NEAR_AXIS: f64 = 0.25;
/// Azimuthal or axial displacement beyond which the lattice counts as buckled, in diameters of a wall sphere.
const LATERAL: f64 = 1.0;
/// Radius beyond which the wall counts as blown up, in reference radii.
const BLOWN_UP: f64 = 2.5;

/// A way in which an elastic wall fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FaultKind {
    /// A sphere moved along or around the tube by more than its diameter.
    Buckled,
    /// A sphere came close to the axis.
    Collapsed,
    /// A sphere went beyond two and a half reference radii.
    BlownUp,
}

/// Where and when an elastic wall first failed in one way.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct WallFault {
    /// In which way.
    pub kind: FaultKind,
    /// When \[t\].
    pub time: f64,
    /// Number of the wall sphere.
    pub sphere: u64,
    /// Its z \[d\].
    pub z: f64,
    /// Its distance from the axis \[d\].
    pub radius: f64,
    /// Its azimuthal displacement from the reference place \[d\].
    pub azimuthal: f64,
    /// Its axial displacement \[d\].
    pub axial: f64,
}

impl WallFault {
    /// The fault, its place and time, and its probable cause.
    pub fn in_words(&self) -> String {
        let Self {
            time,
            sphere,
            z,
            radius,
            azimuthal,
            axial,
            ..
        } = self;
        let (what, cause) = match self.kind {
            FaultKind::Buckled => (
                format!(
                    "is {azimuthal:.2} d around and {axial:.2} d along the tube from its place"
                ),
                "the network has buckled: too little tension (take wall.natural_length well below the distance of \
                 neighbours) or too weak tethers (wall.keep.azimuthal, wall.keep.axial)",
            ),
            FaultKind::Collapsed => (
                format!("is {radius:.2} d from the axis"),
                "the throat has closed: the force is too strong for the springs (drive.force_amplitude against \
                 wall.spring_stiffness), or nothing balances their tension (wall.keep.balance)",
            ),
            FaultKind::BlownUp => (
                format!("is {radius:.2} d from the axis, far outside the tube"),
                "the belly gives way: the force is too strong for the springs (drive.force_amplitude against \
                 wall.spring_stiffness), or their natural length is too large; grains will escape",
            ),
        };
        format!("at t = {time:.1} wall sphere {sphere} (z = {z:.1} d) {what}; {cause}")
    }
}

/// Notes the first fault of each kind that an elastic wall shows.
pub fn note_wall_faults(simulation: &Simulation, faults: &mut Vec<WallFault>) {
    let (wall, bodies) = (simulation.wall(), simulation.bodies());
    let diameter = wall.sphere_diameter();
    for (sphere, away) in wall.displacements(bodies).enumerate() {
        let position = bodies.position[bodies.grains + sphere];
        let radius = (position.x * position.x + position.y * position.y).sqrt();
        let aside = away.y.abs().max(away.z.abs());
        let found = [
            (FaultKind::Buckled, aside > LATERAL * diameter),
            (FaultKind::Collapsed, radius < NEAR_AXIS * diameter),
            (FaultKind::BlownUp, radius > BLOWN_UP * wall.mean_radius()),
        ];
        for (kind, shown) in found {
            if shown && faults.iter().all(|fault| fault.kind != kind) {
                faults.push(WallFault {
                    kind,
                    time: simulation.time(),
                    sphere: sphere as u64,
                    z: position.z,
                    radius,
                    azimuthal: away.y,
                    axial: away.z,
                });
            }
        }
    }
}
