//! Fits on synthetic data of known law.

use libm::{cos, log, pow, sqrt};
use nephroid::rates::counts::{none_of, p_bound};
use nephroid::rates::power_law::Design;
use nephroid::rates::variance::variance_slope;
use nephroid::stream::{philox, uniform};

use super::BANDWIDTHS;

/// Standard normal values one after the other.
struct Normal {
    seed: u32,
    counter: u32,
}

impl Normal {
    fn next(&mut self) -> f64 {
        self.counter += 1;
        let [a, b, c, d] = philox([self.counter, 9, 0, 0], [self.seed, 41]);
        let (u, v) = (uniform(a, b), uniform(c, d));
        sqrt(-2.0 * log(1.0 - u)) * cos(core::f64::consts::TAU * v)
    }
}

/// Replicates of y = c x² with noise that grows like 1/x, and their design.
fn power_data(normal: &mut Normal, count: usize, c: f64) -> (Design, Vec<Vec<f64>>) {
    let weights = BANDWIDTHS.map(|x| x * x);
    let rows = (0..count)
        .map(|_| BANDWIDTHS.map(|x| c * x * x + normal.next() / x).to_vec())
        .collect();
    (Design::new(&BANDWIDTHS, &weights), rows)
}

#[test]
fn an_exponent_without_noise_is_exact() {
    for p in [-3.0, -0.5, 0.0, 1.0 / 3.0, 2.0, 4.0] {
        let design = Design::new(&BANDWIDTHS, &[1.0, 4.0, 0.1, 7.0]);
        let y = BANDWIDTHS.map(|x| -3e-4 * pow(x, p));
        assert!((design.exponent_of(&y) - p).abs() < 1e-6, "{p}");
        // The contrast does not see the coefficient.
        let t: f64 = design.contrast(p).iter().zip(y).map(|(a, y)| a * y).sum();
        let size: f64 = design
            .contrast(p)
            .iter()
            .zip(y)
            .map(|(a, y)| (a * y).abs())
            .sum();
        assert!(t.abs() < 1e-12 * size);
    }
}

/// Coverage of the 95 % interval from a strong signal down to none, 400 data sets each: fewer than 358 covered would be 4.9 standard
/// deviations off, and fewer than 3 or more than 46 rejections of the truth at level 0.05 have a probability of 6e-7.
#[test]
fn intervals_of_exponents_cover_at_any_noise() {
    let mut normal = Normal {
        seed: 3,
        counter: 0,
    };
    for signal in [200.0, 30.0, 8.0, 0.0] {
        let (mut covered, mut bounded, mut rejected) = (0, 0, 0);
        for _ in 0..400 {
            let (design, rows) = power_data(&mut normal, 16, signal);
            let fit = design.fit(&rows, 0.05);
            covered += u32::from((fit.interval[0]..=fit.interval[1]).contains(&2.0));
            bounded += u32::from(fit.half_width().is_finite());
            let exact = BANDWIDTHS.map(|x| signal * x * x);
            rejected += u32::from(signal > 0.0 && design.p_value(&exact, &[0.0; 4], &rows) < 0.05);
        }
        println!(
            "signal {signal}: covered {covered}, bounded {bounded}, rejected {rejected} of 400"
        );
        assert!(covered >= 358, "signal {signal}: {covered}");
        assert!(signal == 0.0 || (3..=46).contains(&rejected), "{rejected}");
        // With a strong signal intervals are bounded, without any they are not.
        assert!(signal < 200.0 || bounded == 400);
        assert!(signal > 0.0 || bounded < 40, "{bounded}");
    }
}

#[test]
fn slopes_of_variances_of_running_means() {
    // Var ~ n⁻¹ from running means of white noise: the samples are shared between the n, and the jackknife knows.
    let mut normal = Normal {
        seed: 5,
        counter: 0,
    };
    let n: Vec<f64> = (0..6).map(|k| f64::from(1 << k)).collect();
    let (mut covered, trials) = (0, 200);
    for _ in 0..trials {
        let rows: Vec<Vec<f64>> = (0..64)
            .map(|_| {
                let (mut sum, mut row) = (0.0, Vec::new());
                for i in 1..=32_u32 {
                    sum += normal.next();
                    if i.is_power_of_two() {
                        row.push(sum / f64::from(i));
                    }
                }
                row
            })
            .collect();
        let slope = variance_slope(&n, &rows, 0.05);
        covered += u32::from((slope.interval[0]..=slope.interval[1]).contains(&-1.0));
        assert!(slope.p_value(-1.0) > 1e-7);
    }
    // 190 ± 3 expected; fewer than 174 would be five standard deviations off.
    println!("covered {covered} of {trials}");
    assert!(covered >= 174, "{covered}");
}

#[test]
fn bounds_of_counts_are_bounds() {
    // Against the exact binomial tail, 2 P(S ≥ s), by summation.
    let (n, q) = (40, 0.1_f64);
    let term = |s: i32| {
        let choose = (0..s).fold(1.0, |c, i| c * f64::from(n - i) / f64::from(i + 1));
        choose * pow(q, f64::from(s)) * pow(1.0 - q, f64::from(n - s))
    };
    for s in 5..20 {
        let exact: f64 = (s..=n).map(term).sum();
        let bound = p_bound(s as u64, f64::from(n), 4.0, 0.0);
        assert!(
            bound >= exact && bound <= 30.0 * exact.max(0.02),
            "{s}: {bound} {exact}"
        );
    }
    assert_eq!(p_bound(4, 40.0, 4.0, 0.0), 1.0);
    assert_eq!(p_bound(5, 40.0, 4.0, 1.0), 1.0);
    assert_eq!(p_bound(1, 40.0, 0.0, 0.0), 0.0);
    assert!((none_of(0.1, 40.0) - pow(0.9, 40.0)).abs() < 1e-15);
}
