//! What a run of a probe leaves: the first two moments of its samples, as sums.

/// Sums over the samples of one class.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sums {
    /// Of the samples [W/m²].
    pub sum: f64,
    /// Of their squares [W²/m⁴].
    pub sum_of_squares: f64,
    /// Samples that are not zero.
    pub nonzero: u64,
    /// Paths, which are samples, those that are zero included.
    pub paths: u64,
}

impl Sums {
    /// Adds another run. The order of additions decides the last bits: keep it fixed.
    pub fn add(&mut self, other: &Sums) {
        self.sum += other.sum;
        self.sum_of_squares += other.sum_of_squares;
        self.nonzero += other.nonzero;
        self.paths += other.paths;
    }

    /// Estimate of the irradiance [W/m²]; NaN without a path.
    pub fn mean(&self) -> f64 {
        self.sum / self.paths as f64
    }

    /// Estimate of the second moment of a sample [W²/m⁴]; NaN without a path.
    pub fn second_moment(&self) -> f64 {
        self.sum_of_squares / self.paths as f64
    }

    /// Standard error of the mean [W/m²].
    pub fn standard_error(&self) -> f64 {
        let (n, mean) = (self.paths as f64, self.mean());
        f64::sqrt((self.second_moment() - mean * mean).max(0.0) / (n - 1.0))
    }
}
