//! Which schedules are consistent, by the two sums that bias and variance are.

use core::cmp::Ordering;
use core::fmt;

use super::asymptotics::{Behaviour, Reason};
use super::expression::Expression;
use super::number::Number;
use super::rate::{Rate, Rates, power_sum};
use super::sums::PowerSums;
use super::{chain, number::significant};

/// Weights of the samples in the mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weights {
    /// All the same.
    Uniform,
    /// αₖ^d, the inverse of the variance: bias Σ αₖ^(d+p)/Σ αₖ^d, variance C/Σ αₖ^d.
    InverseVariance,
}

/// What is asked of a schedule.
#[derive(Clone, Copy, Debug)]
pub struct Request {
    /// d > 0: the variance of a sample is C α^-d. 2 per mollified interaction in space, 1 in a plane.
    pub dimension: Number,
    /// p: its bias is c αᵖ. 2 where radiance is smooth.
    pub bias_order: Number,
    /// Weights of the samples.
    pub weights: Weights,
    /// Fraction of the samples, from the first one, that is dropped: 0 ≤ β < 1.
    pub discarded: f64,
    /// γ of a Markov chain, 0 ≤ γ < 1: its distance to any stationary distribution falls by γ in every step, whatever
    /// α. `None` for independent samples.
    pub chain_rate: Option<f64>,
}

/// The answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Classification {
    /// Bias and variance vanish.
    Consistent,
    /// The bias does not vanish.
    BiasPersists,
    /// The variance does not vanish.
    VariancePersists,
    /// Neither is proven.
    Unknown,
}

impl Classification {
    /// In snake case, as in reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Consistent => "consistent",
            Self::BiasPersists => "bias_persists",
            Self::VariancePersists => "variance_persists",
            Self::Unknown => "unknown",
        }
    }
}

/// Exact sums at a finite number of samples.
#[derive(Clone, Copy, Debug)]
pub struct FiniteRow {
    /// Number of samples.
    pub n: u64,
    /// αₙ.
    pub alpha: f64,
    /// Bias over c; `None` where the sum was too expensive.
    pub bias: Option<f64>,
    /// Variance over C, of independent samples.
    pub variance: Option<f64>,
}

/// A classified schedule.
#[derive(Clone, Debug)]
pub struct Report {
    /// The answer.
    pub classification: Classification,
    /// Why, one step a line.
    pub argument: Vec<String>,
    /// Leading behaviour of αₙ, if it has one.
    pub alpha: Option<String>,
    /// Bias over c, where it has a rate.
    pub bias: Option<Rate>,
    /// Variance over C, where it has a rate.
    pub variance: Option<Rate>,
    /// Mean squared error up to the constants: the slower of bias² and variance.
    pub mse: Option<Rate>,
    /// Share of the specular lobe that a chain loses for ever.
    pub lost_share: Option<f64>,
    /// What the schedule is for independent samples, and so for a chain that finds the lobe by blind proposals.
    pub independent: Classification,
    /// Sums at n = 1, 2¹⁰, 2²⁰, 2³⁰, 2⁴⁰.
    pub finite: Vec<FiniteRow>,
}

/// A bandwidth that is not positive and finite.
#[derive(Clone, Copy, Debug)]
pub struct NotPositive {
    /// At this n.
    pub n: u64,
    /// It has this value.
    pub alpha: f64,
}

impl fmt::Display for NotPositive {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the bandwidth is {} at n = {}", self.alpha, self.n)
    }
}

/// Evaluations of the expression for the sums: some milliseconds.
const BUDGET: u64 = 20_000;

/// Classifies a schedule.
///
/// # Errors
/// A bandwidth that is not positive and finite, among the first 1024 or at a power of two up to 2⁴⁰; one that only
/// leaves the range of f64 through an exponential is none.
pub fn classify(schedule: &Expression, request: &Request) -> Result<Report, NotPositive> {
    let behaviour = schedule.behaviour();
    let exponential = behaviour.as_ref().is_ok_and(has_exponential);
    for n in (1..=1024).chain((11..=40).map(|j| 1 << j)) {
        let alpha = schedule.at(n);
        let leaves_range = exponential && (alpha == 0.0 || alpha == f64::INFINITY);
        let allowed = leaves_range || (alpha > 0.0 && alpha.is_finite());
        if !allowed {
            return Err(NotPositive { n, alpha });
        }
    }
    let mut report = Report {
        classification: Classification::Unknown,
        argument: Vec::new(),
        alpha: None,
        bias: None,
        variance: None,
        mse: None,
        lost_share: None,
        independent: Classification::Unknown,
        finite: finite(schedule, request),
    };
    let behaviour = match behaviour {
        Ok(behaviour) => behaviour,
        Err(obstacle) => {
            let reason = format!("the leading behaviour is not known: {obstacle}");
            report.argument.push(reason);
            return Ok(report);
        }
    };
    let usual = &behaviour.usual;
    report.alpha = usual.low.lead().map(|low| match &usual.high {
        None => low.to_string(),
        Some(high) => {
            let high = high.lead().map_or("0".to_owned(), ToString::to_string);
            format!("between {low} and {high}")
        }
    });
    if let Err(Reason(reason)) = independent(&behaviour, request, &mut report) {
        report.classification = Classification::Unknown;
        report.argument.push(format!("not decided: {reason}"));
    }
    report.independent = report.classification;
    if let Some(rate) = request.chain_rate {
        chain::classify::classify(&behaviour, request, rate, &mut report);
    }
    Ok(report)
}

