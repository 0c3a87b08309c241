//! Sums over the directions at a receiver point, and over the rays of the light.

use super::scenes::{BEAM, Scene};
use super::{End, Light, PI, V, World, add, dot, length};

pub fn square(v: f64) -> f64 {
    v * v
}

pub fn angle(a: V, b: V) -> f64 {
    2.0 * libm::asin((0.5 * length(add(a, b, -1.0))).min(1.0))
}

/// The smallest box of cells of the unit square about all at which an angle is within reach.
pub fn window(reach: f64, angle_at: impl Fn(f64, f64) -> Option<f64>) -> [[f64; 2]; 2] {
    let cells = 900;
    let mut range = [[1.0_f64, 0.0_f64]; 2];
    for i in 0..cells {
        for j in 0..cells {
            let at = [i, j].map(|k| (f64::from(k) + 0.5) / f64::from(cells));
            if angle_at(at[0], at[1]).is_some_and(|g| g < reach) {
                for (r, v) in range.iter_mut().zip(at) {
                    *r = [r[0].min(v), r[1].max(v)];
                }
            }
        }
    }
    range.map(|[a, b]| {
        let step = 2.5 / f64::from(cells);
        [(a - step).max(0.0), (b + step).min(1.0)]
    })
}

/// The points and the area of a midpoint rule.
pub fn grid(window: [[f64; 2]; 2], steps: u32, mut visit: impl FnMut(f64, f64, f64)) {
    let [h, k] = window.map(|[a, b]| (b - a) / f64::from(steps));
    for i in 0..steps {
        for j in 0..steps {
            let u = window[0][0] + (f64::from(i) + 0.5) * h;
            let v = window[1][0] + (f64::from(j) + 0.5) * k;
            visit(u, v, h * k);
        }
    }
}

/// A path from x that ends in a connection with the light.
pub struct Connected {
    pub end: End,
    pub to: V,
    pub strength: f64,
    /// cos θ dω per area of the unit square.
    pub measure: f64,
    pub angle: f64,
}

impl Scene {
    pub fn receiver_path(&self, k: u32, x: V, u: f64, v: f64) -> Option<Connected> {
        let (s, c) = libm::sincos(0.5 * PI * u);
        // From where no root of the cases is.
        let (sa, ca) = libm::sincos(2.0 * PI * v - 2.0);
        let end = self.world.trace(k, x, [c * ca, c * sa, s])?;
        let (to, strength) = self.world.towards_light(end.at, self.light)?;
        (dot(to, end.normal) > 0.0).then(|| Connected {
            end,
            to,
            strength,
            measure: s * c * PI * PI,
            angle: angle(to, end.exact),
        })
    }

    /// A ray of the light: the end of its chain, and the flux per area of the unit square.
    pub fn light_path(&self, k: u32, u: f64, v: f64) -> Option<(End, f64)> {
        let (from, d, flux) = match (self.light, self.world) {
            (Light::Point(y, intensity), _) => {
                let (s, c) = libm::sincos(PI * u);
                let (sa, ca) = libm::sincos(2.0 * PI * v);
                (y, [s * ca, s * sa, c], intensity * s * 2.0 * PI * PI)
            }
            (Light::Down(irradiance), World::Ball(c, a, _)) => {
                let (s, cos) = libm::sincos(0.5 * PI * u);
                let (sa, ca) = libm::sincos(2.0 * PI * v);
                let from = [c[0] + a * s * ca, c[1] + a * s * sa, c[2] + 5.0];
                let flux = irradiance * a * a * s * cos * PI * PI;
                (from, [0.0, 0.0, -1.0], flux)
            }
            (Light::Sun(e, irradiance), world) => {
                // By the incidence on the circle, and by the height there: on the side where glass, or the inside of a cup, is met.
                let ([x, y], a, h, side) = match world {
                    World::Pillar(c, a, h, _) => (c, a, h, -1.0),
                    World::Cup(a, h, _) => ([0.0; 2], a, h, 1.0),
                    _ => unreachable!(),
                };
                let (s, c) = libm::sincos(PI * (u - 0.5));
                let back = 3.0 * a;
                let from = [
                    x + side * a * c - back,
                    y + a * s,
                    h * v + back * libm::tan(e),
                ];
                let d = [libm::cos(e), 0.0, -libm::sin(e)];
                (from, d, irradiance * libm::cos(e) * a * c * PI * h)
            }
            _ => unreachable!(),
        };
        self.world.trace(k, from, d).map(|end| (end, flux))
    }

