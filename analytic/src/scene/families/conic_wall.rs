//! A vertical wall over an arc of a conic, under a point light.
//!
//! **One reflection.** A ray that the wall reflects at Q and at the height z ≤ H goes on for s2 = s1 z/(h - z) ≤ κ s1,
//! κ = H/(h - H), in plan before it is on the floor. The chord from Q in its direction is τ = 2 p (m/δ) cos i/b with
//! b ≤ 1 (see [`crate::kinds::conic_wall`]; no curvature of the conic exceeds 1/p), and cos i = V/(m s1). So no ray meets
//! the wall again if for every Q of the arc
//!
//! ```text
//! G(θ) = 2 p δ V - κ |p u - δ A|² > 0,     V = p - A·(e + cos θ, sin θ),  δ = 1 + e cos θ,  u = (cos θ, sin θ),
//! ```
//!
//! A the light from the focus. G is looked at in steps so fine that its largest slope cannot take it to 0 between them.

use libm::{asin, atan2, cos, hypot, sin};
use serde::{Deserialize, Serialize};

use crate::class::PathClass;
use crate::scene::frame::Frame;
use crate::scene::ranges::{Checked, LARGEST, above, coordinates, invalid, positive, within};
use crate::scene::{Camera, Closure, Family, Floor, PointLight};

/// A vertical conic wall on the floor under a point light, outside the frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ConicWallScene {
    /// The light, on the inner side of the wall.
    pub light: PointLight,
    /// The receiver.
    pub floor: Floor,
    /// The mirror.
    pub wall: ConicArc,
}

impl Family for ConicWallScene {
    fn name(&self) -> &'static str {
        "conic-wall"
    }

    fn floor(&self) -> Option<&Floor> {
        Some(&self.floor)
    }

    fn classes(&self) -> &'static [PathClass] {
        &[PathClass::LDE, PathClass::LSDE]
    }

    fn closure(&self) -> Closure {
        Closure {
            longest: None,
            reason: "a vertical wall keeps the sign of the vertical direction; light meets it once at most, and it is not in the frame (both checked)",
        }
    }

    fn validate(&self, camera: &Camera) -> Checked {
        self.light.validate(0.0)?;
        self.wall.validate()?;
        self.wall.check_light(&self.light)?;
        self.wall.check_frame(camera)
    }
}

/// A vertical wall on the floor over the arc r = p/(1 + e cos θ), |θ| ≤ half arc, about a focus. It reflects on its inner
/// side, which contains the focus, absorbs on its outer side and occludes from both.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ConicArc {
    /// The focus (x, y) [m].
    #[serde(default)]
    pub focus: [f64; 2],
    /// The axis, θ = 0 in plan, from the focus to the nearest point of the wall, of any length.
    pub direction: [f64; 2],
    /// Semi-latus rectum p [m].
    pub parameter: f64,
    /// Eccentricity e: 0 circle, below 1 ellipse, 1 parabola, above 1 hyperbola.
    pub eccentricity: f64,
    /// Half of the arc [degrees]; 180 is a closed ellipse.
    pub half_arc_degrees: f64,
    /// Height H [m].
    pub height: f64,
    /// Specular reflectance R.
    pub reflectance: f64,
}

/// Steps over the arc.
const STEPS: u32 = 2048;
/// Pieces of the arc that are each beside the frame.
const PIECES: u32 = 48;
/// Smallest 1 + e cos(half arc): the wall ends well before the asymptote.
const OPENING: f64 = 0.02;

impl ConicArc {
    /// Unit vector along the axis.
    pub fn axis(&self) -> (f64, f64) {
        let [x, y] = self.direction;
        let length = hypot(x, y);
        (x / length, y / length)
    }

    /// Half of the arc [rad]; `None` for a closed ellipse.
    pub fn half_arc(&self) -> Option<f64> {
        (self.half_arc_degrees < 180.0).then(|| self.half_arc_degrees.to_radians())
    }

    /// Two opposite corners of the smallest box about the wall [m].
    pub fn corners(&self) -> [[f64; 3]; 2] {
        let (c, s) = self.axis();
        let farthest = |[x, y]: [f64; 2]| {
            let local = (x * c + y * s, y * c - x * s);
            self.reach(local, -self.end(), self.end())
        };
        let [fx, fy] = self.focus;
        [
            [fx - farthest([-1.0, 0.0]), fy - farthest([0.0, -1.0]), 0.0],
            [
                fx + farthest([1.0, 0.0]),
                fy + farthest([0.0, 1.0]),
                self.height,
            ],
        ]
    }

    fn end(&self) -> f64 {
        self.half_arc().unwrap_or(core::f64::consts::PI)
    }