fn has_exponential(behaviour: &Behaviour) -> bool {
    let rare = behaviour.rare.as_ref().map(|r| &r.1);
    let ranges = rare.into_iter().chain([&behaviour.usual]);
    ranges
        .flat_map(|r| [r.low.lead(), r.top().lead()])
        .flatten()
        .any(|g| !g.exponentials.is_empty())
}

/// Bias over c.
pub(super) fn bias_rates(behaviour: &Behaviour, request: &Request) -> Result<Rates, Reason> {
    let (d, p, beta) = (request.dimension, request.bias_order, request.discarded);
    match request.weights {
        Weights::Uniform => power_sum(behaviour, p, beta)?.map(|r| r.over_count(1, 1.0 - beta)),
        Weights::InverseVariance => {
            let (top, bottom) = (
                power_sum(behaviour, d.plus(p), beta)?,
                power_sum(behaviour, d, beta)?,
            );
            Ok(Rates {
                least: top.least.times(&bottom.most.inverse())?,
                most: top.most.times(&bottom.least.inverse())?,
            })
        }
    }
}

fn variance_rates(behaviour: &Behaviour, request: &Request) -> Result<Rates, Reason> {
    let (d, beta) = (request.dimension, request.discarded);
    match request.weights {
        Weights::Uniform => {
            power_sum(behaviour, d.negated(), beta)?.map(|r| r.over_count(2, 1.0 - beta))
        }
        Weights::InverseVariance => {
            let sum = power_sum(behaviour, d, beta)?;
            Ok(Rates {
                least: sum.most.inverse(),
                most: sum.least.inverse(),
            })
        }
    }
}

fn independent(
    behaviour: &Behaviour,
    request: &Request,
    report: &mut Report,
) -> Result<(), Reason> {
    let (d, p) = (request.dimension, request.bias_order);
    let (bias, variance) = (
        bias_rates(behaviour, request)?,
        variance_rates(behaviour, request)?,
    );
    let names = match request.weights {
        Weights::Uniform => [
            format!("mean of alpha^({p})"),
            format!("n^-2 sum of alpha^-({d})"),
        ],
        Weights::InverseVariance => [
            format!("sum of alpha^({}) / sum of alpha^({d})", d.plus(p)),
            format!("1 / sum of alpha^({d})"),
        ],
    };
    let (bias_gone, variance_gone) = (bias.vanishes()?, variance.vanishes()?);
    for (what, name, rates, gone) in [
        ("bias / c", &names[0], &bias, bias_gone),
        ("variance / C", &names[1], &variance, variance_gone),
    ] {
        let verdict = match gone {
            Some(true) => "vanishes",
            Some(false) if rates.least.trend()? == Ordering::Greater => "grows without bound",
            Some(false) => "does not vanish",
            None => "the bounds do not tell whether it vanishes",
        };
        let size = if rates.least.order(&rates.most)? == Ordering::Equal
            && rates.least.coefficient() == rates.most.coefficient()
        {
            format!("~ {}", rates.most)
        } else {
            format!("between {} and {}", rates.least, rates.most)
        };
        report
            .argument
            .push(format!("{what} = {name} {size}: {verdict}"));
    }
    let rate = |r: &Rates| -> Result<Option<Rate>, Reason> {
        let same = r.least.order(&r.most)? == Ordering::Equal;
        let mut rate = r.most.clone();
        rate.has_coefficient &= r.least.coefficient() == r.most.coefficient();
        Ok(same.then_some(rate))
    };
    (report.bias, report.variance) = (rate(&bias)?, rate(&variance)?);
    report.mse = slower(report.bias.as_ref(), report.variance.as_ref())?;
    report.classification = match (bias_gone, variance_gone) {
        (Some(true), Some(true)) => Classification::Consistent,
        (Some(false), _) => Classification::BiasPersists,
        (_, Some(false)) => Classification::VariancePersists,
        _ => Classification::Unknown,
    };
    if let Some(window) = window(behaviour, request) {
        report.argument.push(window);
    }
    Ok(())
}

