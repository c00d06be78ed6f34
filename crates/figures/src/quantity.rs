//! The quantities of the model with their symbols and units, so that every figure says the same.

use Dimension::{Energy, Force, Length, Number, Power, Rate, Speed, Time, TimeSquared};

/// The unit of time, and with it of force and energy.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Units {
    /// Linear contacts: mass m and diameter d of a grain, stiffness k of a contact.
    #[default]
    Linear,
    /// Hertz contacts: mass m\* and diameter d\* of the largest grain, Young's modulus Y.
    Hertz,
}

/// A quantity of a configuration or a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// t
    Time,
    /// t/T
    Period,
    /// J
    FlowRate,
    /// J/Jmax
    FlowRateRatio,
    /// tau
    TransitionTime,
    /// tau/T
    TransitionPeriod,
    /// Fraction of runs without a transition up to a time.
    Survival,
    /// w
    Width,
    /// w_c
    CriticalWidth,
    /// b
    Amplitude,
    /// epsdot
    StrainRate,
    /// c
    WaveSpeed,
    /// f^P
    ForceAmplitude,
    /// rho
    VolumeFraction,
    /// n
    NumberDensity,
    /// mu_s
    StaticFriction,
    /// T_g
    GranularTemperature,
    /// Kinetic energy of the grains.
    KineticEnergy,
    /// Contacts of a grain.
    Contacts,
    /// Grains outside of the tube.
    Escaped,
    /// Power of the wall on the grains.
    WallPower,
    /// Power lost in contacts.
    DissipatedPower,
    /// chi_J
    FlowRateMoment,
    /// chi_tau
    TransitionTimeMoment,
    /// Number of the wave along the tube.
    Wave,
    /// (z - c t)/lambda
    Phase,
    /// v_z/c
    AxialVelocity,
}

/// What a quantity is measured in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Dimension {
    Number,
    Length,
    Time,
    Rate,
    Speed,
    Force,
    Energy,
    Power,
    TimeSquared,
}

/// Every quantity: its name in configurations and tables, in words, its symbol in markup, its dimension.
const TABLE: [(Quantity, &str, &str, &str, Dimension); 27] = [
    (Quantity::Time, "time", "time", "*t*", Time),
    (Quantity::Period, "period", "time", "*t*/*T*", Number),
    (Quantity::FlowRate, "flow_rate", "flow rate", "*J*", Rate),
    (
        Quantity::FlowRateRatio,
        "flow_rate_ratio",
        "flow rate",
        "*J*/*J*_{max}",
        Number,
    ),
    (
        Quantity::TransitionTime,
        "transition_time",
        "transition time",
        "*τ*",
        Time,
    ),
    (
        Quantity::TransitionPeriod,
        "transition_period",
        "transition time",
        "*τ*/*T*",
        Number,
    ),
    (
        Quantity::Survival,
        "survival",
        "survival",
        "*S*(*t*)",
        Number,
    ),
    (
        Quantity::Width,
        "width",
        "width of the bottleneck",
        "*w*",
        Length,
    ),
    (
        Quantity::CriticalWidth,
        "critical_width",
        "critical width",
        "*w*_{c}",
        Length,
    ),
    (Quantity::Amplitude, "amplitude", "amplitude", "*b*", Length),
    (
        Quantity::StrainRate,
        "strain_rate",
        "strain rate",
        "*ε\u{307}*",
        Rate,
    ),
    (
        Quantity::WaveSpeed,
        "wave_speed",
        "wave speed",
        "*c*",
        Speed,
    ),
    (
        Quantity::ForceAmplitude,
        "force_amplitude",
        "force amplitude",
        "*f*^{P}",
        Force,
    ),
    (
        Quantity::VolumeFraction,
        "volume_fraction",
        "volume fraction",
        "*ρ*",
        Number,
    ),
    (
        Quantity::NumberDensity,
        "number_density",
        "number density",
        "*n*",
        Number,
    ),
    (
        Quantity::StaticFriction,
        "static_friction",
        "static friction",
        "*μ*_{s}",
        Number,
    ),
    (
        Quantity::GranularTemperature,
        "granular_temperature",
        "granular temperature",
        "*T*_{g}",
        Energy,
    ),
    (
        Quantity::KineticEnergy,
        "kinetic_energy",
        "kinetic energy",
        "*E*_{kin}",
        Energy,
    ),
    (
        Quantity::Contacts,
        "contacts",
        "contacts of a grain",
        "*Z*",
        Number,
    ),
    (
        Quantity::Escaped,
        "escaped",
        "escaped grains",
        "*N*_{esc}",
        Number,
    ),
    (
        Quantity::WallPower,
        "wall_power",
        "power of the wall",
        "*P*_{wall}",
        Power,
    ),
    (
        Quantity::DissipatedPower,
        "dissipated_power",
        "dissipated power",
        "*P*_{dis}",
        Power,
    ),
    (
        Quantity::FlowRateMoment,
        "flow_rate_moment",
        "second moment",
        "*χ_J*",
        Number,
    ),
    (
        Quantity::TransitionTimeMoment,
        "transition_time_moment",
        "second moment",
        "*χ_τ*",
        TimeSquared,
    ),
    (Quantity::Wave, "wave", "number of the wave", "", Number),
    (
        Quantity::Phase,
        "position",
        "position in the wave frame",
        "(*z* − *ct*)/*λ*",
        Number,
    ),
    (
        Quantity::AxialVelocity,
        "axial_velocity",
        "axial velocity",
        "*v_z*/*c*",
        Number,
    ),
];

