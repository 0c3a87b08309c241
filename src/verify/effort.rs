//! How much a suite does: margin, coverage and the most paths it spends.

use core::fmt;
use core::str::FromStr;

/// The angle α [rad] and radius r [m] at which regularizing methods run unless told otherwise.
pub const BANDWIDTH: f64 = 0.2;

/// How much a suite does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Effort {
    /// Margin 2 %, a covering subset of the pairs of scene and integrator.
    #[default]
    Quick,
    /// Margin 1 %, every pair whose truth and paths do not take minutes.
    Standard,
    /// Margin 0.5 %, every pair.
    Thorough,
}

impl Effort {
    /// All of them, with their names.
    pub const NAMES: [(&'static str, Effort); 3] = [
        ("quick", Effort::Quick),
        ("standard", Effort::Standard),
        ("thorough", Effort::Thorough),
    ];

    /// The equivalence margin, relative to the truth.
    pub const fn margin(self) -> f64 {
        match self {
            Effort::Quick => 0.02,
            Effort::Standard => 0.01,
            Effort::Thorough => 0.005,
        }
    }

    /// The most paths that the final test of one pair of scene and integrator draws: several times what the dearest check of
    /// the catalogue needs (which falls with the square of the margin), and minutes of two cores at standard. A check that
    /// needs more ends undecided and says how many.
    pub const fn most_paths(self) -> u64 {
        match self {
            Effort::Quick => 1_000_000_000,
            Effort::Standard => 4_000_000_000,
            Effort::Thorough => 1_000_000_000_000,
        }
    }
}

impl fmt::Display for Effort {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = Effort::NAMES.iter().find(|(_, e)| e == self);
        f.pad(name.map_or("", |(n, _)| n))
    }
}

impl FromStr for Effort {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Effort::NAMES
            .iter()
            .find(|(n, _)| *n == text)
            .map(|&(_, e)| e)
            .ok_or_else(|| "expected quick, standard or thorough".to_owned())
    }
}
