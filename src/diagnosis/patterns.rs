//! Patterns of a residual: what the measured image should be if a wrong factor, a wrong place or a wrong edge were all that is
//! wrong with it.
//!
//! Each hypothesis predicts the measured image M from the true one T. Its misfit is χ² = Σ (M - P)²/v with v about the
//! variance of M; that of noise alone is known from the replicates, N. A hypothesis explains 1 - (χ² - N)/(χ²₀ - N) of the
//! residual, where χ²₀ is the misfit of P = T.

use libm::pow;

use super::covariates::Covariate;

/// A measured image, what it should be, and how much it scatters.
#[derive(Clone, Debug)]
pub struct Residual<'a> {
    /// Columns.
    pub width: usize,
    /// Measured mean [W m⁻² sr⁻¹].
    pub measured: &'a [f64],
    /// Truth.
    pub truth: &'a [f64],
    /// Weight of each pixel: 1/v.
    weights: Vec<f64>,
    /// N.
    noise: f64,
    /// χ²₀.
    misfit: f64,
}

/// A pattern that fits.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// What it is.
    pub pattern: Pattern,
    /// The part of the residual that it explains.
    pub explained: f64,
}

/// What may be wrong with an image.
#[derive(Clone, Debug, PartialEq)]
pub enum Pattern {
    /// A constant factor.
    Constant,
    /// A factor times a power of a covariate, by its name; the factor and its standard error.
    Power(&'static str, i32, [f64; 2]),
    /// Moved by columns to the right and rows downwards.
    Shift(f64, f64),
    /// Turned over: left and right, top and bottom.
    Flip(bool, bool),
    /// Pixels at the frame only; the factor there.
    Frame(f64),
    /// Light where the truth has none.
    Dark,
    /// The brightest pixels only; the factor there.
    Bright(f64),
    /// Edges of the picture only.
    Edges,
}

/// Least part of a residual that a pattern with a number or two must explain.
const EXPLAINED: f64 = 0.9;
/// The same for a move: within a pixel the truth is not known, and steep edges keep a part.
const EXPLAINED_BY_SHIFT: f64 = 0.5;
/// The same for a pattern that says where and not what.
const EXPLAINED_BY_PLACE: f64 = 0.8;
/// What a richer pattern must gain over a constant factor, in units of a pixel's noise.
const GAIN: f64 = 30.0;
/// Standard deviations of χ² above noise from which there is something to explain.
const ESTABLISHED: f64 = 8.0;
/// Least relative spread of what a factor may be proportional to.
const LEAST_SPREAD: f64 = 0.01;
/// Truth below this part of the mean is none.
const NONE: f64 = 1e-3;

/// Whether a factor is 1, as well as the fit knows it.
pub fn is_one([factor, error]: [f64; 2]) -> bool {
    (factor - 1.0).abs() <= f64::max(4.0 * error, 0.01)
}

fn is_bare(pattern: &Pattern) -> bool {
    matches!(pattern, Pattern::Power(_, _, factor) if is_one(*factor))
}

impl<'a> Residual<'a> {
    /// `variance` is that of each pixel's measured mean. `None` if the images are empty or there is nothing but noise.
    pub fn new(
        width: usize,
        measured: &'a [f64],
        truth: &'a [f64],
        variance: &[f64],
    ) -> Option<Self> {
        let total: f64 = truth.iter().sum();
        let seen: f64 = measured.iter().sum();
        let mean = f64::max(total, seen) / truth.len() as f64;
        // Counts of equal contributions: a variance proportional to the radiance, and a little where there is none.
        let proportion = variance.iter().sum::<f64>() / f64::max(0.5 * (total + seen), 1e-300);
        let weights: Vec<f64> = measured
            .iter()
            .zip(truth)
            .map(|(&m, &t)| 1.0 / (proportion * (0.5 * (m + t) + NONE * mean)))
            .collect();
        let noise: f64 = variance.iter().zip(&weights).map(|(v, w)| v * w).sum();
        let mut residual = Residual {
            width,
            measured,
            truth,
            weights,
            noise,
            misfit: 0.0,
        };
        residual.misfit = residual.of(|i| truth[i]);
        // χ² of n pixels scatters by √(2n).
        let pixels = truth.len() as f64;
        let spread = ESTABLISHED * libm::sqrt(2.0 * pixels) * noise / pixels;
        (residual.misfit - noise > spread).then_some(residual)
    }

    fn height(&self) -> usize {
        self.truth.len() / self.width
    }

