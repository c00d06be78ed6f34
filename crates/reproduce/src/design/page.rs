//! A design as one page of HTML.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::{DISTANCES, Design, NEAR, rounded};
use crate::report::STYLE;

/// The page: groups, regime, expectation, what is outside the data, cost; `cost` are the words of the command line on what
/// would run.
pub fn page(design: &Design, name: &str, cost: &str) -> String {
    let page: Markup = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { "Design of " (name) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                div.sheet {
                    main #main {
                        h1 { "Design of " (name) }
                        p { b { "Regime: " } (design.regime) "." }
                        @if let Some(wall) = design.wall { p { b { "Rough wall: " } (wall) "." } }
                        @for flow in &design.expected {
                            p {
                                "From " (flow.start) ": J/Jmax = " (rounded(flow.expectation.flow_rate_ratio)) " ± "
                                (rounded(flow.expectation.error))
                                @if let (Some(rate), Some(error)) =
                                    (flow.mass_flow_rate_kg_per_h, flow.mass_flow_rate_error_kg_per_h)
                                {
                                    ", " (rounded(rate)) " ± " (rounded(error)) " kg/h"
                                }
                                " (" (flow.expectation.points) " published points between "
                                (rounded(flow.expectation.range[0])) " and " (rounded(flow.expectation.range[1]))
                                ", the nearest at a distance of " (rounded(flow.expectation.distance)) " (" (DISTANCES) "): "
                                (flow.expectation.studies.join(", ")) ")."
                            }
                        }
                        @if let Some(largest) = design.largest_mass_flow_rate_kg_per_h {
                            p { "Without slip " (rounded(largest)) " kg/h, all grains with the wave." }
                        }
                        h2 { "Dimensionless groups" }
                        div.scroll {
                            table {
                                thead { tr { th { "group" } th { "here" } th { "published" } th { "" } } }
                                tbody {
                                    @for group in &design.groups {
                                        tr {
                                            td { (group.meaning) }
                                            td { (rounded(group.value)) }
                                            td { (rounded(group.published[0])) " to " (rounded(group.published[1])) }
                                            td { b { (group.place()) } }
                                        }
                                    }
                                }
                            }
                        }
                        @if design.groups.iter().any(|group| group.place() == "near") {
                            p { (NEAR) "." }
                        }
                        @if !design.outside.is_empty() {
                            h2 { "Outside the published runs" }
                            ul { @for line in &design.outside { li { (line) } } }
                        }
                        h2 { "What would run" }
                        pre style="white-space: pre-wrap" { (cost) }
                    }
                }
            }
        }
    };
    page.into_string()
}
