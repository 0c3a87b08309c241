//! Specular surfaces as two-parameter families of points.

use core::f64::consts::PI;
use core::fmt::Debug;

use libm::{cos, sqrt, tan};

use super::link::Again;
use crate::vector::{Vec3, vec3};

/// A point of a surface.
#[derive(Clone, Copy, Debug)]
pub(in crate::bandwidth) struct Vertex {
    /// The point [m].
    pub point: Vec3<f64>,
    /// Unit normal on the side of the light.
    pub normal: Vec3<f64>,
    /// Area per parameter area.
    pub area: f64,
    /// Non-negative on the surface, negative beyond its edges.
    pub margins: [f64; 3],
}

/// A mirror or an interface.
pub(in crate::bandwidth) trait Surface: Debug + Send + Sync {
    /// Rectangle of the parameters.
    fn domain(&self) -> [[f64; 2]; 2];

    /// The point of a pair of parameters: smooth.
    fn vertex(&self, u: [f64; 2]) -> Vertex;

    /// Margins of the leg towards the light and of that towards the receiver: negative where another part of the surface is
    /// in the way. Of a surface that sees itself nowhere both are 1.
    fn free(&self, _s: &Vec3<f64>, _normal: &Vec3<f64>, _legs: &Legs) -> [f64; 2] {
        [1.0; 2]
    }

    /// Number of conditions under which a ray that leaves the surface meets it again; 0 if it never does.
    fn again_conditions(&self) -> usize {
        0
    }

    /// Where a ray that leaves `s` on the side of its normal meets the surface again.
    fn again(&self, _s: &Vec3<f64>, _normal: &Vec3<f64>, _out: &Vec3<f64>) -> Option<Again> {
        None
    }
}

/// The two legs of a path from a vertex: unit directions and lengths [m].
#[derive(Clone, Copy, Debug)]
pub(in crate::bandwidth) struct Legs {
    pub to_light: Vec3<f64>,
    /// Infinite for parallel light.
    pub r2: f64,
    pub to_x: Vec3<f64>,
    pub r1: f64,
}

impl Legs {
    pub(super) fn map(&self, f: impl Fn(&Vec3<f64>, f64) -> f64) -> [f64; 2] {
        [f(&self.to_light, self.r2), f(&self.to_x, self.r1)]
    }
}

/// A margin that holds where any of the conditions does; smooth but where the best of them changes. An infinitely long leg never
/// ends before it is stopped.
pub(super) fn any(conditions: &[f64]) -> f64 {
    conditions.iter().copied().fold(-1.0, |best, c| {
        let c = c.clamp(-1.0, 1.0);
        if c > best { c } else { best }
    })
}

/// The part of a sphere within an angle of an axis, by its normal in stereographic projection from the other pole: algebraic,
/// and the pole is a point like any other.
#[derive(Clone, Copy, Debug)]
pub(in crate::bandwidth) struct SphereCap {
    pub center: Vec3<f64>,
    pub radius: f64,
    /// Two unit vectors across the axis, and the axis.
    pub frame: [Vec3<f64>; 3],
    /// −1 where the light is inside, 1 where it is outside.
    pub side: f64,
    /// tan of half the angle of the rim.
    pub rim: f64,
    /// The same for a hole about the axis; 0 for none.
    pub hole: f64,
    /// Axis and cosine of the angle of the whole cap that this is a part of: what can be in the way.
    pub whole: (Vec3<f64>, f64),
}

impl SphereCap {
    /// A mirror on the inner side of a cap of any size: one part, or two.
    pub fn inside(center: Vec3<f64>, radius: f64, axis: Vec3<f64>, angle: f64) -> Vec<SphereCap> {
        let part = |axis, rim: f64, hole: f64, whole| SphereCap {
            center,
            radius,
            frame: frame_of(axis),
            side: -1.0,
            rim: tan(0.5 * rim),
            hole: tan(0.5 * hole),
            whole,
        };
        let whole = (axis, cos(angle));
        if angle <= 0.55 * PI {
            return vec![part(axis, angle, 0.0, whole)];
        }
        vec![
            part(axis, 0.5 * PI, 0.0, whole),
            part(-axis, 0.5 * PI, PI - angle, whole),
        ]
    }
}

/// Two unit vectors across a unit vector, and that vector.
pub(in crate::bandwidth) fn frame_of(axis: Vec3<f64>) -> [Vec3<f64>; 3] {
    let least = if f64::abs(axis.x) < 0.6 {
        vec3(1.0, 0.0, 0.0)
    } else {
        vec3(0.0, 1.0, 0.0)
    };
    let across = (least - axis * least.dot(axis)).normalized();
    [across, axis.cross(across), axis]
}

impl Surface for SphereCap {
    fn domain(&self) -> [[f64; 2]; 2] {
        [[-self.rim, self.rim]; 2]
    }

