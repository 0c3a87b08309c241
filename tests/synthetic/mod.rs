//! Data whose distribution is known, drawn with the same counter-based generator as everything else.

use libm::{cos, log, sqrt};
use nephroid::judge::evidence::{Invalid, Sample, moments};
use nephroid::stream::{philox, uniform};

/// Random numbers one after the other.
pub struct Random {
    seed: u32,
    counter: u32,
}

impl Random {
    /// A stream of its own for each seed.
    pub fn new(seed: u32) -> Self {
        Random { seed, counter: 0 }
    }

    /// Two uniforms in [0, 1).
    pub fn pair(&mut self) -> (f64, f64) {
        self.counter += 1;
        let [a, b, c, d] = philox([self.counter, 0, 0, 0], [self.seed, 77]);
        (uniform(a, b), uniform(c, d))
    }

    /// Standard normal [Box & Muller 1958].
    pub fn normal(&mut self) -> f64 {
        let (u, v) = self.pair();
        sqrt(-2.0 * log(1.0 - u)) * cos(core::f64::consts::TAU * v)
    }

    /// Sum of `count` exponential variables of mean 1.
    pub fn gamma(&mut self, count: u32) -> f64 {
        // Four at a time: the logarithm of a product of uniforms.
        let mut product = 1.0;
        let mut sum = 0.0;
        for _ in 0..count / 2 {
            let (u, v) = self.pair();
            product *= (1.0 - u) * (1.0 - v);
            if product < 1e-200 {
                sum -= log(product);
                product = 1.0;
            }
        }
        sum - log(product)
    }
}

/// A sample with the given moments.
pub fn sample(mean: f64, deviation: f64, replicates: usize) -> Sample {
    Sample {
        replicates,
        mean,
        variance: deviation * deviation,
        skewness: 0.0,
        skewness_error: None,
        fewest_contributions: 1000,
        contributions: 1000 * replicates as u64,
        invalid: Invalid::default(),
        invalid_replicate: 0,
    }
}

/// The sample of some replicates.
pub fn of_values(values: &[f64]) -> Sample {
    let (mean, variance) = moments(values);
    let third = values.iter().map(|v| (v - mean) * (v - mean) * (v - mean));
    let third = third.sum::<f64>() / values.len() as f64;
    Sample {
        variance,
        skewness: third / (variance * variance.sqrt()),
        ..sample(mean, 0.0, values.len())
    }
}

/// Normal replicates.
pub fn normal_sample(random: &mut Random, replicates: usize, mean: f64, deviation: f64) -> Sample {
    let values: Vec<_> = (0..replicates)
        .map(|_| mean + deviation * random.normal())
        .collect();
    of_values(&values)
}

/// Replicates of mean 1 that are sums of 200 to 300 exponential contributions, their number uniform.
pub fn spiky_sample(random: &mut Random, replicates: usize) -> Sample {
    let values: Vec<_> = (0..replicates)
        .map(|_| {
            let (u, _) = random.pair();
            let count = 200 + 2 * (50.0 * u) as u32;
            random.gamma(count) / 249.0
        })
        .collect();
    of_values(&values)
}
