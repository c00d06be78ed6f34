//! The transition times next to the critical width: the source's method, alpha = 1 with a correction, and a free power.

use peristalsis_analysis::{
    InverseFit, Law, LawFit, Uncertain, fit_inverse_line, fit_inverse_parabola, fit_law,
};

use crate::critical::{Divergence, Line};
use crate::estimates::columns;
use crate::thresholds::{NEAR, SEEN, STRAIGHT, WINDOW, WORSE};

/// 1/tau at the widths next to w_c, and the laws fitted to it.
#[derive(Clone, Debug)]
pub(crate) struct Near {
    /// epsdot.
    strain_rate: f64,
    /// 1/tau = B d with d = w_c − w, as the source draws it: through the nearest widths.
    pub(crate) straight: Option<InverseFit>,
    /// 1/tau = B d + C d²: alpha is 1, and as many parameters as the free power has.
    pub(crate) curved: Option<InverseFit>,
    /// tau = A d^−alpha over the same widths as `curved`.
    pub(crate) power: Option<LawFit>,
    /// w_c of laws that were left out, since runs jam beyond it.
    left_out: Vec<f64>,
    /// The power law of the fewest widths that a fit can use, by the likelihood of all runs there.
    nearest: Option<Divergence>,
    /// Widths, chi_tau and its errors.
    variance: [Vec<f64>; 3],
    /// Widths, chi_tau/tau² and its errors.
    relative: [Vec<f64>; 3],
}

/// Whether the linear term is there.
fn is_clear(fit: &InverseFit) -> bool {
    fit.linear.is_above(0.0)
}

impl Near {
    /// Of the transition times at one strain rate; `None` with fewer than three usable widths.
    pub(crate) fn of(line: &Line<'_>) -> Option<Self> {
        let from = line.window_from(WINDOW)?;
        let usable = line.ensembles.iter();
        let usable = usable.filter(|one| one.width >= from && one.observed_fraction() >= SEEN);
        let fits = usable.filter_map(|one| Some((one.width, one.fit?)));
        let fits: Vec<_> = fits.filter(|(_, fit)| fit.mean.error > 0.0).collect();
        let times = columns(fits.iter().map(|(width, fit)| (*width, fit.mean)), 0.0);
        let [width, time, error] = &times;
        let last = width.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let jams = line.ensembles.iter().filter(|one| one.observed > 0);
        let last_jam = jams.map(|one| one.width).fold(last, f64::max);
        // A law whose w_c lies within the widths at which runs jam, many or few, is left out.
        let is_beyond = |critical: Uncertain| critical.value > last && !critical.is_below(last_jam);
        let curved = fit_inverse_parabola(width, time, error).ok();
        let power = fit_law(Law::Power, width, time, error, None).ok();
        let of_laws = [
            curved.map(|fit| fit.critical_width),
            power.and_then(|fit| fit.critical_width),
        ];
        let left_out = of_laws.into_iter().flatten().filter(|w_c| !is_beyond(*w_c));
        let left_out = left_out.map(|w_c| w_c.value).collect();
        let curved = curved.filter(|fit| is_beyond(fit.critical_width));
        // The widths of the straight line: those near x = 1, at least the nearest four.
        let unit = line.strain_rate.powf(1.5);
        let critical = curved.map(|curved| curved.critical_width.value);
        let is_near = |width: &f64| critical.is_some_and(|w_c| w_c - width <= NEAR * unit);
        let number = width.iter().filter(|width| is_near(width)).count();
        let first = width.len().saturating_sub(number.max(STRAIGHT));
        let variance = fits.iter().map(|(width, fit)| (*width, fit.variance));
        let relative = fits
            .iter()
            .filter_map(|(width, fit)| Some((*width, fit.relative_variance()?)));
        Some(Self {
            strain_rate: line.strain_rate,
            straight: fit_inverse_line(&width[first..], &time[first..], &error[first..]).ok(),
            curved,
            power: power.filter(|fit| fit.critical_width.is_some_and(is_beyond)),
            left_out,
            nearest: line.nearest(),
            variance: columns(variance.filter(|(_, one)| one.value > 0.0), 0.0),
            relative: columns(relative.filter(|(_, one)| one.value > 0.0), 0.0),
        })
    }

    /// alpha of the fewest widths that a fit can use, by the likelihood of the runs.
    pub(crate) fn exponent(&self) -> Option<Uncertain> {
        self.nearest.map(|fit| fit.exponent)
    }

    /// (w_c − w)/epsdot^(3/2) of the widest tube whose transition times are fitted.
    pub(crate) fn nearest_distance(&self) -> Option<f64> {
        let [widths, ..] = &self.variance;
        let last = widths.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        Some((self.critical_width()?.value - last) / self.strain_rate.powf(1.5))
    }

    /// Whether alpha = 1 next to w_c: where 1/tau = B d + C d² has a clear linear term and a free power, of as many parameters,
    /// fits no better. Without a clear linear term the local exponent decides.
    pub(crate) fn is_linear(&self, agrees: impl Fn(&Uncertain) -> Option<bool>) -> Option<bool> {
        let (Some(curved), Some(power)) = (self.judged(), &self.power) else {
            return self.exponent().as_ref().and_then(agrees);
        };
        Some(curved.chi_squared - power.chi_squared < WORSE)
    }