    /// χ² of a pixel of which nothing is said.
    pub(crate) fn noise_of_pixel(&self) -> f64 {
        self.noise / self.truth.len() as f64
    }

    /// By how much a richer pattern must fit better, beyond noise.
    pub(crate) fn least_gain(&self) -> f64 {
        GAIN * self.noise_of_pixel()
    }

    /// χ² of a prediction.
    pub(crate) fn of(&self, predicted: impl Fn(usize) -> f64) -> f64 {
        let term = |i: usize| {
            let off = self.measured[i] - predicted(i);
            self.weights[i] * off * off
        };
        (0..self.truth.len()).map(term).sum()
    }

    pub(crate) fn explained(&self, misfit: f64) -> f64 {
        1.0 - (misfit - self.noise).max(0.0) / (self.misfit - self.noise)
    }

    /// The factor that fits a shape best over some pixels, and its standard error.
    pub(crate) fn factor(&self, shape: &[f64], of: impl Fn(usize) -> bool) -> [f64; 2] {
        let (mut product, mut square) = (0.0, 0.0);
        for (i, &s) in shape.iter().enumerate() {
            if of(i) {
                product += self.weights[i] * s * self.measured[i];
                square += self.weights[i] * s * s;
            }
        }
        let per_pixel = self.noise / self.truth.len() as f64;
        [product / square, libm::sqrt(per_pixel / square)]
    }

    /// The pattern that fits best, if one does. A power counts only if the factor beside it has a name, by `is_named`, or
    /// is 1.
    pub fn best(
        &self,
        covariates: &[Covariate],
        is_named: impl Fn([f64; 2]) -> bool,
    ) -> Option<Fit> {
        let [factor, _] = self.factor(self.truth, |_| true);
        let constant = self.of(|i| factor * self.truth[i]);
        let gain = self.least_gain();
        // Simplest first: what follows must be better by what noise does not give.
        let mut best = (constant, Pattern::Constant);
        let mut consider = |(misfit, pattern): (f64, Pattern)| {
            if misfit < best.0 - gain {
                best = (misfit, pattern);
            }
        };
        let (bare, scaled): (Vec<_>, Vec<_>) = self
            .powers(covariates)
            .into_iter()
            .partition(|(_, p)| is_bare(p));
        bare.into_iter().for_each(&mut consider);
        self.moved().into_iter().for_each(&mut consider);
        let has_name = |p: &Pattern| matches!(p, Pattern::Power(_, _, factor) if is_named(*factor));
        scaled
            .into_iter()
            .filter(|(_, p)| has_name(p))
            .for_each(&mut consider);
        let (misfit, pattern) = best;
        let explained = self.explained(misfit);
        let least = match pattern {
            Pattern::Shift(..) => EXPLAINED_BY_SHIFT,
            _ => EXPLAINED,
        };
        let place = self.places();
        // A column that is lost looks like an image moved by one.
        let lost = |p: &Fit| matches!(p.pattern, Pattern::Frame(_)) && p.explained > explained;
        if matches!(pattern, Pattern::Shift(..)) && place.as_ref().is_some_and(lost) {
            return place;
        }
        if explained >= least {
            return Some(Fit { pattern, explained });
        }
        place
    }

    /// Factors that are powers of something.
    fn powers(&self, covariates: &[Covariate]) -> Vec<(f64, Pattern)> {
        let mut found = Vec::new();
        for Covariate { name, values } in covariates {
            let [known, mean, square] =
                values
                    .iter()
                    .zip(self.truth)
                    .fold([0.0; 3], |[n, m, s], (&c, &t)| {
                        if c.is_nan() {
                            [n, m, s]
                        } else {
                            [n + t, m + t * c, s + t * c * c]
                        }
                    });
            let (mean, square) = (mean / known, square / known);
            // Where it is not known there must be little light; and where it is, it must vary.
            let varies = square - mean * mean > LEAST_SPREAD * LEAST_SPREAD * mean * mean;
            if !(varies && known > 0.98 * self.truth.iter().sum::<f64>()) {
                continue;
            }
            for power in [1, -1, 2, -2] {
                let shape: Vec<f64> = values
                    .iter()
                    .zip(self.truth)
                    .map(|(&c, &t)| t * pow(if c.is_nan() { mean } else { c }, f64::from(power)))
                    .collect();
                let factor = self.factor(&shape, |_| true);
                let misfit = self.of(|i| factor[0] * shape[i]);
                found.push((misfit, Pattern::Power(name, power, factor)));
            }
        }
        found
    }

