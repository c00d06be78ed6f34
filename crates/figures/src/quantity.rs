//! The quantities that stand on axes, with their symbols and units, so that every figure says the same.

/// The unit of time, and with it of force and pressure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Units {
    /// Linear contacts: mass m and diameter d of a grain, stiffness k of a contact.
    #[default]
    Linear,
    /// Hertz contacts: mass m\* and diameter d\* of the largest grain, Young's modulus Y.
    Hertz,
}

/// A quantity on an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// t/T
    Period,
    /// J/Jmax
    FlowRateRatio,
    /// tau/T
    TransitionPeriod,
    /// Fraction of runs without a transition up to a time.
    Survival,
    /// w
    Width,
    /// w_c
    CriticalWidth,
    /// epsdot
    StrainRate,
    /// f^P
    ForceAmplitude,
    /// rho
    VolumeFraction,
    /// mu_s
    StaticFriction,
    /// chi_J
    FlowRateMoment,
    /// Number of the wave along the tube.
    Wave,
    /// (z - c t)/lambda
    Position,
    /// v_z/c
    AxialVelocity,
}

impl Units {
    /// Unit of time in markup.
    pub fn time(self) -> &'static str {
        self.of("(*m*/*k*)^{1/2}", "*t*^{\\*}")
    }

    /// Unit of a rate in markup.
    pub fn rate(self) -> &'static str {
        self.of("(*k*/*m*)^{1/2}", "*t*^{\\*−1}")
    }

    /// Unit of acceleration in markup.
    pub fn acceleration(self) -> &'static str {
        self.of("*kd*/*m*", "*d*/*t*^{\\*2}")
    }

    /// Unit of pressure in markup.
    pub fn pressure(self) -> &'static str {
        self.of("*k*/*d*", "*Y*")
    }

    /// Factor in markup that turns a pressure into a pure number.
    pub fn per_pressure(self) -> &'static str {
        self.of(" *d*/*k*", "/*Y*")
    }

    /// Unit of force in markup.
    pub fn force(self) -> &'static str {
        self.of("*kd*", "*Yd*^{2}")
    }

    /// What these units have for linear and for Hertz contacts.
    fn of(self, linear: &'static str, hertz: &'static str) -> &'static str {
        match self {
            Self::Linear => linear,
            Self::Hertz => hertz,
        }
    }
}

impl Quantity {
    /// Label of an axis in markup: words and the symbol in units of the model, so that the axis bears plain numbers.
    ///
    /// ```
    /// use peristalsis_figures::{Quantity, Units};
    ///
    /// assert_eq!(Quantity::Width.label(Units::Linear), "width of the bottleneck, *w*/*d*");
    /// assert_eq!(Quantity::ForceAmplitude.label(Units::Hertz), "force amplitude, *f*^{P}/*Yd*^{2}");
    /// assert_eq!(Quantity::FlowRateRatio.label(Units::Hertz), "flow rate, *J*/*J*_{max}");
    /// ```
    pub fn label(self, units: Units) -> String {
        let (words, symbol) = match self {
            Self::Period => ("time", "*t*/*T*"),
            Self::FlowRateRatio => ("flow rate", "*J*/*J*_{max}"),
            Self::TransitionPeriod => ("transition time", "*τ*/*T*"),
            Self::Survival => ("survival", "*S*(*t*)"),
            Self::Width => ("width of the bottleneck", "*w*/*d*"),
            Self::CriticalWidth => ("critical width", "*w*_{c}/*d*"),
            Self::StrainRate => ("strain rate", "*ε\u{307}*"),
            Self::ForceAmplitude => ("force amplitude", "*f*^{P}"),
            Self::VolumeFraction => ("volume fraction", "*ρ*"),
            Self::StaticFriction => ("static friction", "*μ*_{s}"),
            Self::FlowRateMoment => ("second moment", "*χ_J*"),
            Self::Wave => return "number of the wave".to_owned(),
            Self::Position => ("position in the wave frame", "(*z* − *ct*)/*λ*"),
            Self::AxialVelocity => ("axial velocity", "*v_z*/*c*"),
        };
        let per_unit = match self {
            Self::StrainRate => &format!(" {}", units.time()),
            Self::ForceAmplitude => &format!("/{}", units.force()),
            _ => "",
        };
        format!("{words}, {symbol}{per_unit}")
    }
}