    fn vertex(&self, u: [f64; 2]) -> Vertex {
        let square = u[0] * u[0] + u[1] * u[1];
        let k = 1.0 / (1.0 + square);
        let [e1, e2, axis] = self.frame;
        let n = e1 * (2.0 * u[0] * k) + e2 * (2.0 * u[1] * k) + axis * ((1.0 - square) * k);
        let scale = 2.0 * self.radius * k;
        Vertex {
            point: self.center + n * self.radius,
            normal: n * self.side,
            area: scale * scale,
            margins: [
                self.rim * self.rim - square,
                if self.hole > 0.0 {
                    square - self.hole * self.hole
                } else {
                    1.0
                },
                1.0,
            ],
        }
    }

    fn free(&self, s: &Vec3<f64>, normal: &Vec3<f64>, legs: &Legs) -> [f64; 2] {
        if self.side > 0.0 {
            return [1.0; 2];
        }
        // Inside, both legs meet the sphere again after a chord; they are free where that is off the cap, or behind the end.
        let (axis, cos_rim) = self.whole;
        legs.map(|d, length| {
            let chord = 2.0 * self.radius * d.dot(*normal);
            let again = *s + *d * chord;
            let off = cos_rim - (again - self.center).dot(axis) / self.radius;
            any(&[off, chord - length])
        })
    }

    fn again_conditions(&self) -> usize {
        usize::from(self.side < 0.0)
    }

    fn again(&self, s: &Vec3<f64>, normal: &Vec3<f64>, out: &Vec3<f64>) -> Option<Again> {
        let (axis, cos_rim) = self.whole;
        let length = 2.0 * self.radius * out.dot(*normal);
        let p = *s + *out * length;
        let on = (p - self.center).dot(axis) / self.radius - cos_rim;
        Some(Again {
            length,
            conditions: [on, 1.0, 1.0],
        })
    }
}

/// The unbounded plane z = `height`, by directions towards it from a point at a distance, in stereographic projection: smooth up to
/// the horizon.
#[derive(Clone, Copy, Debug)]
pub(in crate::bandwidth) struct Level {
    pub height: f64,
    /// Under or over the point [m].
    pub center: [f64; 2],
    /// Its distance [m].
    pub distance: f64,
    /// 1 where the light is above, −1 where it is below.
    pub side: f64,
}

impl Surface for Level {
    fn domain(&self) -> [[f64; 2]; 2] {
        [[-1.0, 1.0]; 2]
    }

    fn vertex(&self, u: [f64; 2]) -> Vertex {
        let square = u[0] * u[0] + u[1] * u[1];
        let gap = 1.0 - square;
        let scale = 2.0 * self.distance / gap;
        let [x, y] = self.center;
        Vertex {
            point: vec3(x + scale * u[0], y + scale * u[1], self.height),
            normal: vec3(0.0, 0.0, self.side),
            area: scale * scale * (1.0 + square) / gap,
            margins: [gap, 1.0, 1.0],
        }
    }
}

/// A rectangle, by its two edges; one that goes below the floor is cut there by the receiver's cosine.
#[derive(Clone, Copy, Debug)]
pub(in crate::bandwidth) struct Rectangle {
    pub center: Vec3<f64>,
    /// Half of both edges [m], at right angles.
    pub half: [Vec3<f64>; 2],
    /// Unit normal on the side of the light.
    pub normal: Vec3<f64>,
}

impl Surface for Rectangle {
    fn domain(&self) -> [[f64; 2]; 2] {
        [[-1.0, 1.0]; 2]
    }

    fn vertex(&self, u: [f64; 2]) -> Vertex {
        Vertex {
            point: self.center + self.half[0] * u[0] + self.half[1] * u[1],
            normal: self.normal,
            area: self.half[0].length() * self.half[1].length(),
            margins: [1.0; 3],
        }
    }
}

/// A height field over the plane: (u, v) is the point below (or above) it.
pub(in crate::bandwidth) struct HeightField<F> {
    pub domain: [[f64; 2]; 2],
    /// 1 where the light is above, −1 where it is below.
    pub side: f64,
    /// Height [m], its gradient, and margins of the edges.
    pub height: F,
    /// Of a mirror z = v − r²/(4f) about a vertical axis: axis, f, inner and outer radius, by which its legs are checked.
    pub dish: Option<([f64; 2], f64, [f64; 2])>,
}

impl<F> Debug for HeightField<F> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("HeightField")
            .field("domain", &self.domain)
            .finish_non_exhaustive()
    }
}

impl<F: Fn([f64; 2]) -> (f64, [f64; 2], [f64; 2]) + Send + Sync> Surface for HeightField<F> {
    fn domain(&self) -> [[f64; 2]; 2] {
        self.domain
    }

    fn vertex(&self, u: [f64; 2]) -> Vertex {
        let (z, [gx, gy], [m0, m1]) = (self.height)(u);
        let area = sqrt(1.0 + gx * gx + gy * gy);
        Vertex {
            point: vec3(u[0], u[1], z),
            normal: vec3(-gx, -gy, 1.0) * (self.side / area),
            area,
            margins: [m0, m1, 1.0],
        }
    }

