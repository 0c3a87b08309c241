//! Sine and cosine of a number of turns: the same bits everywhere, without a branch.
//!
//! `u` turns are split into the nearest quarter turn and a rest of at most an eighth (both exact), and the rest's sine
//! and cosine are polynomials on [-π/4, π/4] with the coefficients of FreeBSD's `k_sin.c` and `k_cos.c` (msun).
//! Domain: |u| ≤ 2^20. Accuracy: absolute error below 3e-16, which the tests measure.

use core::f64::consts::TAU;

/// Adding and subtracting this rounds to the nearest whole number, ties to even, if |x| < 2^51.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// (sin 2πu, cos 2πu).
#[inline(always)]
pub fn sin_cos_of_turns(u: f64) -> (f64, f64) {
    let shifted = 4.0 * u + ROUND;
    // The low bits of the shifted number are the quarter turn, in two's complement.
    let quarter = shifted.to_bits();
    let x = (u - 0.25 * (shifted - ROUND)) * TAU;
    let z = x * x;
    let sin_rest = 8.333_333_333_322_49e-3
        + z * (-1.984_126_982_985_795e-4
            + z * (2.755_731_370_707_006_8e-6
                + z * (-2.505_076_025_340_686_3e-8 + z * 1.589_690_995_211_55e-10)));
    let s = x + x * z * (-1.666_666_666_666_663_2e-1 + z * sin_rest);
    let cos_rest = 4.166_666_666_666_66e-2
        + z * (-1.388_888_888_887_411e-3
            + z * (2.480_158_728_947_673e-5
                + z * (-2.755_731_435_139_066_3e-7
                    + z * (2.087_572_321_298_175e-9 + z * -1.135_964_755_778_819_5e-11))));
    let c = 1.0 - (0.5 * z - z * z * cos_rest);
    let odd = quarter & 1 == 1;
    let (sine, cosine) = if odd { (c, s) } else { (s, c) };
    // Bit 1 of the quarter negates the sine; bits 0 and 1 together, by exclusive or, the cosine.
    let sine_sign = (quarter & 2) << 62;
    let cosine_sign = ((quarter ^ (quarter << 1)) & 2) << 62;
    (
        f64::from_bits(sine.to_bits() ^ sine_sign),
        f64::from_bits(cosine.to_bits() ^ cosine_sign),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// libm at the rest in [0, 1/8] turns, which symmetry alone gives exactly for u in [0, 1].
    fn reference(u: f64) -> (f64, f64) {
        let (u, s_sign) = if u > 0.5 { (1.0 - u, -1.0) } else { (u, 1.0) };
        let (u, c_sign) = if u > 0.25 { (0.5 - u, -1.0) } else { (u, 1.0) };
        let (s, c) = if u > 0.125 {
            (libm::cos((0.25 - u) * TAU), libm::sin((0.25 - u) * TAU))
        } else {
            (libm::sin(u * TAU), libm::cos(u * TAU))
        };
        (s * s_sign, c * c_sign)
    }

    #[test]
    fn agrees_with_libm_over_the_turn() {
        let steps = 1_000_003;
        let mut worst = 0.0_f64;
        for k in 0..=steps {
            let u = f64::from(k) / f64::from(steps);
            let (s, c) = sin_cos_of_turns(u);
            let (rs, rc) = reference(u);
            worst = worst.max((s - rs).abs()).max((c - rc).abs());
            assert_eq!(sin_cos_of_turns(-u), (-s, c));
        }
        assert!(worst < 3e-16, "{worst:e}");
    }

    #[test]
    fn quarter_turns_are_exact() {
        for (u, expected) in [
            (0.0, (0.0, 1.0)),
            (0.25, (1.0, 0.0)),
            (0.5, (0.0, -1.0)),
            (0.75, (-1.0, 0.0)),
            (1.0, (0.0, 1.0)),
        ] {
            assert_eq!(sin_cos_of_turns(u), expected, "{u}");
        }
    }
}
