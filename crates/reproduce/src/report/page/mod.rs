//! The page: one HTML document with everything in it.

mod claim;
mod parts;
mod rows;
mod studies;

use crate::{CLAIMS, Examination, Size, Statistics, Verdict};
use maud::{DOCTYPE, Markup, PreEscaped, html};

use crate::prose::{filled, values};
use crate::report::Report;
use crate::report::markup::rich;
use parts::{anchor, verdict_badge};

pub(crate) const STYLE: &str = include_str!("style.css");
const TITLE: &str = "Grains in a peristaltic tube";

/// The whole page.
pub(crate) fn page(report: &Report) -> Markup {
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                meta name="generator" content={ "peristalsis " (report.program.version) };
                title { (TITLE) ": the claims examined" }
                style { (PreEscaped(STYLE)) }
            }
            body {
                a.skip href="#main" { "Skip to the claims" }
                (navigation(report))
                div.sheet {
                    (masthead(report))
                    main #main {
                        (by_wall(report))
                        (overview(report))
                        @for (place, examination) in report.examinations.iter().enumerate() {
                            (claim::section(report, place, examination))
                        }
                        (rows::section(report))
                        (studies::section(report))
                        (reading(report))
                    }
                    (colophon(report))
                }
            }
        }
    }
}

fn navigation(report: &Report) -> Markup {
    html! {
        nav.contents aria-label="Contents" {
            p.contents-title { a href="#top" { "Contents" } }
            ul {
                @if !report.walls().is_empty() { li { a href="#walls" { "Verdict by wall" } } }
                li { a href="#overview" { "The claims at a glance" } }
                @for examination in &report.examinations {
                    li {
                        a href={ "#" (anchor(examination.experiment.id)) } {
                            span.mark.(examination.finding.verdict.name()) aria-hidden="true" {}
                            span.id { (examination.experiment.id) }
                            " "
                            span { (rich(examination.experiment.prose.title())) }
                        }
                    }
                }
                @if !report.studies.is_empty() {
                    li { a href="#studies" { "The studies" } }
                }
                li { a href="#reading" { "How to read this" } }
            }
        }
    }
}

fn masthead(report: &Report) -> Markup {
    let runs: usize = report.studies.iter().map(|study| study.done).sum();
    let planned: usize = report.studies.iter().map(|study| study.runs).sum();
    html! {
        header #top {
            p.kicker { "Reproduction report" }
            h1 { (TITLE) }
            p.subtitle { "The claims of the source, each with what our simulations say of it" }
            dl.facts {
                div { dt { "Design" } dd { (report.size.name()) } }
                div { dt { "Finished runs" } dd { (runs) " of " (planned) } }
                div { dt { "Program" } dd { "peristalsis " (report.program.version) } }
                div { dt { "Revision" } dd { code { (report.program.revision) } } }
                div { dt { "Physics" } dd { "version " (report.program.physics_version) } }
            }
            @if report.size == Size::Quick {
                p.notice {
                    "This is the " b { "quick" } " design: every figure, few runs. Its numbers show the way that an analysis takes, not its \
                    outcome; verdicts need the full design ("
                    code { "peristalsis reproduce" }
                    ")."
                }
            }
        }
    }
}

