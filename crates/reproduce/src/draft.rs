//! A finding while it is written.

use peristalsis_analysis::Uncertain;
use peristalsis_figures::chart::ChartFigure;

use crate::error::Result;
use crate::finding::{Finding, Statistics, Verdict};
use crate::judgement::Judgement;
use crate::prose::{Prose, Values};

/// A finding while it is written, in the words of its claim.
pub(crate) struct Draft {
    /// The text of its claim.
    pub(crate) prose: Prose,
    /// What is written already.
    pub(crate) finding: Finding,
}

impl Draft {
    /// With the sections `method` and `weaknesses` of the text, as far as these ask for no value.
    pub(crate) fn of(prose: Prose) -> Self {
        let finding = Finding {
            paragraphs: prose.plain("method"),
            weaknesses: prose.plain("weaknesses"),
            ..Finding::default()
        };
        Self { prose, finding }
    }

    /// Adds the number of a section `quantity: name`, where it is known.
    pub(crate) fn quantity(
        &mut self,
        name: &str,
        values: &Values<'_>,
        ours: impl Into<Option<Uncertain>>,
    ) {
        let found = ours
            .into()
            .map(|ours| self.prose.quantity(name, values, ours));
        self.finding.quantities.extend(found);
    }

    /// The same beside the value of the source.
    pub(crate) fn compared(
        &mut self,
        name: &str,
        values: &Values<'_>,
        ours: impl Into<Option<Uncertain>>,
        source: f64,
    ) {
        if let Some(ours) = ours.into() {
            let found = self.prose.quantity(name, values, ours);
            self.finding.quantities.push(found.sourced(source));
        }
    }

    /// Adds the table of a section `table: name`.
    pub(crate) fn table(
        &mut self,
        name: &str,
        values: &Values<'_>,
        rows: impl IntoIterator<Item = Vec<String>>,
    ) {
        let table = self.prose.table(name, values, rows);
        self.finding.tables.push(table);
    }

    /// Adds the chart of a section `figure: name`.
    pub(crate) fn chart(
        &mut self,
        name: &str,
        values: &Values<'_>,
        chart: ChartFigure,
    ) -> Result<()> {
        let figure = self.prose.chart(name, values, chart)?;
        self.finding.figures.push(figure);
        Ok(())
    }

    /// Adds a section to the paragraphs.
    pub(crate) fn paragraph(&mut self, section: &str, values: &Values<'_>) {
        let text = self.prose.text(section, values);
        self.finding.paragraphs.push(text);
    }

    /// Adds a section to the weaknesses.
    pub(crate) fn weakness(&mut self, section: &str, values: &Values<'_>) {
        let text = self.prose.text(section, values);
        self.finding.weaknesses.push(text);
    }

    /// The finding with the verdict of all walls; its summary begins with those on which it holds.
    pub(crate) fn judged(mut self, judgement: Judgement, summary: &str) -> Finding {
        let summary = format!("{}. {summary}", judgement.headline());
        self.finding.walls = judgement.walls;
        self.concluded(judgement.verdict, summary, judgement.statistics)
    }

    /// The finding with its verdict.
    pub(crate) fn concluded(
        self,
        verdict: Verdict,
        summary: String,
        statistics: Statistics,
    ) -> Finding {
        Finding {
            verdict,
            summary,
            statistics,
            ..self.finding
        }
    }
}
