//! All zeros of a function of one variable on an interval, with a proof that they are all.
//!
//! Bisection with three tests on every part X (R. E. Moore, R. B. Kearfott & M. J. Cloud, Introduction to Interval
//! Analysis, SIAM 2009, §8):
//!
//! * no zero: 0 is not in f(X), nor in the mean value form f(m) + f'(X)(X - m);
//! * at most one zero: 0 is not in f'(X). The signs of f at the ends, where they are certain, then tell whether it is
//!   there: opposite signs are its existence. Parts are cut where the sign is certain;
//! * exactly one zero, however uncertain the signs at the ends are: N(X) = m - f(m)/f'(X) lies inside X.
//!
//! A zero is then narrowed by the same interval Newton step to where rounding ends it. What is narrower than rounding
//! allows and still undecided (two zeros within rounding of each other: a fold; or a zero within rounding of an end) is
//! handed out as such. f must be continuous on the interval, and its slope enclosed wherever it exists; a function whose
//! slope is unbounded somewhere is decided there by the first test or not at all.

use crate::enclosure::Enclosure;
use crate::gradient::Gradient;
use crate::scalar::Scalar;

/// A number that carries its derivative.
pub type Jet = Gradient<Enclosure, 1>;

/// The zeros of a function on an interval.
#[derive(Clone, Debug, Default)]
pub struct Zeros {
    /// Each contains exactly one zero, which is simple; in ascending order, all zeros outside of `undecided`.
    pub simple: Vec<Enclosure>,
    /// May contain any number of zeros.
    pub undecided: Vec<Enclosure>,
    /// How many parts of the interval were looked at.
    pub parts: u32,
}

/// No part is narrower than this times the interval and its ends' moduli.
const NARROWEST: f64 = 1e-15;

/// The most parts that are looked at; the rest is undecided.
const MOST_PARTS: u32 = 200_000;

/// Where a part is cut: off the middle, where symmetric functions have their zeros.
const CUTS: [f64; 5] = [0.4871, 0.5193, 0.4337, 0.5641, 0.3719];

/// All zeros of `f` on [low, high].
pub fn isolate(low: f64, high: f64, f: impl Fn(Jet) -> Jet) -> Zeros {
    let narrowest = NARROWEST * ((high - low) + low.abs() + high.abs());
    let search = Search { f, narrowest };
    let mut found = Zeros::default();
    let mut left = vec![Part {
        at: Enclosure::new(low, high),
        first: search.sign_at(low),
        last: search.sign_at(high),
    }];
    while let Some(part) = left.pop() {
        found.parts += 1;
        match search.judge(&part) {
            Verdict::None => {}
            Verdict::One(zero) => found.simple.push(zero),
            Verdict::Unknown => match search.cut(&part) {
                Some((first, last)) if found.parts < MOST_PARTS => {
                    left.push(last);
                    left.push(first);
                }
                _ => found.leave(part.at),
            },
        }
    }
    search.settle(&mut found, low, high);
    found
}

/// All zeros of a function of period 2π on one turn; `None` if it has none of a few places where it is certainly not 0,
/// so that a turn cannot begin there.
pub fn full_turn(f: impl Fn(Jet) -> Jet) -> Option<Zeros> {
    let turn = Enclosure::TWO * Enclosure::PI;
    let start = (0..16)
        .map(|i| -3.0 + 0.377 * f64::from(i))
        .find(|&start| {
            // The turn ends within rounding behind its beginning: nothing may be found twice there.
            let seam = Enclosure::new(start, start + 1e-9);
            !f(Jet::constant(seam)).value.may_vanish()
        })?;
    Some(isolate(start, start + turn.high() + 1e-12, f))
}

/// An interval with the signs of f at its ends, where they are certain.
struct Part {
    at: Enclosure,
    first: Option<i8>,
    last: Option<i8>,
}

enum Verdict {
    None,
    One(Enclosure),
    Unknown,
}

impl Zeros {
    /// Parts come in ascending order: neighbours become one.
    fn leave(&mut self, part: Enclosure) {
        match self.undecided.last_mut() {
            Some(last) if last.high() >= part.low() => *last = last.hull(part),
            _ => self.undecided.push(part),
        }
    }
}

struct Search<F> {
    f: F,
    narrowest: f64,
}

impl<F: Fn(Jet) -> Jet> Search<F> {
    fn value(&self, at: Enclosure) -> Enclosure {
        (self.f)(Jet::constant(at)).value
    }

    fn sign_at(&self, at: f64) -> Option<i8> {
        self.value(Enclosure::point(at)).sign()
    }

    /// Value and slope over all of `at`.
    fn over(&self, at: Enclosure) -> (Enclosure, Enclosure) {
        let out = (self.f)(Jet::input(at, 0, Enclosure::ONE));
        (out.value, out.slopes[0])
    }

