//! What a caustic's singular set looks like, and how far a receiver point is from it.

/// The type of a singularity of the irradiance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SingularityKind {
    /// Two roots meet: E ~ d^(-1/2) on one side.
    Fold,
    /// Three roots meet: E ~ d^(-2/3) across, d^(-1) along.
    Cusp,
    /// A ring of rays meets the axis of a surface of revolution: E ~ 1/d.
    LineFocus,
    /// All rays meet: a stigmatic, degenerate configuration.
    PointFocus,
}

impl SingularityKind {
    /// The word for it: `fold`, `cusp`, `line_focus`, `point_focus`.
    pub const fn name(self) -> &'static str {
        match self {
            SingularityKind::Fold => "fold",
            SingularityKind::Cusp => "cusp",
            SingularityKind::LineFocus => "line_focus",
            SingularityKind::PointFocus => "point_focus",
        }
    }
}

/// The nearest singularity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Singularity<S> {
    /// Its type.
    pub kind: SingularityKind,
    /// Distance to it [m].
    pub distance: S,
}

impl<S: PartialOrd + Copy> Singularity<S> {
    /// The nearer of two.
    pub fn nearer(first: Option<Self>, second: Option<Self>) -> Option<Self> {
        match (first, second) {
            (Some(a), Some(b)) if b.distance < a.distance => Some(b),
            (None, b) => b,
            (a, _) => a,
        }
    }
}
