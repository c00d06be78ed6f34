//! The kernel that a configuration needs.

use peristalsis_physics::method::Kernel;

use super::Context;
use crate::configuration::Configuration;

impl Configuration {
    /// The reason, in words, why this configuration needs the reference kernel; `None` where a fast kernel can compute it.
    pub fn reference_only(&self) -> Option<&'static str> {
        match (self.contact.rolling, self.contact.cohesion) {
            (Some(_), Some(_)) => Some("rolling resistance and cohesion"),
            (Some(_), None) => Some("rolling resistance"),
            (None, Some(_)) => Some("cohesion"),
            (None, None) => None,
        }
    }
}

/// Takes the reference kernel where it alone will do, and refuses a fast one that was asked for.
pub(super) fn choose(configuration: &mut Configuration, context: &mut Context<'_>) {
    let Some(what) = configuration.reference_only() else {
        return;
    };
    let key = "run.kernel";
    if context.given(key) && configuration.run.kernel == Kernel::Fast {
        let message = format!("{key} = \"fast\", and the reference kernel alone computes {what}");
        let help = format!("leave {key} out, or {key} = \"reference\"");
        return context
            .refuse::<()>(&[key], message, help)
            .unwrap_or_default();
    }
    configuration.run.kernel = Kernel::Reference;
}