    /// A position about focus and axis.
    fn local(&self, x: f64, y: f64) -> (f64, f64) {
        let ((c, s), dx, dy) = (self.axis(), x - self.focus[0], y - self.focus[1]);
        (dx * c + dy * s, dy * c - dx * s)
    }

    fn validate(&self) -> Checked {
        coordinates("wall.focus", &self.focus)?;
        coordinates("wall.direction", &self.direction)?;
        if !(hypot(self.direction[0], self.direction[1]) >= 1e-9) {
            return Err(invalid(
                "wall.direction",
                format!("{:?}", self.direction),
                "a vector of length 1e-9 or more",
            ));
        }
        positive("wall.parameter", self.parameter)?;
        positive("wall.height", self.height)?;
        within("wall.eccentricity", self.eccentricity, 0.0, 10.0)?;
        above("wall.half_arc_degrees", self.half_arc_degrees, 0.0, 180.0)?;
        above("wall.reflectance", self.reflectance, 0.0, 1.0)?;
        if 1.0 + self.eccentricity * cos(self.end()) >= OPENING {
            return Ok(());
        }
        Err(invalid(
            "wall.half_arc_degrees",
            self.half_arc_degrees,
            &format!("an angle with 1 + eccentricity × cos(half arc) at least {OPENING}"),
        ))
    }

    fn check_light(&self, light: &PointLight) -> Checked {
        let [x, y, h] = light.position;
        above("light.position", h, self.height, LARGEST).map_err(|e| {
            crate::scene::InvalidParameter {
                allowed: format!("a light higher than the wall: z {}", e.allowed),
                ..e
            }
        })?;
        let (p, e, a) = (self.parameter, self.eccentricity, self.local(x, y));
        let far = hypot(a.0, a.1);
        if !(p - e * a.0 - far > 1e-9 * p) {
            return Err(invalid(
                "light.position",
                format!("{:?}", light.position),
                "a point on the inner side of the wall, the one with the focus",
            ));
        }
        let kappa = self.height / (h - self.height);
        let margin = |theta: f64| {
            let (c, s) = (cos(theta), sin(theta));
            let delta = 1.0 + e * c;
            let front = p - a.0 * (e + c) - a.1 * s;
            let to = (p * c - delta * a.0, p * s - delta * a.1);
            2.0 * p * delta * front - kappa * (to.0 * to.0 + to.1 * to.1)
        };
        // |δ| ≤ 1 + e, |δ'| ≤ e, |V| ≤ p + (1 + e)|A|, |V'| ≤ |A|.
        let steepest = 2.0 * p * ((p + (1.0 + e) * far) * e + (1.0 + e) * far)
            + kappa * (2.0 * p * (1.0 + 2.0 * e) * far + 2.0 * (1.0 + e) * e * far * far);
        let step = 2.0 * self.end() / f64::from(STEPS);
        let once =
            (0..=STEPS).all(|k| margin(step * f64::from(k) - self.end()) > 0.5 * step * steepest);
        if once {
            return Ok(());
        }
        Err(invalid(
            "wall.height",
            self.height,
            "a wall so low that light is on the floor before it meets the wall again",
        ))
    }

    /// The largest n·Q over the arc from θ = `low` to `high`, about focus and axis.
    fn reach(&self, n: (f64, f64), low: f64, high: f64) -> f64 {
        let (p, e) = (self.parameter, self.eccentricity);
        let along = |theta: f64| {
            let (c, s) = (cos(theta), sin(theta));
            p * (n.0 * c + n.1 * s) / (1.0 + e * c)
        };
        let mut most = along(low).max(along(high));
        // The tangent is perpendicular to n where sin(θ - ν) = e sin ν.
        let nu = atan2(n.1, n.0);
        let turn = e * sin(nu);
        if turn.abs() <= 1.0 {
            let theta = nu + asin(turn);
            let full = 2.0 * core::f64::consts::PI;
            for theta in [theta - full, theta, theta + full] {
                if theta >= low && theta <= high {
                    most = most.max(along(theta));
                }
            }
        }
        most
    }

    fn check_frame(&self, camera: &Camera) -> Checked {
        let frame = Frame::new(camera);
        let (c, s) = self.axis();
        let step = 2.0 * self.end() / f64::from(PIECES);
        for k in 0..PIECES {
            let low = step * f64::from(k) - self.end();
            frame.check_beside("the wall", |n| {
                let local = (n[0] * c + n[1] * s, n[1] * c - n[0] * s);
                let plan = n[0] * self.focus[0] + n[1] * self.focus[1];
                plan + self.reach(local, low, low + step) + (n[2] * self.height).max(0.0)
            })?;
        }
        Ok(())
    }
}