impl Quantity {
    /// The quantity of a name in configurations and tables, such as `strain_rate`.
    pub fn named(name: &str) -> Option<Self> {
        TABLE.iter().find(|row| row.1 == name).map(|row| row.0)
    }

    /// Name in configurations and tables.
    pub fn name(self) -> &'static str {
        self.row().1
    }

    /// Name in words.
    pub fn words(self) -> &'static str {
        self.row().2
    }

    /// Symbol in markup; none if empty.
    pub fn symbol(self) -> &'static str {
        self.row().3
    }

    /// Label of an axis in markup: words and the symbol in units of the model, so that the axis bears plain numbers.
    ///
    /// ```
    /// use peristalsis_figures::{Quantity, Units};
    ///
    /// assert_eq!(Quantity::Width.label(Units::Linear), "width of the bottleneck, *w*/*d*");
    /// assert_eq!(Quantity::TransitionTime.label(Units::Hertz), "transition time, *τ*/*t*^{\\*}");
    /// assert_eq!(Quantity::FlowRateRatio.label(Units::Hertz), "flow rate, *J*/*J*_{max}");
    /// ```
    pub fn label(self, units: Units) -> String {
        let reduced = self.reduced_symbol(units);
        let comma = if reduced.is_empty() { "" } else { ", " };
        format!("{}{comma}{reduced}", self.words())
    }

    /// The symbol in units of the model, in markup; the symbol alone where it is a number.
    pub fn reduced_symbol(self, units: Units) -> String {
        format!("{}{}", self.symbol(), per_unit(self.row().4, units))
    }

    fn row(self) -> &'static (Self, &'static str, &'static str, &'static str, Dimension) {
        TABLE
            .iter()
            .find(|row| row.0 == self)
            .expect("the table has a row for every quantity")
    }
}

/// What makes a number of a quantity, in markup: division by its unit, or for a rate multiplication by that of time.
fn per_unit(dimension: Dimension, units: Units) -> &'static str {
    match (dimension, units) {
        (Number, _) => "",
        (Length, _) => "/*d*",
        (Time, Units::Linear) => "/(*m*/*k*)^{1/2}",
        (Rate, Units::Linear) => " (*m*/*k*)^{1/2}",
        (Speed, Units::Linear) => " (*m*/*k*)^{1/2}/*d*",
        (Force, Units::Linear) => "/*kd*",
        (Energy, Units::Linear) => "/*kd*^{2}",
        (Power, Units::Linear) => " (*m*/*k*)^{1/2}/*kd*^{2}",
        (TimeSquared, Units::Linear) => " *k*/*m*",
        (Time, Units::Hertz) => "/*t*^{\\*}",
        (Rate, Units::Hertz) => " *t*^{\\*}",
        (Speed, Units::Hertz) => " *t*^{\\*}/*d*",
        (Force, Units::Hertz) => "/*Yd*^{2}",
        (Energy, Units::Hertz) => "/*Yd*^{3}",
        (Power, Units::Hertz) => " *t*^{\\*}/*Yd*^{3}",
        (TimeSquared, Units::Hertz) => "/*t*^{\\*2}",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantities_are_reduced_by_the_units_of_the_model() {
        for (quantity, linear, hertz) in [
            (Quantity::CriticalWidth, "*w*_{c}/*d*", "*w*_{c}/*d*"),
            (Quantity::Time, "*t*/(*m*/*k*)^{1/2}", "*t*/*t*^{\\*}"),
            (
                Quantity::StrainRate,
                "*ε\u{307}* (*m*/*k*)^{1/2}",
                "*ε\u{307}* *t*^{\\*}",
            ),
            (Quantity::ForceAmplitude, "*f*^{P}/*kd*", "*f*^{P}/*Yd*^{2}"),
            (
                Quantity::GranularTemperature,
                "*T*_{g}/*kd*^{2}",
                "*T*_{g}/*Yd*^{3}",
            ),
            (Quantity::VolumeFraction, "*ρ*", "*ρ*"),
        ] {
            assert_eq!(quantity.reduced_symbol(Units::Linear), linear);
            assert_eq!(quantity.reduced_symbol(Units::Hertz), hertz);
        }
    }

    #[test]
    fn every_name_is_found_again() {
        for row in TABLE {
            assert_eq!(Quantity::named(row.1), Some(row.0));
            assert_eq!(row.0.name(), row.1);
        }
        assert_eq!(Quantity::named("speed of light"), None);
    }
}
