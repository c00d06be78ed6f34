//! In which order studies are worked on.

use crate::claim::Claim;

/// Places of the studies such that claims become available early: again and again the claim whose remaining studies cost
/// least, and of these the cheapest first. Ties are broken by the order of the claims and of the studies.
pub(super) fn cheapest_claims_first(
    claims: &[Claim],
    studies: &[&str],
    costs: &[f64],
) -> Vec<usize> {
    let mut order: Vec<usize> = Vec::with_capacity(studies.len());
    let mut waiting: Vec<Vec<usize>> = claims
        .iter()
        .map(|claim| {
            let needed = claim.all_studies();
            (0..studies.len())
                .filter(|place| needed.contains(&studies[*place]))
                .collect()
        })
        .collect();
    while let Some(next) = waiting
        .iter()
        .enumerate()
        .min_by(|(_, one), (_, other)| cost(one, costs).total_cmp(&cost(other, costs)))
        .map(|(claim, _)| claim)
    {
        let mut needed = waiting.remove(next);
        needed.sort_by(|one, other| costs[*one].total_cmp(&costs[*other]));
        for rest in &mut waiting {
            rest.retain(|place| !needed.contains(place));
        }
        order.extend(needed);
    }
    order
}

fn cost(places: &[usize], costs: &[f64]) -> f64 {
    places.iter().map(|place| costs[*place]).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::ReproduceError;
    use crate::{Evidence, Finding};

    fn unexamined(_: &Evidence) -> Result<Finding, ReproduceError> {
        Err(ReproduceError::NoSuchStudy(String::new()))
    }

    fn claim(id: &'static str, studies: &'static [&'static str]) -> Claim {
        Claim::new(id, crate::Prose::new(""), studies, unexamined)
    }

    #[test]
    fn the_claim_that_is_ready_soonest_comes_first() {
        let claims = [
            claim("F1", &["dear", "cheap"]),
            claim("F2", &["middle"]),
            claim("F3", &["cheap", "middle"]),
            claim("F4", &[]),
        ];
        let studies = ["dear", "cheap", "middle"];
        // F2 costs 3; then F3 lacks only `cheap`.
        assert_eq!(
            cheapest_claims_first(&claims, &studies, &[10.0, 2.0, 3.0]),
            [2, 1, 0]
        );
        // With `cheap` at 4 F3 still comes before F1; of F1's own studies the cheaper would be first.
        assert_eq!(
            cheapest_claims_first(&claims[..1], &studies[..2], &[10.0, 4.0]),
            [1, 0]
        );
        // Equal costs: as they stand.
        assert_eq!(
            cheapest_claims_first(&claims, &studies, &[0.0, 0.0, 0.0]),
            [0, 1, 2]
        );
        assert!(cheapest_claims_first(&[], &[], &[]).is_empty());
    }
}
