//! What a suite answers: verdicts with everything that is needed to judge and to reproduce them.

use nephroid_analytic::camera::Bounded;

use super::effort::Effort;
use super::excluded::Excluded;
use crate::judge::finding::{Finding, exit_code};
use crate::judge::heavy::TailIndex;
use crate::judge::hypotheses::Levels;

/// The word for the sum of all classes that an integrator claims.
pub const ALL_CLASSES: &str = "all";
/// The word for the region that is the whole image.
pub const WHOLE_IMAGE: &str = "image";
/// The word for the region that is a user's mask.
pub const MASK: &str = "mask";

/// One check and what came of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// The scene's name.
    pub scene: String,
    /// How the scene was changed; `None` if it was not.
    pub variation: Option<String>,
    /// The integrator's name.
    pub integrator: String,
    /// The path class, or `all` for the sum of those claimed.
    pub class: String,
    /// The part of the image.
    pub region: String,
    /// State, effect, interval, p-values, power.
    pub finding: Finding,
    /// What the mean should be [W m⁻² sr⁻¹].
    pub truth: Option<Bounded>,
    /// What it is.
    pub mean: Option<f64>,
    /// Equivalence margin relative to the truth.
    pub margin: f64,
    /// Error probabilities of this check.
    pub levels: Levels,
    /// Angle [rad] or radius [m] of the mollifier (of the first iteration); `None` for what is not regularized.
    pub bandwidth: Option<f64>,
    /// Pixels that a fold crosses, where they are left out.
    pub excluded: Option<Excluded>,
    /// Tail index of the replicates' largest pixels, where there are enough.
    pub tail: Option<TailIndex>,
    /// What a difference looks like, where it looks like something.
    pub looks_like: Option<String>,
    /// Independent repetitions.
    pub replicates: u32,
    /// How often the growing sample was judged.
    pub looks: u32,
    /// Paths in the final test.
    pub paths: u64,
    /// Paths that would decide, where these did not.
    pub paths_needed: Option<u64>,
    /// The user's seed.
    pub seed: u64,
    /// Wall-clock time of the run that served all checks of this scene and integrator, truth and pilots included.
    pub seconds: f64,
    /// The command that gives the same verdict again.
    pub command: String,
}

/// A pair of scene and integrator that was left out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NotRun {
    /// The scene's name.
    pub scene: String,
    /// The integrator's name.
    pub integrator: String,
    /// Why.
    pub reason: String,
}

/// The command that answers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Program {
    /// `nephroid verify`.
    #[default]
    Verify,
    /// `nephroid gate`.
    Gate,
}

impl Program {
    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Program::Verify => "verify",
            Program::Gate => "gate",
        }
    }
}

/// The answer of a suite.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// The command that answers.
    pub program: Program,
    /// The verdicts, in the order of scenes, integrators and classes.
    pub verdicts: Vec<Verdict>,
    /// What was left out.
    pub not_run: Vec<NotRun>,
    /// What else a person should know: how images were read, how they are calibrated.
    pub notes: Vec<String>,
    /// The effort asked for; `None` where images are what there is.
    pub effort: Option<Effort>,
    /// Probability of any false "different" in the suite.
    pub level: f64,
    /// Probability of any false "equivalent" in the suite.
    pub equivalence_level: f64,
    /// Checks among which these are shared.
    pub checks: u64,
    /// Equivalence margin relative to the truth.
    pub margin: f64,
    /// Angle [rad] or radius [m] of the mollifiers; `None` if nothing is regularized.
    pub bandwidth: Option<f64>,
    /// The user's seed.
    pub seed: u64,
    /// Wall-clock time.
    pub seconds: f64,
}

impl Outcome {
    /// See [`crate::exit`].
    pub fn exit_code(&self) -> u8 {
        exit_code(self.verdicts.iter().map(|v| v.finding.state))
    }
}