/// The slower of bias² and variance; its coefficient belongs to c² or C.
pub(super) fn slower(bias: Option<&Rate>, variance: Option<&Rate>) -> Result<Option<Rate>, Reason> {
    let (Some(bias), Some(variance)) = (bias, variance) else {
        return Ok(None);
    };
    let squared = bias.times(bias)?;
    let slower = match squared.order(variance)? {
        Ordering::Less => variance.clone(),
        _ => squared,
    };
    Ok(Some(Rate {
        has_coefficient: false,
        ..slower
    }))
}

/// For a power of n, where it stands in the window of powers.
fn window(behaviour: &Behaviour, request: &Request) -> Option<String> {
    let lead = behaviour.usual.low.lead()?;
    let is_power = behaviour.usual.high.is_none()
        && behaviour.rare.is_none()
        && lead.exponentials.is_empty()
        && lead.log.is_zero();
    let (d, p) = (request.dimension, request.bias_order);
    if !is_power || request.weights != Weights::Uniform || !(p.value() > 0.0) {
        return None;
    }
    let lambda = lead.power.negated();
    let (one, two) = (Number::ONE, Number::integer(2));
    let best = optimal_decay(d, p);
    Some(format!(
        "alpha ~ n^-lambda with lambda = {lambda}: consistent for 0 < lambda < 1/d = {}; the MSE falls fastest, like \
         n^({}), for lambda = 1/(d + 2p) = {best}",
        one.over(d),
        two.times(p).times(best).negated()
    ))
}

/// λ = 1/(d + 2p), for which the MSE of n samples at α ~ n^-λ falls fastest: like n^(-2p/(d + 2p)).
pub fn optimal_decay(dimension: Number, bias_order: Number) -> Number {
    let sum = dimension.plus(bias_order).plus(bias_order);
    Number::ONE.over(sum)
}

/// α₀^(d + 2p) = d C (1 - λp)²/(2 p c² (1 + λd)): the best α₀ of α₀ n^-λ at the best λ, to the power 1/(d + 2p).
pub fn optimal_start(dimension: f64, bias_order: f64, c: f64, variance: f64) -> f64 {
    let (d, p) = (dimension, bias_order);
    let lambda = 1.0 / (d + 2.0 * p);
    let rest = 1.0 - lambda * p;
    let value = d * variance * rest * rest / (2.0 * p * c * c * (1.0 + lambda * d));
    libm::pow(value, lambda)
}

fn finite(schedule: &Expression, request: &Request) -> Vec<FiniteRow> {
    let rows = [0, 10, 20, 30, 40].map(|j| 1_u64 << j);
    finite_rows(schedule, request, &rows, BUDGET)
}

/// The sums at these numbers of samples, which ascend, at the cost of about `budget` evaluations.
pub fn finite_rows(
    schedule: &Expression,
    request: &Request,
    rows: &[u64],
    budget: u64,
) -> Vec<FiniteRow> {
    let (d, p) = (request.dimension.value(), request.bias_order.value());
    let exponents = match request.weights {
        Weights::Uniform => [p, -d],
        Weights::InverseVariance => [d + p, d],
    };
    let dropped = |n: u64| libm::floor(request.discarded * n as f64) as u64;
    let mut needed: Vec<u64> = rows.iter().flat_map(|&n| [dropped(n), n]).collect();
    needed.sort_unstable();
    needed.dedup();
    let mut sums = PowerSums::new(schedule, exponents, budget);
    let mut known: Vec<(u64, [f64; 2])> = Vec::new();
    for n in needed {
        let Some(sum) = sums.up_to(n) else {
            break;
        };
        known.push((n, sum));
    }
    let at = |n: u64| known.iter().find(|k| k.0 == n).map(|k| k.1);
    let row = |&n: &u64| {
        let count = (n - dropped(n)) as f64;
        let sums = at(n).zip(at(dropped(n))).map(|(all, first)| {
            let [a, b] = [all[0] - first[0], all[1] - first[1]];
            match request.weights {
                Weights::Uniform => [a / count, b / (count * count)],
                Weights::InverseVariance => [a / b, 1.0 / b],
            }
        });
        let finite = |i: usize| sums.map(|s| s[i]).filter(|v| v.is_finite());
        FiniteRow {
            n,
            alpha: schedule.at(n),
            bias: finite(0),
            variance: finite(1),
        }
    };
    rows.iter().map(row).collect()
}

impl Report {
    /// The finite rows that were too expensive or leave the range of f64, for a remark.
    pub fn missing(&self) -> usize {
        let missing = |r: &&FiniteRow| r.bias.is_none() || r.variance.is_none();
        self.finite.iter().filter(missing).count()
    }

    pub(super) fn say(&mut self, text: String) {
        self.argument.push(text);
    }
}

/// A share in per cent.
pub(super) fn percent(share: f64) -> String {
    format!("{} %", significant(100.0 * share))
}
