//! The part of a surface that walks start from: two uniforms to a point.

use core::f64::consts::TAU;

use glam::{DVec2, DVec3};

/// A part of a surface.
#[derive(Clone, Debug)]
pub(super) enum Patch {
    /// A parallelogram: centre and half edges.
    Flat(DVec3, [DVec3; 2]),
    /// The part of the plane z = `.0` over the rectangle in plan that holds the floor point and `.1`.
    Between(f64, DVec2),
    /// An upright wall over an arc of the conic |q| = p - e q·axis about a focus; a circle if e = 0.
    Wall {
        /// The focus in plan [m].
        focus: DVec2,
        /// Unit vector of the axis.
        axis: DVec2,
        /// p [m].
        parameter: f64,
        /// e.
        eccentricity: f64,
        /// Largest angle to the axis [rad].
        half_arc: f64,
        /// Height [m].
        height: f64,
    },
    /// A surface of revolution about a vertical axis.
    Revolution {
        /// A point of the axis, from which heights are measured [m].
        center: DVec3,
        /// Range of the height [m].
        heights: [f64; 2],
        /// Coefficients of r² = a + b z + c z².
        profile: [f64; 3],
    },
    /// A single point: for surfaces of which the start does not matter.
    #[cfg(test)]
    Everything(DVec3),
}

impl Patch {
    /// The whole of an upright cylinder, from z = 0.
    pub fn cylinder(center: DVec2, radius: f64, height: f64) -> Self {
        Patch::Wall {
            focus: center,
            axis: DVec2::X,
            parameter: radius,
            eccentricity: 0.0,
            half_arc: core::f64::consts::PI,
            height,
        }
    }

    /// The point of two uniforms.
    pub fn point(&self, x: DVec3, u: f64, v: f64) -> DVec3 {
        match self {
            Patch::Flat(center, [a, b]) => *center + *a * (2.0 * u - 1.0) + *b * (2.0 * v - 1.0),
            Patch::Between(z, end) => {
                let x = x.truncate();
                (x + (*end - x) * DVec2::new(u, v)).extend(*z)
            }
            Patch::Wall {
                focus,
                axis,
                parameter,
                eccentricity,
                half_arc,
                height,
            } => {
                let (sine, cosine) = libm::sincos(half_arc * (2.0 * u - 1.0));
                let radius = parameter / (1.0 + eccentricity * cosine);
                let direction = *axis * cosine + axis.perp() * sine;
                (*focus + direction * radius).extend(height * v)
            }
            Patch::Revolution {
                center,
                heights: [low, high],
                profile: [a, b, c],
            } => {
                let z = low + (high - low) * v;
                let square = a + b * z + c * z * z;
                let radius = f64::sqrt(if square > 0.0 { square } else { 0.0 });
                let (sine, cosine) = libm::sincos(TAU * u);
                *center + DVec3::new(radius * cosine, radius * sine, z)
            }
            #[cfg(test)]
            Patch::Everything(point) => *point,
        }
    }
}
