//! Ordinary differential equations to high accuracy.

/// A function of the state that happens where it rises through 0.
type Event<'a, const N: usize> = &'a dyn Fn(&[f64; N]) -> f64;

/// y' = f(y) from `start` until the first of `events` rises through 0, at most for `longest`; answers the time, the state
/// and which event it was (`events.len()` where none happened).
///
/// The pair of Dormand & Prince of order 5, J. Comput. Appl. Math. 6, 19 (1980), with steps that keep the estimated error
/// of each component below `tolerance`; the instant of an event by bisection of the step that contains it. An event that
/// holds at the start has to fall below 0 before it can happen.
pub(crate) fn until<const N: usize>(
    f: impl Fn(&[f64; N]) -> [f64; N],
    start: [f64; N],
    events: &[Event<'_, N>],
    tolerance: &[f64; N],
    [first_step, longest]: [f64; 2],
) -> (f64, [f64; N], usize) {
    let (mut time, mut y, mut h) = (0.0, start, first_step);
    while time < longest {
        let step = h.min(longest - time);
        let (next, error) = dormand_prince(&f, &y, step, tolerance);
        if error <= 1.0 {
            let happened = |state: &[f64; N]| {
                events
                    .iter()
                    .position(|event| event(&y) < 0.0 && event(state) >= 0.0)
            };
            if happened(&next).is_some() {
                let [_, high] = bisected([0.0, step], 80, |middle| {
                    let (state, _) = dormand_prince(&f, &y, middle, tolerance);
                    happened(&state).is_none()
                });
                let (state, _) = dormand_prince(&f, &y, high, tolerance);
                let which = happened(&state).unwrap_or(events.len());
                return (time + high, state, which);
            }
            time += step;
            y = next;
        }
        h = step * (0.9 * libm::pow(error.max(1e-10), -0.2)).clamp(0.2, 4.0);
    }
    (time, y, events.len())
}

/// The ends of an interval after so many halvings about the place where `is_below` changes from true to false.
pub(crate) fn bisected(
    [mut low, mut high]: [f64; 2],
    halvings: usize,
    is_below: impl Fn(f64) -> bool,
) -> [f64; 2] {
    for _ in 0..halvings {
        let middle = 0.5 * (low + high);
        if is_below(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    [low, high]
}

/// One step, and its estimated error in units of the tolerance.
fn dormand_prince<const N: usize>(
    f: &impl Fn(&[f64; N]) -> [f64; N],
    y: &[f64; N],
    h: f64,
    tolerance: &[f64; N],
) -> ([f64; N], f64) {
    const STAGES: [&[f64]; 6] = [
        &[1.0 / 5.0],
        &[3.0 / 40.0, 9.0 / 40.0],
        &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
        &[
            19_372.0 / 6561.0,
            -25_360.0 / 2187.0,
            64_448.0 / 6561.0,
            -212.0 / 729.0,
        ],
        &[
            9017.0 / 3168.0,
            -355.0 / 33.0,
            46_732.0 / 5247.0,
            49.0 / 176.0,
            -5103.0 / 18_656.0,
        ],
        &[
            35.0 / 384.0,
            0.0,
            500.0 / 1113.0,
            125.0 / 192.0,
            -2187.0 / 6784.0,
            11.0 / 84.0,
        ],
    ];
    /// Fifth order less fourth.
    const DIFFERENCE: [f64; 7] = [
        71.0 / 57_600.0,
        0.0,
        -71.0 / 16_695.0,
        71.0 / 1920.0,
        -17_253.0 / 339_200.0,
        22.0 / 525.0,
        -1.0 / 40.0,
    ];
    let mut slopes = [[0.0; N]; 7];
    slopes[0] = f(y);
    let mut next = *y;
    for (stage, weights) in STAGES.iter().enumerate() {
        next = *y;
        for (weight, slope) in weights.iter().zip(&slopes) {
            for (value, slope) in next.iter_mut().zip(slope) {
                *value += h * weight * slope;
            }
        }
        slopes[stage + 1] = f(&next);
    }
    let mut error = 0.0_f64;
    for i in 0..N {
        let sum: f64 = DIFFERENCE
            .iter()
            .zip(&slopes)
            .map(|(w, slope)| w * slope[i])
            .sum();
        error = error.max((h * sum / tolerance[i]).abs());
    }
    (next, error)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_oscillator_comes_back_at_its_period() {
        let turns_back = |y: &[f64; 2]| y[0];
        let (time, y, which) = until(
            |y| [y[1], -y[0]],
            [1e-9, -1.0],
            &[&turns_back],
            &[1e-13; 2],
            [1e-3, 10.0],
        );
        assert_eq!(which, 0);
        assert!((time - core::f64::consts::PI).abs() < 1e-8, "{time}");
        assert!((y[1] - 1.0).abs() < 1e-11, "{y:?}");
    }

    #[test]
    fn without_an_event_it_ends_at_the_end() {
        let (time, y, which) = until(|y| [y[0]], [1.0], &[], &[1e-13], [1e-3, 1.0]);
        assert_eq!((time, which), (1.0, 0));
        assert!((y[0] - core::f64::consts::E).abs() < 1e-11, "{y:?}");
    }
}
