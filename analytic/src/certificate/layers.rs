//! A ray through two parallel layers, a proven solution of Snell's law. Theory blocks C and D.
//!
//! In t, the tangent of the ray's angle in the rarer medium (index n_r, thickness l_r; n_d, l_d the other's), the ray of
//! the layers spans the plan distance l_r t + l_d n_r t/√(n_d² + (n_d² - n_r²) t²), which increases strictly and without
//! bound: exactly one t belongs to every plan distance, and lies between 0 and it over l_r.

use crate::certificate::roots::{Jet, isolate};
use crate::enclosure::Enclosure;
use crate::scalar::Scalar;

/// A layer of a medium.
#[derive(Clone, Copy, Debug)]
pub struct Layer {
    /// Thickness [m].
    pub thickness: Enclosure,
    /// Index.
    pub index: Enclosure,
}

/// A ray through two layers: p = n_j sin θ_j and q_j = n_j cos θ_j.
#[derive(Clone, Copy, Debug)]
pub struct LayeredRay {
    /// Ray parameter.
    pub p: Enclosure,
    /// Normal component in either layer, in the order in which they were given.
    pub q: [Enclosure; 2],
}

impl LayeredRay {
    /// The ray that spans the plan distance `plan`; `None` if the indices cannot be told apart, or rounding is too coarse.
    pub fn through(layers: [Layer; 2], plan: Enclosure) -> Option<Self> {
        let rare = match (layers[0].index, layers[1].index) {
            (a, b) if a.high() <= b.low() => 0,
            (a, b) if b.high() <= a.low() => 1,
            _ => return None,
        };
        let (r, d) = (layers[rare], layers[1 - rare]);
        let gap = (d.index - r.index) * (d.index + r.index);
        let jet = Jet::constant;
        let span = |t: Jet| {
            let root = (jet(d.index.squared()) + jet(gap) * t.squared()).sqrt();
            jet(r.thickness) * t + jet(d.thickness * r.index) * t / root - jet(plan)
        };
        // A little to the left of 0, so that a vertical ray is inside.
        let largest = (plan / r.thickness).high();
        let room = 0.125 * largest + 0.125;
        let zeros = isolate(-room, largest + room, span);
        let [t] = zeros.simple[..] else {
            return None;
        };
        if !zeros.undecided.is_empty() {
            return None;
        }
        let w = Enclosure::ONE / (Enclosure::ONE + t.squared()).sqrt();
        let q_rare = r.index * w;
        let q_dense = (d.index.squared() + gap * t.squared()).sqrt() * w;
        Some(LayeredRay {
            p: r.index * t * w,
            q: if rare == 0 {
                [q_rare, q_dense]
            } else {
                [q_dense, q_rare]
            },
        })
    }

    /// Σ l_j/q_j: plan distance over p.
    pub fn sagittal(&self, layers: [Layer; 2]) -> Enclosure {
        layers[0].thickness / self.q[0] + layers[1].thickness / self.q[1]
    }

    /// Σ l_j n_j²/q_j³: derivative of the plan distance by p.
    pub fn tangential(&self, layers: [Layer; 2]) -> Enclosure {
        let term = |j: usize| {
            let Layer { thickness, index } = layers[j];
            thickness * index.squared() / (self.q[j].squared() * self.q[j])
        };
        term(0) + term(1)
    }
}