    /// Flux of all photons.
    pub fn photons(&self) -> f64 {
        match self.light {
            Light::Point(_, intensity) => 4.0 * PI * intensity,
            Light::Sun(_, irradiance) | Light::Down(irradiance) => irradiance * BEAM,
        }
    }

    /// Where the exact ray of an end lands on the floor, and how far that is.
    pub fn landing(&self, end: &End) -> Option<(V, f64)> {
        let t = end.at[2] / -end.exact[2];
        let p = add(end.at, end.exact, t);
        let on = (0..2).all(|k| p[k] >= self.floor[k][0] && p[k] <= self.floor[k][1]);
        (t > 0.0 && on).then_some((p, t))
    }
}

/// Unit direction and distance from an end to x, where x is seen from there.
pub fn to_receiver(end: &End, x: V) -> Option<(V, f64)> {
    let v = add(x, end.at, -1.0);
    let r = length(v);
    let to = add([0.0; 3], v, 1.0 / r);
    (dot(to, end.normal) > 0.0 && to[2] < 0.0).then_some((to, r))
}

/// `camera` and `symmetric` over the directions at x: [mean, second moment] each.
pub fn camera_sums(
    scene: &Scene,
    k: u32,
    x: V,
    reach: f64,
    steps: u32,
    phi: impl Fn(f64) -> f64,
) -> [[f64; 2]; 2] {
    let window = window(reach, |u, v| {
        scene.receiver_path(k, x, u, v).map(|c| c.angle)
    });
    let mut sums = [[0.0; 2]; 2];
    grid(window, steps, |u, v, area| {
        let Some(c) = scene.receiver_path(k, x, u, v) else {
            return;
        };
        let ratio = if c.end.mirror {
            (dot(c.to, c.end.normal) / dot(c.end.exact, c.end.normal)).sqrt()
        } else {
            1.0
        };
        for (sum, factor) in sums.iter_mut().zip([1.0, ratio]) {
            let f = c.end.weight * c.strength * factor * phi(c.angle);
            sum[0] += area * c.measure * f;
            sum[1] += area * c.measure * PI * f * f;
        }
    });
    sums
}

/// `light` and `linked` over the light's rays; φ by the angle, the end and its distance to x.
pub fn light_sums(
    scene: &Scene,
    k: u32,
    x: V,
    reach: f64,
    steps: u32,
    phi: impl Fn(f64, &End, f64) -> f64,
) -> [f64; 2] {
    let window = window(reach, |u, v| {
        let (end, _) = scene.light_path(k, u, v)?;
        Some(angle(to_receiver(&end, x)?.0, end.exact))
    });
    let mut sums = [0.0; 2];
    grid(window, steps, |u, v, area| {
        let Some((end, flux)) = scene.light_path(k, u, v) else {
            return;
        };
        let Some((to, r)) = to_receiver(&end, x) else {
            return;
        };
        let f = end.weight * phi(angle(to, end.exact), &end, r) * -to[2] / (r * r);
        sums[0] += area * flux * f;
        sums[1] += area * flux * scene.photons() * f * f;
    });
    sums
}

impl Scene {
    /// The diagonal of the box of floor, surfaces and point lights, where all are bounded.
    pub fn escape(&self) -> Option<f64> {
        let (low, high) = match self.world {
            World::Wedge(..) | World::Slab(..) => return None,
            World::Ball(c, a, _) => (add(c, [a; 3], -1.0), add(c, [a; 3], 1.0)),
            World::Pillar([x, y], a, h, _) => ([x - a, y - a, 0.0], [x + a, y + a, h]),
            World::Cup(a, h, _) => ([-a, -a, 0.0], [a, a, h]),
        };
        let size: f64 = (0..2)
            .map(|k| {
                let [a, b] = self.floor[k];
                square(b.max(high[k]) - a.min(low[k]))
            })
            .sum();
        Some((size + square(high[2])).sqrt())
    }
}
