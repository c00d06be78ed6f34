//! A warning.

/// A doubt about a run that can be computed but may not mean what was intended.
#[derive(Clone, Debug, PartialEq, serde::Serialize, schemars::JsonSchema)]
#[schemars(rename = "WarningEntry")]
pub struct Warning {
    /// The key to look at.
    pub key: &'static str,
    /// The consequence to expect.
    pub message: String,
}

impl Warning {
    /// This warning under a circumstance.
    #[must_use]
    pub fn under(self, circumstance: &str) -> Self {
        Self {
            message: format!("{circumstance} {}", self.message),
            ..self
        }
    }
}
