//! The stability study: what rounding does to the closed forms on the way to every danger they have.
//!
//! A sweep walks the parameters of a kind towards a danger: a fold, grazing incidence, a focus, a rim, huge and tiny
//! scales, large offsets. At each step the numbers are rounded to a precision; the form is evaluated in that precision and
//! compared with the enclosure of the exact value for exactly these numbers. What is lost is the relative error; what may
//! be lost is the conditioning (the sum over all numbers of the relative change of the value per relative change of that
//! number, measured on the enclosures, not told by the form) times the precision's unit. The difference of their logarithms
//! is what the formula itself loses: its *excess*, in decimal digits.

pub mod bandwidth;
pub mod forms;
pub mod inputs;
pub mod plot;
pub mod quantity;
pub mod sweeps;

use nephroid_analytic::scalar::Scalar;

use inputs::Inputs;
pub use sweeps::Sweep;

/// Digits that a formula may lose beyond its conditioning; one that loses more is to be rewritten.
pub const ALLOWED_EXCESS: f64 = 4.0;

/// A precision in which forms are evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// Binary32.
    Single,
    /// Binary64.
    Double,
}

impl Precision {
    /// Both.
    pub const ALL: [Precision; 2] = [Precision::Single, Precision::Double];

    /// `f32` or `f64`.
    pub const fn name(self) -> &'static str {
        match self {
            Precision::Single => "f32",
            Precision::Double => "f64",
        }
    }

    /// Distance from 1 to the next larger number.
    pub const fn unit(self) -> f64 {
        match self {
            Precision::Single => f32::EPSILON as f64,
            Precision::Double => f64::EPSILON,
        }
    }
}

/// One evaluation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// The parameter of the sweep.
    pub t: f64,
    /// What came out.
    pub outcome: Outcome,
}

/// What an evaluation says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// A value, compared with the enclosure.
    Compared {
        /// Relative error against the middle of the enclosure.
        error: f64,
        /// Conditioning, from enclosures at changed numbers; infinite where a change of a few units meets a singularity.
        conditioning: f64,
        /// Whether the value is within its own error bound of the enclosure.
        bounded: bool,
    },
    /// The form's own bound is as large as the value: the point is on a singularity, or the light on an edge, to within this
    /// precision's rounding.
    Singular,
    /// The certificate cannot decide between two values: a shadow edge, or a fold to within rounding.
    Undecided,
    /// The numbers are outside what the form or the certificate takes.
    Outside,
}

impl Outcome {
    /// Digits lost beyond what the conditioning explains.
    pub fn excess(&self, precision: Precision) -> Option<f64> {
        match *self {
            Outcome::Compared {
                error,
                conditioning,
                ..
            } => Some(libm::log10(error / (precision.unit() * conditioning.max(1.0))).max(0.0)),
            _ => None,
        }
    }
}

/// A sweep in one precision.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The kind.
    pub kind: &'static str,
    /// The danger.
    pub danger: &'static str,
    /// What the parameter is.
    pub parameter: &'static str,
    /// The precision.
    pub precision: Precision,
    /// One step per value of the parameter.
    pub steps: Vec<Step>,
}

impl Row {
    /// The largest relative error.
    pub fn worst_error(&self) -> f64 {
        self.fold(|o| match o {
            Outcome::Compared { error, .. } => Some(error),
            _ => None,
        })
    }

    /// The largest conditioning.
    pub fn worst_conditioning(&self) -> f64 {
        self.fold(|o| match o {
            Outcome::Compared { conditioning, .. } => Some(conditioning),
            _ => None,
        })
    }

    /// The most digits lost beyond the conditioning.
    pub fn worst_excess(&self) -> f64 {
        self.fold(|o| o.excess(self.precision))
    }

    /// Number of steps that were compared.
    pub fn compared(&self) -> usize {
        let compared = |s: &&Step| matches!(s.outcome, Outcome::Compared { .. });
        self.steps.iter().filter(compared).count()
    }

    /// Number of values that are outside their own error bound.
    pub fn unbounded(&self) -> usize {
        let outside = |s: &&Step| matches!(s.outcome, Outcome::Compared { bounded: false, .. });
        self.steps.iter().filter(outside).count()
    }

    /// Whether nothing is lost that the conditioning does not explain, and every bound holds.
    pub fn is_stable(&self) -> bool {
        self.compared() > 0 && self.worst_excess() <= ALLOWED_EXCESS && self.unbounded() == 0
    }

    fn fold(&self, f: impl Fn(Outcome) -> Option<f64>) -> f64 {
        let values = self.steps.iter().filter_map(|s| f(s.outcome));
        values.fold(0.0, f64::max)
    }
}

/// Runs the sweeps of one kind, or of all.
pub fn study(kind: Option<&str>) -> Vec<Row> {
    sweeps::all()
        .iter()
        .filter(|s| kind.is_none_or(|k| k == s.kind))
        .flat_map(|sweep| {
            let precisions = sweep.quantity.precisions().iter();
            precisions.map(move |&precision| Row {
                kind: sweep.kind,
                danger: sweep.danger,
                parameter: sweep.parameter,
                precision,
                steps: sweep
                    .values
                    .iter()
                    .map(|&t| Step {
                        t,
                        outcome: match precision {
                            Precision::Single => step::<f32>(sweep, t),
                            Precision::Double => step::<f64>(sweep, t),
                        },
                    })
                    .collect(),
            })
        })
        .collect()
}

fn step<S: Scalar>(sweep: &Sweep, t: f64) -> Outcome {
    let inputs = (sweep.at)(t).rounded::<S>();
    let (Some([value, bound]), Some(truth)) = (
        sweep.quantity.estimate::<S>(sweep.kind, &inputs),
        sweep.quantity.reference(sweep.kind, &inputs),
    ) else {
        return Outcome::Outside;
    };
    if !(value.is_finite() && bound <= value.abs()) {
        return Outcome::Singular;
    }
    if !truth.is_proven() {
        return Outcome::Undecided;
    }
    let middle = truth.middle();
    if middle == 0.0 && value == 0.0 {
        return Outcome::Outside;
    }
    let unit = S::EPSILON.to_f64();
    let conditioning = conditioning::<S>(sweep, &inputs, middle);
    // At the edge of a shadow that light reaches continuously, darkness is as good as a value without a digit.
    if value == 0.0 && conditioning * unit >= 1.0 {
        return Outcome::Singular;
    }
    Outcome::Compared {
        // Zero error has no logarithm: half a unit of rounding is the least that is told.
        error: ((value - middle) / middle).abs().max(0.5 * unit),
        conditioning,
        bounded: value >= truth.low - bound && value <= truth.high + bound,
    }
}

/// Units of rounding by which numbers are changed to measure a conditioning: few enough to stay on the same side of a fold,
/// enough to rise above the width of the enclosures.
const CHANGE: f64 = 64.0;

/// Sum over all numbers of the relative change of the value per relative change of the number.
fn conditioning<S: Scalar>(sweep: &Sweep, inputs: &Inputs, value: f64) -> f64 {
    let delta = CHANGE * S::EPSILON.to_f64();
    let changes = inputs.perturbed(delta).into_iter().map(|changed| {
        // A number that counts something cannot be changed: then nothing is there to compare with.
        match sweep.quantity.reference(sweep.kind, &changed) {
            Some(truth) if truth.is_proven() => ((truth.middle() - value) / value).abs() / delta,
            Some(_) => f64::INFINITY,
            None => 0.0,
        }
    });
    changes.fold(0.0, |sum, c| sum + c)
}
