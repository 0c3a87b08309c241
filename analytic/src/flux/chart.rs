//! Coordinates (a, b) ∈ [-1, 1]² of a piece of a bundle's parameters: boxes, with an end moved to a curve.

use crate::flux::poly::{N, value};

/// One change of coordinates.
#[derive(Clone, Copy, Debug)]
enum Step {
    /// The box with this centre and these half widths.
    Box { center: [f64; 2], half: [f64; 2] },
    /// Along an axis only what is on one side of a curve over the other axis.
    Cut { edge: Edge, curve: [f64; N] },
    /// The distance from an end is squared.
    Square { edge: Edge },
}

/// The end of a piece that lies on a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    /// Coordinate.
    pub axis: usize,
    /// The piece is above the curve, which so is at -1; or below it.
    pub above: bool,
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

    /// The part on one side of a curve.
    pub fn cut(&self, edge: Edge, curve: [f64; N]) -> Self {
        self.then(Step::Cut { edge, curve })
    }

    /// The same piece in coordinates in which a square root of the distance from an end is smooth.
    pub fn squared(&self, edge: Edge) -> Self {
        self.then(Step::Square { edge })
    }

    fn then(&self, step: Step) -> Self {
        let mut steps = self.steps.clone();
        steps.push(step);
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
                Step::Cut { edge, curve } => {
                    let at = value(curve, p[1 - edge.axis]);
                    let (low, high) = if edge.above { (at, 1.0) } else { (-1.0, at) };
                    let half = 0.5 * (high - low);
                    p[edge.axis] = low + half * (1.0 + p[edge.axis]);
                    area *= half;
                }
                Step::Square { edge } => {
                    let sign = if edge.above { 1.0 } else { -1.0 };
                    let distance = 1.0 + sign * p[edge.axis];
                    p[edge.axis] = sign * (0.5 * distance * distance - 1.0);
                    area *= distance;
                }
            }
        }
        (p, area)
    }
}