    fn free(&self, s: &Vec3<f64>, _: &Vec3<f64>, legs: &Legs) -> [f64; 2] {
        let Some(([cx, cy], f, [inner, outer])) = self.dish else {
            return [1.0; 2];
        };
        legs.map(|d, length| {
            let (x, y) = (s.x - cx, s.y - cy);
            let plan = d.x * d.x + d.y * d.y;
            let t = -(4.0 * f * d.z + 2.0 * (x * d.x + y * d.y)) / plan;
            let (x, y) = (x + d.x * t, y + d.y * t);
            let square = x * x + y * y;
            let off = square - outer * outer;
            let through = inner * inner - square;
            any(&[off, through, t - length, -t])
        })
    }

    fn again_conditions(&self) -> usize {
        match self.dish {
            Some((_, _, [inner, _])) => 1 + usize::from(inner > 0.0),
            None => 0,
        }
    }

    /// Inside a paraboloid a ray meets it again at a finite distance, unless it is along the axis.
    fn again(&self, s: &Vec3<f64>, _: &Vec3<f64>, out: &Vec3<f64>) -> Option<Again> {
        let ([cx, cy], f, [inner, outer]) = self.dish?;
        let (x, y) = (s.x - cx, s.y - cy);
        let plan = out.x * out.x + out.y * out.y;
        let length = -(4.0 * f * out.z + 2.0 * (x * out.x + y * out.y)) / plan;
        let (x, y) = (x + out.x * length, y + out.y * length);
        let square = x * x + y * y;
        // Within −1 and 1 however far that is.
        let within = |r: f64| (r * r - square) / (r * r + square);
        Some(Again {
            length,
            conditions: [within(outer), -within(inner), 1.0],
        })
    }
}

/// A conic of revolution about the vertical through a focus, by the direction from it, in stereographic projection from below:
/// |P| (α + β cos θ) = p, θ from the vertical.
#[derive(Clone, Copy, Debug)]
pub(in crate::bandwidth) struct FocalConic {
    pub focus: Vec3<f64>,
    /// p [m].
    pub parameter: f64,
    /// α: 1, or −1 for the far sheet of a hyperboloid.
    pub alpha: f64,
    /// β: the eccentricity, negative if the focus is the far one.
    pub beta: f64,
    /// −1 where the light is on the side of the focus, 1 where it is outside.
    pub side: f64,
    /// tan of half the angle of the rim, seen from the focus.
    pub rim: f64,
    /// Height and radius of the rim [m].
    pub rim_at: [f64; 2],
    /// Whether an opaque screen around the rim stops what passes beside it.
    pub screen: bool,
}

impl Surface for FocalConic {
    fn domain(&self) -> [[f64; 2]; 2] {
        [[-self.rim, self.rim]; 2]
    }

    fn vertex(&self, u: [f64; 2]) -> Vertex {
        let square = u[0] * u[0] + u[1] * u[1];
        let k = 1.0 / (1.0 + square);
        let d = vec3(2.0 * u[0] * k, 2.0 * u[1] * k, (1.0 - square) * k);
        let slope = self.alpha + self.beta * d.z;
        let r = self.parameter / slope;
        let gradient = d * self.alpha + vec3(0.0, 0.0, self.beta);
        let norm = gradient.length();
        Vertex {
            point: self.focus + d * r,
            normal: gradient * (self.side / norm),
            // dA = r² dΩ/cos.
            area: 4.0 * k * k * r * r * norm / slope,
            margins: [self.rim * self.rim - square, 1.0, 1.0],
        }
    }

    fn free(&self, s: &Vec3<f64>, _: &Vec3<f64>, legs: &Legs) -> [f64; 2] {
        let p = *s - self.focus;
        let [z, radius] = self.rim_at;
        if self.screen {
            let t = (z - s.z) / legs.to_x.z;
            let (x, y) = (p.x + legs.to_x.x * t, p.y + legs.to_x.y * t);
            return [1.0, radius * radius - x * x - y * y];
        }
        if self.alpha < 0.0 {
            return [1.0; 2];
        }
        let r = p.length();
        legs.map(|d, length| {
            let b = self.beta * d.z;
            let t = -2.0 * (p.dot(*d) + r * b) / ((1.0 - b) * (1.0 + b));
            any(&[z - (s.z + d.z * t), t - length, -t])
        })
    }

    fn again_conditions(&self) -> usize {
        usize::from(!self.screen && self.alpha > 0.0)
    }

    fn again(&self, s: &Vec3<f64>, _: &Vec3<f64>, out: &Vec3<f64>) -> Option<Again> {
        let p = *s - self.focus;
        let b = self.beta * out.z;
        let length = -2.0 * (p.dot(*out) + p.length() * b) / ((1.0 - b) * (1.0 + b));
        let above = s.z + out.z * length - self.rim_at[0];
        Some(Again {
            length,
            conditions: [above, 1.0, 1.0],
        })
    }
}
