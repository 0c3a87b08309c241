//! Multiple importance sampling [Veach & Guibas 1995]: techniques that build the same path share it.
//!
//! A path built by technique k, which has the density p_k, is weighted by w_k = p_kᵝ/Σ p_jᵝ (β = 1: balance heuristic; β = 2:
//! power heuristic). All p are densities of the same path in the same measure, so that the weights of one path sum to 1
//! whichever technique has built it.

use core::fmt;
use core::str::FromStr;

use super::fault::Fault;

/// How densities become weights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Heuristic {
    /// Proportional to the density.
    #[default]
    Balance,
    /// Proportional to its square.
    Power,
}

impl Heuristic {
    /// 1/(1 + rᵝ) of the ratio r of the other technique's density to the own.
    #[inline(always)]
    pub fn share(self, ratio: f64) -> f64 {
        let odds = match self {
            Heuristic::Balance => ratio,
            Heuristic::Power => ratio * ratio,
        };
        1.0 / (1.0 + odds)
    }

    /// The weight of technique `own`, among densities of which that one is not zero.
    pub fn weight(self, own: usize, densities: &[f64]) -> f64 {
        let odds = |&p: &f64| {
            let ratio = p / densities[own];
            match self {
                Heuristic::Balance => ratio,
                Heuristic::Power => ratio * ratio,
            }
        };
        1.0 / densities.iter().map(odds).sum::<f64>()
    }
}

impl fmt::Display for Heuristic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Heuristic::Balance => "balance",
            Heuristic::Power => "power",
        })
    }
}

impl FromStr for Heuristic {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "balance" => Ok(Heuristic::Balance),
            "power" => Ok(Heuristic::Power),
            _ => Err("expected balance or power".to_owned()),
        }
    }
}

/// The side on which a mollified vertex is connected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Met by the camera subpath, connected to the light.
    Camera,
    /// Met by the light subpath, connected to the camera subpath.
    Light,
}

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Side::Camera => "camera",
            Side::Light => "light",
        })
    }
}

impl FromStr for Side {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "camera" => Ok(Side::Camera),
            "light" => Ok(Side::Light),
            _ => Err("expected camera or light".to_owned()),
        }
    }
}

/// How two techniques, one from each side, share a path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sharing {
    pub(super) heuristic: Heuristic,
    pub(super) fault: Option<Fault>,
}

impl Sharing {
    /// The weight of a side's technique, from its density and the other's.
    #[inline(always)]
    pub(super) fn weight(&self, side: Side, own: f64, other: f64) -> f64 {
        let heuristic = match (self.fault, side) {
            (Some(Fault::HeuristicsMixed), Side::Light) => Heuristic::Power,
            _ => self.heuristic,
        };
        heuristic.share(other / own)
    }

    /// The weight where next event estimation is the only technique.
    #[inline(always)]
    pub(super) fn alone(&self, own: f64, other: f64) -> f64 {
        match self.fault {
            Some(Fault::DeltaVertexWeighted) => self.heuristic.share(other / own),
            _ => 1.0,
        }
    }

    /// The number of pixels by which the camera's density is divided in the weights of the light's side.
    pub(super) fn pixels_from_light(&self, pixels: f64) -> f64 {
        match self.fault {
            Some(Fault::MisPixelsForgotten) => 1.0,
            _ => pixels,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_are_shares_of_powers_of_the_densities_and_sum_to_one() {
        let densities = [0.3, 0.0, 1.2e-30, 7.5, 0.2];
        for (heuristic, power) in [(Heuristic::Balance, 1), (Heuristic::Power, 2)] {
            let raised = densities.map(|p: f64| (0..power).fold(1.0, |product, _| product * p));
            let sum: f64 = raised.iter().sum();
            let mut total = 0.0;
            for (k, p) in raised.iter().enumerate().filter(|(_, p)| **p > 0.0) {
                let weight = heuristic.weight(k, &densities);
                assert!((weight / (p / sum) - 1.0).abs() < 1e-14);
                total += weight;
            }
            assert!((total - 1.0).abs() < 1e-14);
            let pair = [2.0, 5.0];
            assert!((heuristic.share(2.5) - heuristic.weight(0, &pair)).abs() < 1e-15);
            assert_eq!(
                (heuristic.share(0.0), heuristic.share(f64::INFINITY)),
                (1.0, 0.0)
            );
        }
    }
}
