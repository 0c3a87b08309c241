//! Schedules for a chain with a rate that does not depend on α: γⁿ ≪ αₙ ≪ 1, and what a geometric decay loses.

use core::cmp::Ordering;

use super::super::asymptotics::{Behaviour, Reason, because};
use super::super::classify::{Classification, Report, Request, bias_rates, percent, slower};
use super::super::growth::{Growth, order};
use super::super::number::{Number, significant};
use super::super::rate::Rate;
use super::refresh::{critical_ratio, lost_share};

/// Replaces the answer for independent samples by that for the chain.
pub(in super::super) fn classify(
    behaviour: &Behaviour,
    request: &Request,
    rate: f64,
    report: &mut Report,
) {
    let independent = report.independent.name();
    report.argument.clear();
    report.variance = None;
    report.mse = None;
    report.classification = Classification::Unknown;
    if let Err(Reason(reason)) = decide(behaviour, request, rate, report) {
        report.classification = Classification::Unknown;
        report.say(format!("not decided: {reason}"));
    }
    report.say(format!(
        "this holds for a chain whose rate {} does not depend on alpha; one that must find the lobe by blind proposals \
         has a gap of alpha^d and needs what independent samples need: {independent}",
        significant(rate)
    ));
}

/// How a schedule shrinks from step to step.
#[expect(clippy::large_enum_variant, reason = "lives for one match only")]
enum Shrinking {
    /// αₙ₊₁/αₙ → 1; the loss per step falls like this, if it is known.
    Slow(Option<Rate>),
    /// αₙ₊₁/αₙ → g < 1.
    Geometric(f64),
    /// αₙ₊₁/αₙ → 0.
    Faster,
}

fn decide(
    behaviour: &Behaviour,
    request: &Request,
    rate: f64,
    report: &mut Report,
) -> Result<(), Reason> {
    let d = request.dimension.value();
    let bias = bias_rates(behaviour, request)?;
    match bias.vanishes()? {
        Some(true) => report.say(format!(
            "the mean bias of the targets ~ {}: vanishes",
            bias.most
        )),
        Some(false) => {
            report.say(format!(
                "the mean bias of the targets does not vanish: at least {}",
                bias.least
            ));
            report.classification = Classification::BiasPersists;
            return Ok(());
        }
        None => return because("the bounds do not tell whether the mean bias vanishes"),
    }
    // A chain that forgets everything in a step is at every target.
    let shrinking = if rate == 0.0 {
        Shrinking::Slow(None)
    } else {
        shrinking(behaviour, d)?
    };
    match shrinking {
        Shrinking::Slow(loss) => {
            report.say(
                "alpha_(n+1)/alpha_n -> 1: what a step throws out vanishes, and the chain, which forgets at a fixed rate, \
                 follows; covariances decay geometrically, so the variance ~ n^(-1)"
                    .to_owned(),
            );
            report.classification = Classification::Consistent;
            let variance = Rate::without_coefficient(Growth::power_log(
                Number::ONE,
                Number::integer(-1),
                Number::ZERO,
            ));
            let tracked = match loss {
                None => None,
                Some(loss) if loss.order(&bias.most)? == Ordering::Greater => {
                    report.say(format!("the chain lags behind by a mean share ~ {loss}"));
                    Some(loss)
                }
                Some(_) => Some(bias.most.clone()),
            };
            report.bias = if rate == 0.0 {
                Some(bias.most)
            } else {
                tracked
            };
            report.mse = slower(report.bias.as_ref(), Some(&variance))?;
            report.variance = Some(variance);
        }
        Shrinking::Geometric(ratio) => {
            let lost = lost_share(1.0 - rate, ratio, d);
            let critical = critical_ratio(rate, d);
            let side = if ratio > critical {
                "slower than"
            } else {
                "not slower than"
            };
            report.say(format!(
                "alpha_(n+1)/alpha_n -> {}: {side} the outer bound {} = rate^(1/d), but every step throws the share \
                 1 - {0}^d of the lobe out, and a chain of which only the rate is known loses {} of it for ever",
                significant(ratio),
                significant(critical),
                percent(lost)
            ));
            lose(report, lost);
        }
        Shrinking::Faster => {
            report.say(format!(
                "alpha_(n+1)/alpha_n -> 0: every step throws the lobe out, and what has not been refreshed, {}, is lost",
                percent(rate)
            ));
            lose(report, rate);
        }
    }
    Ok(())
}

fn lose(report: &mut Report, share: f64) {
    report.lost_share = Some(share);
    report.classification = Classification::BiasPersists;
    report.bias = None;
    report.say(
        "decay slower than every geometric sequence is safe; proposals that move inwards on every step may follow a \
         geometric one, which is for them to prove"
            .to_owned(),
    );
}

fn shrinking(behaviour: &Behaviour, d: f64) -> Result<Shrinking, Reason> {
    let range = &behaviour.usual;
    let Some(lead) = range.low.lead().filter(|_| range.high.is_none()) else {
        return because(
            "the bandwidth oscillates, and its bounds do not tell how much a step throws out",
        );
    };
    // Exceptions at powers of a base are O(ln n) steps, each forgotten at a fixed rate: a share O(ln(n)/n) of all steps.
    if let Some((q, s)) = lead.exponentials.first() {
        if order(*q, Number::ZERO)? == Ordering::Greater {
            return Ok(Shrinking::Slow(None));
        }
        return Ok(match order(*s, Number::ONE)? {
            Ordering::Equal => Shrinking::Geometric(libm::exp(q.value())),
            Ordering::Greater => Shrinking::Faster,
            // The share 1 - (αₙ₊₁/αₙ)^d ~ d |q| s n^(s-1), and so its mean up to a factor.
            Ordering::Less => Shrinking::Slow(Some(Rate::without_coefficient(Growth::power_log(
                Number::ONE,
                s.minus(Number::ONE),
                Number::ZERO,
            )))),
        });
    }
    // The share d |a|/n, whose mean is ~ ln(n)/n.
    let known = range.low.exact && lead.power.value() * d < 0.0;
    Ok(Shrinking::Slow(known.then(|| {
        Rate::without_coefficient(Growth::power_log(
            Number::ONE,
            Number::integer(-1),
            Number::ONE,
        ))
    })))
}
