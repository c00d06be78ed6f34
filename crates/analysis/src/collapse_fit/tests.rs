use super::*;
use crate::tests::point;

/// Arches of different height, one of them far away from the others.
fn apart() -> Vec<Curve> {
    let arch = |k: u32| {
        let parameter = f64::from(k);
        let far = if k == 4 { 1000.0 } else { 0.0 };
        let at = |x: f64| point(x + far, parameter * x * (9.0 - x), 0.5);
        let points = (0..10).map(|j| at(f64::from(j))).collect();
        Curve { parameter, points }
    };
    (1..5).map(arch).collect()
}

#[test]
fn what_no_search_can_begin_with_is_refused() {
    let curves = apart();
    let plain = |_: &[f64], _: usize, _: f64, point: CurvePoint| point;
    let collapse = Collapse {
        curves: &curves,
        transform: &plain,
        least_overlap: 0.9,
    };
    let refused = collapse.estimate(&[], &[0.0], &[1.0], 1, 0, None);
    assert!(
        matches!(refused, Err(Error::NoOverlap { needed: 0.9, found }) if found > 0.5),
        "{refused:?}"
    );
    let one = Collapse {
        curves: &curves[..1],
        ..collapse
    };
    assert_refused!(one.check(&[0.0], &[1.0], 1) => TooFew { what: "curves", needed: 2, found: 1 });
    assert_refused!(one.without_each(|_| Ok(())) => TooFew { needed: 3, .. });
    assert!(collapse.check(&[0.0], &[0.0], 1).is_err());
    assert!(collapse.check(&[0.0], &[1.0], 0).is_err());
    let beyond = Collapse {
        least_overlap: 1.5,
        ..collapse
    };
    assert_refused!(beyond.check(&[0.0], &[1.0], 1) => Fraction { value: 1.5 });
}
