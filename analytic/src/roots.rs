//! Root finding that loses no root: Newton's method inside a bracket, and isolation by proven monotone pieces.
//!
//! Neither depends on a starting guess. [`bracketed`] needs a sign change; [`for_each_root`] makes the sign changes
//! itself: it splits the interval until a bound on the second derivative proves of each piece that the function has no
//! zero there, or that it is monotone there and so has exactly one zero if its ends differ in sign.

use crate::scalar::Scalar;

/// The zero of `f` between `low` and `high`, where `f` changes sign; `f` returns the value and the derivative.
///
/// Newton's method, replaced by bisection whenever a step leaves the bracket or does not halve the last one: it converges
/// for every continuous function. A zero at an end is found as well.
///
/// **Accuracy**: the step that would still be taken is below half a unit in the last place of the answer, or the value
/// is below what rounding lets `f` resolve.
#[inline]
pub fn bracketed<S: Scalar>(f: impl Fn(S) -> (S, S), low: S, high: S) -> S {
    let rising = f(low).0 <= S::ZERO;
    bracketed_from(f, low, high, S::HALF * (low + high), rising)
}

/// As [`bracketed`], from a starting point inside the bracket and with the direction known: `rising` says that `f` is
/// negative (or zero) at `low`.
#[inline]
pub fn bracketed_from<S: Scalar>(
    f: impl Fn(S) -> (S, S),
    low: S,
    high: S,
    start: S,
    rising: bool,
) -> S {
    let exact = |x: S| {
        let (value, slope) = f(x);
        Sample {
            value,
            slope,
            noise: S::ZERO,
        }
    };
    resolved(exact, low, high, start, rising)
}

/// A function at a point, for [`resolved`].
#[derive(Clone, Copy, Debug)]
pub struct Sample<S> {
    /// Value.
    pub value: S,
    /// First derivative.
    pub slope: S,
    /// What rounding can add to the value.
    pub noise: S,
}

/// As [`bracketed_from`], for a function that knows its rounding: a value within it is followed by one last step, if the
/// slope says that this is a short one.
///
/// Where rounding is all that a value holds, further steps do not shrink, and the bracket would be halved to the last bit.
///
/// **Accuracy**: the rounding of the last value over the slope; Newton's error from a point within `noise` of the zero is
/// below that except where two zeros cannot be told apart.
#[inline]
pub fn resolved<S: Scalar>(
    f: impl Fn(S) -> Sample<S>,
    low: S,
    high: S,
    start: S,
    rising: bool,
) -> S {
    let (mut below, mut above) = (low, high);
    let mut x = start;
    let mut last = (high - low).abs();
    // A zero at 0 has no relative accuracy to reach.
    let floor = S::EPSILON.squared() * last;
    for _ in 0..128 {
        let Sample {
            value,
            slope,
            noise,
        } = f(x);
        if value == S::ZERO {
            return x;
        }
        let newton = x - value / slope;
        // Beside an extremum a value within rounding says little of where the zero is.
        let settled = noise <= S::from_f64(1e-3) * (slope * (above - below)).abs();
        if value.abs() <= noise && settled && (newton - below) * (newton - above) <= S::ZERO {
            return newton;
        }
        if (value < S::ZERO) == rising {
            below = x;
        } else {
            above = x;
        }
        let inside = (newton - below) * (newton - above) < S::ZERO;
        let step = (newton - x).abs();
        let next = if inside && step <= S::HALF * last {
            last = step;
            newton
        } else {
            let middle = S::HALF * (below + above);
            last = (middle - x).abs();
            middle
        };
        if (next - x).abs() <= S::EPSILON * S::HALF * next.abs() + floor
            || next == below
            || next == above
        {
            return next;
        }
        x = next;
    }
    x
}

/// What [`for_each_root`] must know of a function on [centre - half, centre + half].
#[derive(Clone, Copy, Debug)]
pub struct Local<S> {
    /// Value at the centre.
    pub value: S,
    /// First derivative at the centre.
    pub slope: S,
    /// An upper bound of the absolute second derivative on the whole interval.
    pub curvature: S,
    /// What rounding can add to the value.
    pub noise: S,
}

/// A zero, or what cannot be told from one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Isolated<S> {
    /// A simple zero.
    Simple(S),
    /// The function touches zero to within rounding: a double zero, two zeros or none.
    Touching(S),
}

/// Deepest subdivision. Pieces are never narrower than √ε of the interval, so this is never reached.
const DEPTH: usize = 64;

/// Visits all zeros of a twice differentiable function on [low, high) in ascending order, without allocation.
///
/// On a piece of half width h about m with |f''| ≤ B: there is no zero if |f(m)| > |f'(m)| h + B h²/2, and f is monotone
/// if |f'(m)| > B h. A piece of which neither holds is halved, down to √ε times the interval; what is still undecided
/// there is a sign change (visited as simple) or touches zero to within rounding.
#[inline]
pub fn for_each_root<S: Scalar>(
    low: S,
    high: S,
    local: impl Fn(S, S) -> Local<S>,
    visit: impl FnMut(Isolated<S>),
) {
    let at = |x: S| {
        let f = local(x, S::ZERO);
        Sample {
            value: f.value,
            slope: f.slope,
            noise: f.noise,
        }
    };
    for_each_root_of(low, high, at, &local, visit);
}