    fn judge(&self, part: &Part) -> Verdict {
        let (value, slope) = self.over(part.at);
        if !value.may_vanish() {
            return Verdict::None;
        }
        let middle = Enclosure::point(part.at.middle());
        let there = self.value(middle);
        if !(there + slope * (part.at - middle)).may_vanish() {
            return Verdict::None;
        }
        if slope.may_vanish() {
            return Verdict::Unknown;
        }
        match (part.first, part.last) {
            (Some(a), Some(b)) if a == b => Verdict::None,
            (Some(_), Some(_)) => Verdict::One(self.narrow(part.at)),
            // An uncertain end: the Newton step settles it, or a smaller part does.
            _ => {
                let step = middle - there / slope;
                if part.at.low() < step.low() && step.high() < part.at.high() {
                    Verdict::One(self.narrow(part.at))
                } else if step.intersection(part.at).is_none() {
                    Verdict::None
                } else {
                    Verdict::Unknown
                }
            }
        }
    }

    /// The parts left and right of a place where the sign of f is certain, if there is one.
    fn cut(&self, part: &Part) -> Option<(Part, Part)> {
        let width = part.at.high() - part.at.low();
        if !(width > self.narrowest) {
            return None;
        }
        let place = |share: f64| part.at.low() + share * width;
        // Where the sign is nowhere certain, f is within rounding of 0 all over the part.
        let (at, sign) = CUTS.iter().find_map(|&share| {
            let at = place(share);
            self.sign_at(at).map(|sign| (at, Some(sign)))
        })?;
        if !(part.at.low() < at && at < part.at.high()) {
            return None;
        }
        Some((
            Part {
                at: Enclosure::new(part.at.low(), at),
                first: part.first,
                last: sign,
            },
            Part {
                at: Enclosure::new(at, part.at.high()),
                first: sign,
                last: part.last,
            },
        ))
    }

    /// Narrows an interval that contains exactly one zero and on which the slope does not vanish.
    fn narrow(&self, zero: Enclosure) -> Enclosure {
        let mut zero = zero;
        for _ in 0..64 {
            let middle = Enclosure::point(zero.middle());
            let (_, slope) = self.over(zero);
            let step = middle - self.value(middle) / slope;
            let Some(narrower) = step.intersection(zero) else {
                break;
            };
            let gain = narrower.width() < 0.9 * zero.width();
            zero = narrower;
            if !gain {
                break;
            }
        }
        zero
    }

    /// Undecided parts inside the interval, widened a little, may turn out to contain exactly one zero: one that a cut has
    /// hit.
    fn settle(&self, found: &mut Zeros, low: f64, high: f64) {
        let mut rest = vec![];
        for part in core::mem::take(&mut found.undecided) {
            let room = part.width() + 16.0 * self.narrowest;
            let (from, to) = (part.low() - room, part.high() + room);
            let wide = Enclosure::new(from, to);
            let others = found.simple.iter().any(|z| z.intersection(wide).is_some());
            let (_, slope) = self.over(wide);
            let signs = (self.sign_at(from), self.sign_at(to));
            let settled = from > low && to < high && !others && !slope.may_vanish();
            match signs {
                (Some(a), Some(b)) if settled => {
                    if a != b {
                        found.simple.push(self.narrow(wide));
                    }
                }
                _ => rest.push(part),
            }
        }
        found.undecided = rest;
        found.simple.sort_by(|a, b| a.low().total_cmp(&b.low()));
    }
}

#[cfg(test)]
mod tests {
    use super::{Jet, isolate};
    use crate::scalar::Scalar;

    #[test]
    fn counts_and_encloses() {
        let one = Jet::ONE;
        let half = Jet::HALF;
        // x (x - 1/2)(x + 1/2), sin over three periods, a double zero, none.
        let cubic = isolate(-2.0, 2.0, |x| x * (x - half) * (x + half));
        assert!(
            cubic.undecided.is_empty() && cubic.simple.len() == 3,
            "{cubic:?}"
        );
        for (zero, exact) in cubic.simple.iter().zip([-0.5, 0.0, 0.5]) {
            assert!(zero.contains(exact) && zero.width() < 1e-15, "{zero:?}");
        }
        let waves = isolate(0.5, 19.5, |x| x.sin());
        assert!(
            waves.undecided.is_empty() && waves.simple.len() == 6,
            "{waves:?}"
        );
        let none = isolate(-1.0, 1.0, |x| {
            x * x + Jet::constant(crate::enclosure::Enclosure::point(1e-9))
        });
        assert!(
            none.undecided.is_empty() && none.simple.is_empty(),
            "{none:?}"
        );
        let two = isolate(-1.0, 1.0, |x| {
            x * x - Jet::constant(crate::enclosure::Enclosure::point(1e-14))
        });
        assert!(two.undecided.is_empty() && two.simple.len() == 2, "{two:?}");
        let double = isolate(0.0, 1.0, |x| (x - half) * (x - half) * (x + one));
        assert!(
            double.simple.is_empty() && double.undecided.len() == 1,
            "{double:?}"
        );
        assert!(
            double.undecided[0].contains(0.5) && double.undecided[0].width() < 1e-6,
            "{double:?}"
        );
    }
}
