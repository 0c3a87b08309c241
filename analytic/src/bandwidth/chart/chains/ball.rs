//! Chains of a glass ball in parallel light: reflection outside, or two refractions with reflections between them.
//!
//! In the plane of the centre and a ray, as complex numbers: a ray of the direction w and the incidence i meets the ball where
//! the normal is −w e^{−ii}, and every leg passes the centre at the same distance. After m interactions
//!
//! ```text
//! w' = w (−1)^m e^{−2ii} e^{2(m−1)ir},   sin i = n sin r,   last normal w' e^{ii}.
//! ```
//!
//! The parameters are those of the incidence sphere in stereographic projection, so that sin i, cos i and the azimuth are smooth from
//! the central ray to grazing. From a receiver point at the distance d from the centre, the angle ψ of the ray to the
//! axis has sin ψ = (a/d) sin i, and dω = (a/d)² cos i/cos ψ dΩ(i); a beam takes E₀ a² cos i dΩ(i). The ball is convex and wholly over
//! the floor: what leaves it meets nothing, and no critical angle is met.

use libm::sqrt;

use super::{UP, direction};
use crate::bandwidth::chart::chain::{Chain, OWN, Subpath, Subpaths};
use crate::bandwidth::chart::surfaces::frame_of;
use crate::kinds::power;
use crate::optics::{fresnel_reflectance, fresnel_transmittance};
use crate::scene::GlassBall;
use crate::vector::Vec3;

/// Light after a number of interactions with the ball.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ball {
    center: Vec3<f64>,
    radius: f64,
    index: f64,
    interactions: u32,
    beam: Vec3<f64>,
    irradiance: f64,
}

impl Ball {
    pub fn new(glass: &GlassBall, (beam, irradiance): (Vec3<f64>, f64), interactions: u32) -> Self {
        Ball {
            center: Vec3::from_f64(glass.center),
            radius: glass.radius,
            index: glass.index,
            interactions,
            beam,
            irradiance,
        }
    }
}

impl Chain for Ball {
    fn receiver_paths<'a>(&'a self, x: Vec3<f64>) -> Option<Box<dyn Subpaths + 'a>> {
        let way = self.center - x;
        let distance = way.length();
        Some(Box::new(Paths {
            ball: self,
            frame: frame_of(way * (1.0 / distance)),
            ratio: self.radius / distance,
            from_light: false,
        }))
    }

    fn light_paths<'a>(&'a self) -> Box<dyn Subpaths + 'a> {
        Box::new(Paths {
            ball: self,
            frame: frame_of(self.beam),
            ratio: 0.0,
            from_light: true,
        })
    }

    /// What a dielectric reflects depends on the side from which it is asked, as what it lets through does.
    fn is_mirror(&self) -> bool {
        false
    }
}

/// c + i s sin i: functions of the incidence of which s is even.
type Turn = (f64, f64);

/// Paths from a point, or along a beam.
#[derive(Debug)]
struct Paths<'a> {
    ball: &'a Ball,
    /// Two unit vectors across the axis from the origin to the centre, and the axis.
    frame: [Vec3<f64>; 3],
    /// a/d.
    ratio: f64,
    from_light: bool,
}

impl Subpaths for Paths<'_> {
    fn domain(&self) -> [[f64; 2]; 2] {
        [[-1.0, 1.0]; 2]
    }

    fn path(&self, u: [f64; 2]) -> Subpath {
        let (ball, m) = (self.ball, self.ball.interactions);
        let n = ball.index;
        let (incidence, solid_angle, rest) = direction(&self.frame, u);
        let axis = self.frame[2];
        let cosine = incidence.dot(axis);
        let across = incidence - axis * cosine;
        let sine2 = across.length_squared();
        let times = |(a, b): Turn, (c, d): Turn| -> Turn { (a * c - sine2 * b * d, a * d + b * c) };
        let vector = |(c, s): Turn| axis * c + across * s;

        let inner = sqrt((n - 1.0) * (n + 1.0) + cosine * cosine);
        let chord = times((inner / n, 1.0 / n), (inner / n, 1.0 / n));
        let ahead = sqrt(1.0 - self.ratio * self.ratio * sine2);
        let start: Turn = (ahead, self.ratio);
        let sign = if m.is_multiple_of(2) { 1.0 } else { -1.0 };
        let back: Turn = (cosine, -1.0);
        let first = times(start, times(back, back));
        let (c, s) = (1..m).fold(first, |w, _| times(w, chord));
        let out = (sign * c, sign * s);
        let normal = vector(times(out, (cosine, 1.0)));

        let f = fresnel_reflectance(1.0, cosine, n, inner);
        let weight = if m == 1 {
            f
        } else {
            let t = fresnel_transmittance(1.0, cosine, n, inner);
            t * t * power(f, m - 2)
        };
        let scale = if self.from_light {
            ball.irradiance * ball.radius * ball.radius
        } else {
            vector(start).dot(UP) * self.ratio * self.ratio / ahead
        };
        let mut margins = [1.0; OWN];
        margins[0] = rest;
        Subpath {
            vertex: ball.center + normal * ball.radius,
            normal,
            exact: vector(out),
            measure: solid_angle * cosine * scale,
            weight,
            length: 0.0,
            sheet: 1.0,
            margins,
        }
    }
}