    /// The image elsewhere or turned over.
    fn moved(&self) -> Vec<(f64, Pattern)> {
        const STEPS: [f64; 5] = [-1.0, -0.5, 0.0, 0.5, 1.0];
        let (width, height) = (self.width, self.height());
        let at = |x: f64, y: f64| {
            let whole = (x >= 0.0) & (y >= 0.0) & (x < width as f64) & (y < height as f64);
            if whole {
                self.truth[y as usize * width + x as usize]
            } else {
                0.0
            }
        };
        let mut found = Vec::new();
        for dx in STEPS {
            for dy in STEPS {
                if (dx, dy) == (0.0, 0.0) {
                    continue;
                }
                // Mean over the pixel of an image that is constant in each pixel.
                let shifted = |i: usize| {
                    let (x, y) = ((i % width) as f64 - dx, (i / width) as f64 - dy);
                    let (low_x, low_y) = (f64::floor(x), f64::floor(y));
                    let (fx, fy) = (x - low_x, y - low_y);
                    let row = |y: f64| (1.0 - fx) * at(low_x, y) + fx * at(low_x + 1.0, y);
                    (1.0 - fy) * row(low_y) + fy * row(low_y + 1.0)
                };
                found.push((self.of(shifted), Pattern::Shift(dx, dy)));
            }
        }
        for (across, down) in [(true, false), (false, true), (true, true)] {
            let turned = |i: usize| {
                let (x, y) = (i % width, i / width);
                let x = if across { width - 1 - x } else { x };
                let y = if down { height - 1 - y } else { y };
                self.truth[y * width + x]
            };
            found.push((self.of(turned), Pattern::Flip(across, down)));
        }
        found
    }

    /// Where the residual is, if it is all in a small part of the image.
    fn places(&self) -> Option<Fit> {
        let (width, height) = (self.width, self.height());
        let mean = self.truth.iter().sum::<f64>() / self.truth.len() as f64;
        let mut sorted = self.truth.to_vec();
        sorted.sort_by(f64::total_cmp);
        let bright = sorted[sorted.len() * 9 / 10];
        let frame = |i: usize| {
            let (x, y) = (i % width, i / width);
            x == 0 || y == 0 || x == width - 1 || y == height - 1
        };
        let dark = |i: usize| self.truth[i] < NONE * mean;
        let edge = |i: usize| {
            let next = |j: usize| (self.truth[i] - self.truth[j]).abs() > 0.3 * mean;
            let (x, y) = (i % width, i / width);
            (x > 0 && next(i - 1))
                || (x + 1 < width && next(i + 1))
                || (y > 0 && next(i - width))
                || (y + 1 < height && next(i + width))
        };
        let frame_factor = self.factor(self.truth, frame)[0];
        let bright_factor = self.factor(self.truth, |i| self.truth[i] > bright)[0];
        let bright = |i: usize| self.truth[i] > bright;
        let places: [(Pattern, &dyn Fn(usize) -> bool); 4] = [
            (Pattern::Frame(frame_factor), &frame),
            (Pattern::Dark, &dark),
            (Pattern::Bright(bright_factor), &bright),
            (Pattern::Edges, &edge),
        ];
        for (pattern, is_there) in places {
            let there = (0..self.truth.len()).filter(|&i| is_there(i)).count();
            // The dark part of an image may be most of it: that there is light is what is wrong.
            if there == 0 || (pattern != Pattern::Dark && 3 * there > self.truth.len()) {
                continue;
            }
            // Fitted away, noise and all; or, for the brightest pixels, with their one factor.
            let (misfit, fitted) = match pattern {
                Pattern::Bright(factor) => {
                    let scaled = |i: usize| if is_there(i) { factor } else { 1.0 };
                    (self.of(|i| scaled(i) * self.truth[i]), factor)
                }
                Pattern::Frame(factor) => (self.elsewhere(is_there), factor),
                _ => (self.elsewhere(is_there), 0.0),
            };
            if (fitted - 1.0).abs() < 0.05 {
                continue;
            }
            let explained = self.explained(misfit);
            if explained >= EXPLAINED_BY_PLACE {
                return Some(Fit { pattern, explained });
            }
        }
        None
    }

    /// χ² if a place is as it was measured and the rest as it should be, with the noise of the place.
    fn elsewhere(&self, is_there: &dyn Fn(usize) -> bool) -> f64 {
        let there = (0..self.truth.len()).filter(|&i| is_there(i)).count();
        let noise = self.noise * there as f64 / self.truth.len() as f64;
        noise
            + self.of(|i| {
                if is_there(i) {
                    self.measured[i]
                } else {
                    self.truth[i]
                }
            })
    }
}
