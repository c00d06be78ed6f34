//! Tables of Q8.

use super::{Ladder, Loop};
use crate::finding::ReportTable;
use crate::rows::Mean;
use crate::text::{number, with_error};

/// Rise and fluctuation of each ladder of forces.
pub(super) fn of_ladders(ladders: &[Ladder<'_>]) -> ReportTable {
    let rows = ladders
        .iter()
        .map(|one| {
            let rise = one.rise();
            let fluctuation = one.largest_fluctuation();
            vec![
                number(1e3 * one.rate, 2),
                one.waves.to_string(),
                one.points.len().to_string(),
                rise.as_ref().map_or("–".to_owned(), |rise| {
                    with_error(rise.height.value, rise.height.error)
                }),
                rise.as_ref()
                    .map_or("–".to_owned(), |rise| number(1e3 * rise.force, 2)),
                fluctuation.map_or("–".to_owned(), |(_, mean)| {
                    with_error(mean.value, mean.error)
                }),
                fluctuation.map_or("–".to_owned(), |(force, _)| number(1e3 * force, 2)),
            ]
        })
        .collect();
    ReportTable {
        caption: "By strain rate (1/*t*^{\\*}) and length: the largest rise of the flow between two neighbouring forces and \
                  where (*Y d*^2), and the largest product of the variance of the period averages of *J*/*J*_{max} and the \
                  number of waves, and where."
            .to_owned(),
        head: [
            "10^{3}*ε̇*",
            "waves",
            "forces",
            "rise",
            "at 10^{3}*f*^{P}",
            "variance × waves",
            "largest at 10^{3}*f*^{P}",
        ]
        .map(str::to_owned)
        .to_vec(),
        rows,
    }
}

/// Where the sweeps pass.
pub(super) fn of_loops(loops: &[Loop]) -> ReportTable {
    let cell = |mean: Option<Mean>| {
        mean.map_or("–".to_owned(), |mean| {
            with_error(1e3 * mean.value, 1e3 * mean.error)
        })
    };
    ReportTable {
        caption: "Sweeps of the force: where the flow passes to fast on the way up and to slow on the way down, and the width of the \
                  loop (all in 10^{−3} *Y d*^2); sweeps that did not pass, up and down."
            .to_owned(),
        head: ["10^{3}*ε̇*", "periods", "10^{3}*f*^{P} up", "down", "loop", "not passed"].map(str::to_owned).to_vec(),
        rows: loops
            .iter()
            .map(|one| {
                vec![
                    number(1e3 * one.rate, 2),
                    number(one.periods, 0),
                    cell(one.up),
                    cell(one.down),
                    cell(one.width()),
                    format!("{}, {}", one.censored[0], one.censored[1]),
                ]
            })
            .collect(),
    }
}
