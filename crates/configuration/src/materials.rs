//! Materials by name: what `units.material` stands for.

use peristalsis_physics::contact::{Elasticity, NormalLaw};

use crate::document::{self, Item, Node, Table};
use crate::keys::{DAMPINGS, RESTITUTION};
use crate::schema;

/// A material of which grains are made, as measured.
///
/// Friction and restitution are those of two grains of the material; a wall is taken to rub and to bounce as they do.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Material {
    /// Its name.
    pub name: &'static str,
    /// rho \[kg m^-3\].
    pub density: f64,
    /// Young's modulus Y \[Pa\].
    pub young_modulus: f64,
    /// nu.
    pub poisson_ratio: f64,
    /// mu, for static and kinetic friction alike.
    pub friction: f64,
    /// e.
    pub restitution: f64,
    /// Where the numbers are from.
    pub source: &'static str,
}

/// All materials.
pub const MATERIALS: &[Material] = &[
    Material {
        name: "glass",
        density: 2500.0,
        young_modulus: 7.2e10,
        poisson_ratio: 0.22,
        friction: 0.09,
        restitution: 0.97,
        source: "clean beads of soda-lime glass; friction and restitution: Foerster et al., Phys. Fluids 6, 1108 (1994)",
    },
    Material {
        name: "sand",
        density: 2650.0,
        young_modulus: 9.5e10,
        poisson_ratio: 0.08,
        friction: 0.5,
        restitution: 0.7,
        source: "quartz: Mavko et al., Rock Physics Handbook; friction of grains of 0.5 mm: Rowe, Proc. R. Soc. A 269, \
                 500 (1962); restitution: a usual choice, not measured",
    },
    Material {
        name: "steel",
        density: 7900.0,
        young_modulus: 1.93e11,
        poisson_ratio: 0.29,
        friction: 0.1,
        restitution: 0.95,
        source: "dry stainless steel 304; friction and restitution: Lorenz et al., Exp. Mech. 37, 292 (1997)",
    },
    Material {
        name: "pmma",
        density: 1190.0,
        young_modulus: 3.0e9,
        poisson_ratio: 0.37,
        friction: 0.1,
        restitution: 0.93,
        source: "acrylic; friction and restitution: Lorenz et al., Exp. Mech. 37, 292 (1997)",
    },
    Material {
        name: "tablet",
        density: 1300.0,
        young_modulus: 3.2e7,
        poisson_ratio: 0.3,
        friction: 0.3,
        restitution: 0.78,
        source: "modulus and restitution: Just et al., AAPS PharmSciTech 14, 402 (2013); friction: a middle value of \
                 Hancock et al., Int. J. Pharm. 384, 39 (2010), who measured 0 to 0.74; the rest: usual choices",
    },
];

/// The material of a name.
pub fn material(name: &str) -> Option<&'static Material> {
    MATERIALS.iter().find(|material| material.name == name)
}

impl Material {
    /// Its numbers and their source, in words.
    pub(crate) fn description(&self) -> String {
        format!(
            "{} kg/m^3, Young's modulus {:e} Pa, Poisson's ratio {}, friction {}, restitution {} ({}).",
            self.density,
            self.young_modulus,
            self.poisson_ratio,
            self.friction,
            self.restitution,
            self.source
        )
    }
}

/// The key that names a material.
pub(crate) const MATERIAL: &str = "units.material";
const POISSON_RATIO: &str = "contact.poisson_ratio";
const FRICTIONS: [&str; 2] = ["contact.static_friction", "contact.kinetic_friction"];

/// Takes out of lower layers what a material stands for; a modulus stays, for grains are often computed softer than they are.
pub(crate) fn replace(base: &mut Table) {
    let dampings = DAMPINGS.iter().flatten().copied();
    let keys = ["units.density", POISSON_RATIO, "contact.restitution_speed"].into_iter();
    for key in keys.chain(FRICTIONS).chain(dampings) {
        document::remove(base, key);
    }
}

/// Puts the numbers of the material that all layers together name where none is given.
pub(crate) fn fill(table: &mut Table) {
    let Some(entry) = document::remove(table, MATERIAL) else {
        return;
    };
    let Node::Text(name) = &entry.item.node else {
        return;
    };
    let Some(material) = material(name) else {
        return;
    };
    let law = document::text(table, "contact.law").unwrap_or_default();
    let elasticity = schema::law_of(law).map(|law| law.elasticity());
    let is_given =
        |table: &Table, keys: &[&str]| keys.iter().any(|key| document::entry(table, key).is_some());
    let mut values: Vec<(&str, f64)> = vec![("units.density", material.density)];
    if let Some(Elasticity::YoungModulus(_)) = elasticity {
        values.push(("units.young_modulus", material.young_modulus));
        values.push((POISSON_RATIO, material.poisson_ratio));
    }
    if !is_given(table, &DAMPINGS.concat()) {
        values.push((RESTITUTION, material.restitution));
    }
    if !is_given(table, &FRICTIONS) {
        values.extend(FRICTIONS.map(|key| (key, material.friction)));
    }
    for (key, value) in values {
        if !is_given(table, &[key]) {
            let item = Item {
                origin: entry.item.origin.clone(),
                node: Node::Float(value),
            };
            document::merge(table, document::setting(key, &entry.key, item));
        }
    }
}
