//! Coordinates (a, b) ∈ [-1, 1]² of a piece of a bundle's parameters: boxes, with an end moved to a curve.

use crate::flux::poly::{N, value};

/// One change of coordinates.
#[derive(Clone, Copy, Debug)]
enum Step {
    /// The box with this centre and these half widths.
    Box { center: [f64; 2], half: [f64; 2] },
    /// Along `axis` only what is on one side of a curve over the other axis: above it, or below.
    Cut {
        axis: usize,
        above: bool,
        curve: [f64; N],
    },
}

/// A piece of the parameters.
#[derive(Clone, Debug)]
pub struct Chart {
    steps: Vec<Step>,
}

impl Chart {
    /// A rectangle of parameters.
    pub fn new(domain: [[f64; 2]; 2]) -> Self {
        Chart { steps: Vec::new() }.part(domain)
    }

    /// The part of this piece in a rectangle of its coordinates.
    pub fn part(&self, range: [[f64; 2]; 2]) -> Self {
        let mut steps = self.steps.clone();
        let mut center = range.map(|[low, high]| 0.5 * (low + high));
        let mut half = range.map(|[low, high]| 0.5 * (high - low));
        if let Some(Step::Box { center: c, half: h }) = steps.last().copied() {
            steps.pop();
            center = [c[0] + h[0] * center[0], c[1] + h[1] * center[1]];
            half = [h[0] * half[0], h[1] * half[1]];
        }
        steps.push(Step::Box { center, half });
        Chart { steps }
    }

    /// The part above or below a curve along an axis.
    pub fn cut(&self, axis: usize, above: bool, curve: [f64; N]) -> Self {
        let mut steps = self.steps.clone();
        steps.push(Step::Cut { axis, above, curve });
        Chart { steps }
    }

    /// The halves along an axis.
    pub fn halves(&self, axis: usize) -> [Self; 2] {
        [[-1.0, 0.0], [0.0, 1.0]].map(|half| {
            let mut range = [[-1.0, 1.0]; 2];
            range[axis] = half;
            self.part(range)
        })
    }

    /// Parameters at a point, and the area of parameters per area of the coordinates.
    #[inline]
    pub fn at(&self, p: [f64; 2]) -> ([f64; 2], f64) {
        let (mut p, mut area) = (p, 1.0);
        for step in self.steps.iter().rev() {
            match step {
                Step::Box { center, half } => {
                    p = [center[0] + half[0] * p[0], center[1] + half[1] * p[1]];
                    area *= half[0] * half[1];
                }
                Step::Cut { axis, above, curve } => {
                    let edge = value(curve, p[1 - axis]);
                    let (low, high) = if *above { (edge, 1.0) } else { (-1.0, edge) };
                    let half = 0.5 * (high - low);
                    p[*axis] = low + half * (1.0 + p[*axis]);
                    area *= half;
                }
            }
        }
        (p, area)
    }
}