    /// tau (w_c − w) next to w_c, where alpha = 1 leaves a linear term.
    pub(crate) fn amplitude(&self) -> Option<Uncertain> {
        let curved = self.judged()?;
        let slope = curved.linear;
        let amplitude = 1.0 / slope.value;
        Some(Uncertain::normal(
            amplitude,
            amplitude * slope.error / slope.value,
        ))
    }

    /// 1/tau = B d + C d², where its linear term is clear: the law that is judged.
    pub(crate) fn judged(&self) -> Option<InverseFit> {
        self.curved.filter(is_clear)
    }

    /// beta of chi_tau ~ (w_c − w)^−beta next to w_c. Where 1/tau = B d + C d² it is 2 + q, chi_tau/tau² ~ d^−q: in a power of
    /// chi_tau itself the correction C would count twice. Elsewhere it is the power of chi_tau.
    pub(crate) fn variance_exponent(&self) -> Option<Uncertain> {
        let exponent = self.scatter_law()?.exponent;
        Some(match self.judged() {
            Some(_) => exponent.map(exponent.error, |relative| 2.0 + relative),
            None => exponent,
        })
    }

    /// Power law of chi_tau/tau² where 1/tau = B d + C d², else of chi_tau, about the w_c of alpha = 1, or of the free power
    /// where 1/tau has no linear term.
    fn scatter_law(&self) -> Option<LawFit> {
        let [width, scatter, error] = match self.judged() {
            Some(_) => &self.relative,
            None => &self.variance,
        };
        let critical = self.linear_or_free()?;
        fit_law(Law::Power, width, scatter, error, Some(critical)).ok()
    }

    /// chi_tau at a width by that law and that of tau, and the w_c where it ends.
    pub(crate) fn variance_law(&self) -> Option<(impl Fn(f64) -> f64 + use<>, f64)> {
        let law = self.scatter_law()?;
        let critical = law.critical_width?.value;
        let judged = self.judged();
        let at = move |width: f64| {
            let distance = critical - width;
            let scatter = (law.ln_amplitude.value - law.exponent.value * distance.ln()).exp();
            let bend = |curved: InverseFit| curved.quadratic.map_or(0.0, |bend| bend.value);
            let rate =
                judged.map(|curved| distance * (curved.linear.value + bend(curved) * distance));
            scatter / rate.map_or(1.0, |rate| rate * rate)
        };
        Some((at, critical))
    }

    /// chi_tau (w_c − w)^power, the weighted mean over the widths.
    pub(crate) fn variance_amplitude(&self, power: f64) -> Option<Uncertain> {
        let [width, variance, error] = &self.variance;
        let critical = self.linear_or_free()?;
        let (mut weights, mut sum, mut shift) = (0.0, 0.0, 0.0);
        for ((width, variance), error) in width.iter().zip(variance).zip(error) {
            let distance = critical.value - width;
            let weight = (variance / error).powi(2);
            weights += weight;
            sum += weight * (variance.ln() + power * distance.ln());
            shift += weight * power / distance;
        }
        let value = (sum / weights).exp();
        // The error of w_c moves all points together.
        let relative = weights.powf(-0.5).hypot(critical.error * shift / weights);
        value
            .is_finite()
            .then(|| Uncertain::normal(value, value * relative))
    }

    /// w_c of alpha = 1, of the free power, and by the likelihood of all runs, where each has one.
    fn critical_widths(&self) -> [Option<Uncertain>; 3] {
        let linear = self.curved.map(|curved| curved.critical_width);
        let power = self.power.and_then(|fit| fit.critical_width);
        [linear, power, self.nearest.map(|fit| fit.critical_width)]
    }

    /// The first of them that there is.
    fn linear_or_free(&self) -> Option<Uncertain> {
        self.critical_widths().into_iter().flatten().next()
    }

    /// w_c midway between the fits with free alpha and with alpha = 1; its error is the larger of theirs and half their
    /// distance, added in quadrature. Where both are left out, that by the likelihood of all runs, which clings to the runs
    /// that jam last: its error grows by the distance of the farther law.
    pub(crate) fn critical_width(&self) -> Option<Uncertain> {
        let [linear, power, of_all] = self.critical_widths();
        let (Some(one), Some(other)) = (power.or(linear), linear.or(power)) else {
            let of_all = of_all?;
            let distances = self.left_out.iter().map(|law| (law - of_all.value).abs());
            let error = of_all.error.hypot(distances.fold(0.0, f64::max));
            return Some(Uncertain::normal(of_all.value, error));
        };
        let half = 0.5 * (one.value - other.value);
        let error = one.error.max(other.error).hypot(half);
        Some(Uncertain::normal(other.value + half, error))
    }
}

/// What one number of every strain rate is.
pub(crate) fn at_rates<'a, T>(
    all: impl IntoIterator<Item = &'a Near>,
    number: impl Fn(&Near) -> Option<T>,
) -> Vec<(f64, T)> {
    let all = all.into_iter();
    all.filter_map(|near| Some((near.strain_rate, number(near)?)))
        .collect()
}