/// The verdicts of the claims about walls of fixed spheres: claims down, walls across; nothing where there is none.
fn by_wall(report: &Report) -> Markup {
    let walls = report.walls();
    let asked = report
        .examinations
        .iter()
        .filter(|one| !one.finding.walls.is_empty());
    html! {
        @if !walls.is_empty() {
            section #walls {
                h2 { "Verdict by wall" }
                p {
                    "A wall is named by its spheres a ring and rings a wave. The source had one tube and does not say which: "
                    "a claim counts as reproduced where one wall or more reproduces it. "
                    "† It would be open without one of the wall's strain rates (three then suffice), ‡ it would be the opposite."
                }
                div.scroll tabindex="0" role="region" aria-label="Verdict by wall" {
                    table.walls {
                        thead {
                            tr {
                                th scope="col" { "Claim" }
                                @for tally in &walls { th scope="col" { (tally.wall) } }
                            }
                        }
                        tbody {
                            @for examination in asked {
                                tr {
                                    th scope="row" {
                                        a href={ "#" (anchor(examination.experiment.id)) } { (examination.experiment.id) }
                                        " " (rich(examination.experiment.prose.title()))
                                    }
                                    @for tally in &walls { td { (on_wall(examination, tally.wall)) } }
                                }
                            }
                            tr {
                                th scope="row" { "claims met, of those judged" }
                                @for tally in &walls { td { b { (tally.met) } " of " (tally.judged) } }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// The verdict on a claim on one wall; empty where it was not asked.
fn on_wall(examination: &Examination, wall: &str) -> Markup {
    let found = examination
        .finding
        .walls
        .iter()
        .find(|one| one.wall == wall);
    html! {
        @if let Some(found) = found {
            span.badge.(found.verdict.name()) { span.mark.(found.verdict.name()) aria-hidden="true" {} (found.verdict_with_mark()) }
            " " (rich(&found.number))
        }
    }
}

/// All claims in one table.
fn overview(report: &Report) -> Markup {
    let number = |verdict: Verdict| {
        let is = |examination: &&Examination| examination.finding.verdict == verdict;
        report.examinations.iter().filter(is).count()
    };
    html! {
        section #overview {
            h2 { "The claims at a glance" }
            @if report.examinations.is_empty() {
                p { "No claim was examined." }
            } @else {
                p.tally {
                    span { b { (number(Verdict::Reproduced)) } " reproduced" } " "
                    span { b { (number(Verdict::Differs)) } " different" } " "
                    span { b { (number(Verdict::Answered)) } " answered" } " "
                    span { b { (number(Verdict::Open)) } " open" }
                }
                table.overview {
                    thead { tr { th scope="col" { "Claim" } th scope="col" { "Verdict" } th scope="col" { "In short" } } }
                    tbody {
                        @for examination in &report.examinations {
                            tr {
                                th scope="row" {
                                    a href={ "#" (anchor(examination.experiment.id)) } {
                                        span.id { (examination.experiment.id) } " " (rich(examination.experiment.prose.title()))
                                    }
                                }
                                td { (verdict_badge(examination)) }
                                td { (rich(&examination.finding.summary)) }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// How numbers are written and verdicts given: a text with places for numbers, whose line breaks are for its writers.
fn reading(report: &Report) -> Markup {
    let needed = Statistics::FOR_A_VERDICT;
    let lines = include_str!("reading.html").lines().map(str::trim_start);
    let (quick, only) = (report.size.choose(" --quick", ""), only(report));
    PreEscaped(filled(
        &lines.collect::<String>(),
        values!(
            quick,
            only,
            strain_rates = needed.strain_rates,
            widths = needed.widths,
            replicates = needed.replicates
        ),
    ))
}

/// The option that asks for the claims of this page alone, if they are not all.
pub(crate) fn only(report: &Report) -> String {
    let chosen: Vec<&str> = report
        .examinations
        .iter()
        .map(|it| it.experiment.id)
        .collect();
    match chosen.len() < CLAIMS.len() {
        true => format!(" --only {}", chosen.join(",")),
        false => String::new(),
    }
}

fn colophon(report: &Report) -> Markup {
    html! {
        footer {
            p {
                "The claims examined are those of N. Yoshioka and H. Hayakawa, “Phase transition in peristaltic transport of frictionless granular particles”, Phys. Rev. E "
                b { "85" } ", 031302 (2012), "
                "doi:10.1103/PhysRevE.85.031302"
                ", and of a talk of theirs on frictional particles. Please cite their work with results of this page."
            }
            p {
                "Made by peristalsis " (report.program.version) ", revision " code { (report.program.revision) }
                ". This file needs no other and sends no request."
            }
        }
    }
}