/// As [`for_each_root`], where the function alone, `at`, costs less than with the bound of its second derivative.
#[inline]
pub fn for_each_root_of<S: Scalar>(
    low: S,
    high: S,
    at: impl Fn(S) -> Sample<S>,
    local: impl Fn(S, S) -> Local<S>,
    mut visit: impl FnMut(Isolated<S>),
) {
    let narrowest = S::EPSILON.sqrt() * (high - low).abs();
    // The right ends of the pieces that are left, the next one last, and the left end of the next.
    let mut ends = [(S::ZERO, S::ZERO); DEPTH];
    ends[0] = (high, at(high).value);
    let (mut a, mut at_a) = (low, at(low).value);
    let mut size = 1;
    while size > 0 {
        let (b, at_b) = ends[size - 1];
        let (middle, half) = (S::HALF * (a + b), S::HALF * (b - a));
        let f = local(middle, half);
        let changes = (at_a <= S::ZERO) != (at_b <= S::ZERO);
        let reach = f.slope.abs() * half + S::HALF * f.curvature * half.squared();
        let empty = !changes && f.value.abs() > reach + f.noise;
        let monotone = f.slope.abs() > f.curvature * half;
        let exhausted = half <= narrowest || size == DEPTH;
        if empty || monotone || exhausted {
            if changes {
                let rising = at_a <= S::ZERO;
                // The half with the sign change, from Newton's step off the middle or else from the secant.
                let (low, high, at_low, at_high) = if (f.value <= S::ZERO) == rising {
                    (middle, b, f.value, at_b)
                } else {
                    (a, middle, at_a, f.value)
                };
                let newton = middle - f.value / f.slope;
                let start = if (newton - low) * (newton - high) < S::ZERO {
                    newton
                } else {
                    low - at_low * ((high - low) / (at_high - at_low))
                };
                visit(Isolated::Simple(resolved(&at, low, high, start, rising)));
            } else if !monotone && f.value.abs() <= reach + f.noise {
                visit(Isolated::Touching(middle));
            }
            (a, at_a) = (b, at_b);
            size -= 1;
        } else {
            ends[size] = (middle, f.value);
            size += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn roots(low: f64, high: f64, local: impl Fn(f64, f64) -> Local<f64>) -> Vec<Isolated<f64>> {
        let mut found = vec![];
        for_each_root(low, high, local, |r| found.push(r));
        found
    }

    fn sine(frequency: f64, offset: f64) -> impl Fn(f64, f64) -> Local<f64> {
        move |x, _| Local {
            value: libm::sin(frequency * x) - offset,
            slope: frequency * libm::cos(frequency * x),
            curvature: frequency * frequency,
            noise: 4.0 * f64::EPSILON,
        }
    }

    #[test]
    fn every_root_of_a_fast_sine_is_found() {
        let found = roots(0.1, 100.1, sine(7.0, 0.25));
        let expected = (0..400)
            .flat_map(|k| {
                let turn = 2.0 * core::f64::consts::PI * f64::from(k);
                let first = libm::asin(0.25);
                [
                    (turn + first) / 7.0,
                    (turn + core::f64::consts::PI - first) / 7.0,
                ]
            })
            .filter(|x| (0.1..100.1).contains(x))
            .collect::<Vec<_>>();
        assert_eq!(found.len(), expected.len());
        for (f, e) in found.iter().zip(&expected) {
            assert!(
                matches!(f, Isolated::Simple(x) if (x - e).abs() <= 1e-12),
                "{f:?} {e}"
            );
        }
    }

    #[test]
    fn pairs_near_a_double_root_are_resolved() {
        for gap in [1e-2, 1e-4, 1e-6, 1e-9] {
            // sin x = cos(gap) has roots π/2 ± gap.
            let found = roots(0.0, 3.0, sine(1.0, libm::cos(gap)));
            let simple = found
                .iter()
                .filter(|r| matches!(r, Isolated::Simple(_)))
                .count();
            let touching = found.len() - simple;
            let resolved = gap > 1e-8;
            assert_eq!(simple, if resolved { 2 } else { 0 }, "{gap} {found:?}");
            assert_eq!(touching == 0, resolved, "{gap} {found:?}");
        }
        assert!(roots(0.0, 3.0, sine(1.0, 1.0 + 1e-6)).is_empty());
    }

    #[test]
    fn bracketed_survives_flat_and_steep_functions() {
        let cube = bracketed(|x: f64| (x * x * x - 1e-30, 3.0 * x * x), -1.0, 1.0);
        assert!((cube - 1e-10).abs() <= 1e-22, "{cube:e}");
        let end = bracketed(|x: f64| (x, 1.0), 0.0, 1.0);
        assert!(end.abs() <= 1e-31, "{end:e}");
    }
}
