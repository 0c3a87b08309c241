//! The radius of a pixel from the photons that it has met: a plug-in of estimated bias and variance.
//!
//! The mean of merging n photons has, at radius r, the bias C_B r² with C_B = β ΔE (β of the kernel, Δ the Laplacian
//! on the floor) and the variance C_V/(n r²) with C_V = ρ Φ² e₂ (ρ the kernel's roughness, e₂ the density of photons on the floor, each times the square of
//! its weight). A running mean over passes with
//! r_k ~ k^(-1/6) has the least error if, with n photons up to and with pass k,
//!
//! ```text
//! r_k⁶ = C_V / (6 C_B² n)
//! ```
//!
//! [Kaplanyan & Dachsbacher 2013, adaptive progressive photon mapping, for the plug-in; the 6 is derived here: bias 3/2 C_B r₁² k^(-1/3), variance
//! 3/4 C_V/(S r₁²) k^(-2/3) after k passes of S photons, minimised over r₁]. e₂ and ΔE are estimated with a radius R > r,
//!
//! ```text
//! e₂ ≈ 1/S Σ w² 2/(πR²) (1 - s)             ΔE ≈ Φ/S Σ w 48/(πR⁴) (1 - s)(3s - 1)        s = d²/R²
//! ```
//!
//! the second being the Laplacian of the kernel 4/(πR²) (1 - s)³ [derived here]. R shrinks like n^(-1/10), the rate for second derivatives. The
//! estimate of (ΔE)² is the square of the mean plus the mean's own variance, so that noise makes a radius smaller, not larger: a radius off by
//! a fifth costs a tenth of the error, but one for a Laplacian of zero has no limit. It is never more than R. There is no smallest radius.

use core::f64::consts::PI;

use libm::pow;

use super::kernel::Kernel;
use super::photon_grid::PhotonGrid;

/// What a pixel has seen of one class.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Seen {
    /// Maps, and photons in them.
    maps: f64,
    photons: f64,
    /// Sums over maps of the estimates of e₂, ΔE/Φ and the square of the latter.
    density: f64,
    laplacian: f64,
    square: f64,
}

/// Estimates from one map: of e₂ and ΔE/Φ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Estimates {
    density: f64,
    laplacian: f64,
}

impl Estimates {
    /// At a point, from a map of so many photons within the radius R.
    pub(super) fn at(grid: &PhotonGrid, [x, y]: [f64; 2], wide: f64, photons: f64) -> Self {
        let inverse = 1.0 / (wide * wide);
        let parabola = |d2: f64, weight: f64| weight * weight * (1.0 - d2 * inverse);
        let laplacian = |d2: f64, weight: f64| {
            let s = d2 * inverse;
            weight * ((1.0 - s) * (3.0 * s - 1.0))
        };
        let e = grid.sum(x, y, wide, [1, 1], parabola);
        let l = grid.sum(x, y, wide, [1, 1], laplacian);
        Estimates {
            density: 2.0 / PI * inverse * e / photons,
            laplacian: 48.0 / PI * inverse * inverse * l / photons,
        }
    }
}

impl Seen {
    /// Learns from a map of so many photons.
    pub(super) fn learn(&mut self, e: Estimates, photons: f64) {
        self.maps += 1.0;
        self.photons += photons;
        self.density += e.density;
        self.laplacian += e.laplacian;
        self.square += e.laplacian * e.laplacian;
    }

    /// R for the next map, from the user's bandwidth, its value in the first.
    pub(super) fn wide(&self, first: f64) -> f64 {
        first * pow(1.0 + self.maps, -0.1)
    }

    /// r for the next map, of `photons` photons. The first two maps have R.
    pub(super) fn radius(&self, first: f64, kernel: Kernel, photons: f64) -> f64 {
        let wide = self.wide(first);
        if self.maps < 2.0 {
            return wide;
        }
        let m = self.maps;
        let (e, l) = (self.density / m, self.laplacian / m);
        let variance = (self.square / m - l * l) / (m - 1.0);
        let variance = if variance > 0.0 { variance } else { 0.0 };
        let beta = kernel.bias_coefficient();
        // Φ² is in both C_V and C_B².
        let ratio = kernel.roughness() * e / (6.0 * beta * beta * (l * l + variance));
        let n = self.photons + photons;
        let r = pow(ratio / n, 1.0 / 6.0);
        // Nothing seen at all is 0/0, and R.
        if r < wide { r } else { wide }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrators::photon_grid::Photons;

    /// Photons on a fine lattice, of the weight 1 + x²: e₂ is its square's mean, ΔE/Φ is 2.
    #[test]
    fn irradiance_and_laplacian_of_a_parabola() {
        let mut photons = Photons::default();
        let (n, wide) = (800, 0.5);
        for i in 0..n {
            for j in 0..n {
                let at = |k: i32| (f64::from(k) + 0.5) / f64::from(n) * 2.0 - 1.0;
                photons.push(at(i), at(j), 1.0 + at(i) * at(i));
            }
        }
        let mut grid = PhotonGrid::default();
        grid.build(&photons, wide);
        // As many photons per square metre as there are in all, so that a flux of 1 has the density 1.
        let per_area = f64::from(n * n) / 4.0;
        let e = Estimates::at(&grid, [0.1, -0.2], wide, per_area);
        // (1 + x²)² = 1 + 2x² + x⁴ at x = 0.1 + δ, <δ²> = R²/6, <δ⁴> = 3/4 · R⁴/12 of the parabola; a Laplacian without fourth
        // derivatives has no bias.
        let (two, four) = (wide * wide / 6.0, wide * wide * wide * wide / 16.0);
        let expected = 1.01 * 1.01 + (2.0 + 6.0 * 0.01) * two + four;
        assert!((e.density - expected).abs() < 1e-3, "{e:?} {expected}");
        assert!((e.laplacian - 2.0).abs() < 1e-2, "{e:?}");
    }

    #[test]
    fn the_radius_is_the_formula_and_noise_makes_it_smaller() {
        let e = |laplacian| Estimates {
            density: 0.03,
            laplacian,
        };
        let (mut calm, mut noisy) = (Seen::default(), Seen::default());
        assert_eq!(calm.radius(0.5, Kernel::Disc, 1e4), 0.5);
        for k in 0..1000 {
            calm.learn(e(-2.0), 1e4);
            noisy.learn(e(if k % 2 == 0 { 118.0 } else { -122.0 }), 1e4);
        }
        let r = calm.radius(0.5, Kernel::Disc, 1e4);
        let six = 0.03 / PI / (6.0 / 64.0 * 4.0 * 1.001e7);
        assert!((pow(r, 6.0) / six - 1.0).abs() < 1e-9);
        let less = noisy.radius(0.5, Kernel::Disc, 1e4);
        assert!(less < r && less > 0.6 * r);
    }

    #[test]
    fn where_there_is_no_light_the_radius_is_the_wide_one() {
        let mut dark = Seen::default();
        for _ in 0..10 {
            let none = Estimates {
                density: 0.0,
                laplacian: 0.0,
            };
            dark.learn(none, 100.0);
        }
        assert_eq!(dark.radius(0.3, Kernel::Disc, 100.0), dark.wide(0.3));
    }
}
