//! Chains of specular interactions followed step by step in vectors: nearest hits, Snell's law, Fresnel's sine and tangent laws.
//! No unfolding, no image, no closed chain.

pub mod scenes;
pub mod sums;

pub type V = [f64; 3];

pub const PI: f64 = core::f64::consts::PI;

pub fn add(a: V, b: V, k: f64) -> V {
    [a[0] + k * b[0], a[1] + k * b[1], a[2] + k * b[2]]
}

pub fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn length(a: V) -> f64 {
    dot(a, a).sqrt()
}

/// The specular surfaces of a scene.
#[derive(Clone, Copy, Debug)]
pub enum World {
    /// Half-planes at the polar angles 0 and π/m; reflectance.
    Wedge(u32, f64),
    /// Bottom, top, index.
    Slab(f64, f64, f64),
    /// Centre, radius, index.
    Ball(V, f64, f64),
    /// Axis, radius, height, index.
    Pillar([f64; 2], f64, f64, f64),
    /// Radius, height, reflectance.
    Cup(f64, f64, f64),
}

#[derive(Clone, Copy, Debug)]
pub enum Light {
    /// Position, intensity.
    Point(V, f64),
    /// Elevation (it travels along +x) [rad], irradiance.
    Sun(f64, f64),
    /// Irradiance, straight down.
    Down(f64),
}

/// The end of a chain.
#[derive(Clone, Copy, Debug)]
pub struct End {
    pub at: V,
    /// On the side to which the path goes on.
    pub normal: V,
    pub exact: V,
    pub weight: f64,
    pub mirror: bool,
}

/// Unpolarised reflectance for the incidence sine s from index 1 to n, by angles.
fn fresnel(s: f64, n: f64) -> f64 {
    let (i, t) = (libm::asin(s.min(1.0)), libm::asin((s / n).min(1.0)));
    if i < 1e-7 {
        let r = (n - 1.0) / (n + 1.0);
        return r * r;
    }
    let a = libm::sin(i - t) / libm::sin(i + t);
    let b = libm::tan(i - t) / libm::tan(i + t);
    0.5 * (a * a + b * b)
}

fn mirrored(d: V, n: V) -> V {
    add(d, n, -2.0 * dot(d, n))
}

/// Refracted direction with the normal against d, and transmittance; n is the index of the other side relative to this one.
fn bent(d: V, normal: V, n: f64) -> Option<(V, f64)> {
    let along = add(d, normal, -dot(d, normal));
    let s = length(along);
    if s >= n {
        return None;
    }
    let c = (1.0 - s * s / (n * n)).sqrt();
    Some((
        add([along[0] / n, along[1] / n, along[2] / n], normal, -c),
        1.0 - fresnel(s, n),
    ))
}

/// Positive ray parameters at which |p + t d| = radius over the coordinates that count.
fn circle(p: V, d: V, radius: f64, dims: usize) -> Option<[f64; 2]> {
    let sum = |f: &dyn Fn(usize) -> f64| (0..dims).map(f).sum::<f64>();
    let a = sum(&|k| d[k] * d[k]);
    let b = sum(&|k| p[k] * d[k]);
    let c = sum(&|k| p[k] * p[k]) - radius * radius;
    let q = b * b - a * c;
    (q > 0.0).then(|| [(-b - q.sqrt()) / a, (-b + q.sqrt()) / a])
}

impl World {
    /// Follows a ray to its k-th interaction.
    pub fn trace(&self, k: u32, from: V, d: V) -> Option<End> {
        match *self {
            World::Wedge(m, r) => {
                let b = PI / f64::from(m);
                let walls = [
                    ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
                    (
                        [libm::cos(b), libm::sin(b), 0.0],
                        [libm::sin(b), -libm::cos(b), 0.0],
                    ),
                ];
                let (mut p, mut d, mut weight) = (from, d, 1.0);
                let mut end = None;
                for _ in 0..k {
                    let mut best: Option<(f64, V)> = None;
                    for (along, normal) in walls {
                        if dot(d, normal) >= 0.0 {
                            continue;
                        }
                        let t = -dot(p, normal) / dot(d, normal);
                        let on = dot(add(p, d, t), along) > 0.0;
                        if on && t > 1e-13 && best.is_none_or(|(u, _)| t < u) {
                            best = Some((t, normal));
                        }
                    }
                    let (t, normal) = best?;
                    p = add(p, d, t);
                    d = mirrored(d, normal);
                    weight *= r;
                    if p[2] <= 0.0 {
                        return None;
                    }
                    end = Some(End {
                        at: p,
                        normal,
                        exact: d,
                        weight,
                        mirror: true,
                    });
                }
                end
            }
            World::Slab(bottom, top, n) => {
                let up = [0.0, 0.0, d[2].signum()];
                let (near, far) = if d[2] > 0.0 {
                    (bottom, top)
                } else {
                    (top, bottom)
                };
                let mut p = add(from, d, (near - from[2]) / d[2]);
                let (mut g, mut weight) = bent(d, [0.0, 0.0, -up[2]], n)?;
                for step in 0..k - 1 {
                    let to = if step % 2 == 0 { far } else { near };
                    p = add(p, g, (to - p[2]) / g[2]);
                    let (out, t) = bent(g, [0.0, 0.0, -g[2].signum()], 1.0 / n)?;
                    if step == k - 2 {
                        return Some(End {
                            at: p,
                            normal: up,
                            exact: out,
                            weight: weight * t,
                            mirror: false,
                        });
                    }
                    weight *= 1.0 - t;
                    g[2] = -g[2];
                }
                None
            }
            World::Ball(c, a, n) => Self::round(k, add(from, c, -1.0), d, a, n, 3, c),
            World::Pillar([x, y], a, h, n) => {
                let c = [x, y, 0.0];
                let end = Self::round(k, add(from, c, -1.0), d, a, n, 2, c)?;
                // Straight up or down: what is inside at both ends is inside all the way.
                let t = circle(add(from, c, -1.0), d, a, 2)?[0];
                let first = from[2] + t * d[2];
                let inside = |z: f64| z > 0.0 && z < h;
                (inside(first) && inside(end.at[2])).then_some(end)
            }
            World::Cup(a, h, r) => {
                let (mut p, mut d) = (from, d);
                let mut weight = 1.0;
                if libm::hypot(p[0], p[1]) >= a {
                    // Over the near rim.
                    let t = circle(p, d, a, 2)?[0];
                    p = add(p, d, t);
                    if p[2] < h {
                        return None;
                    }
                }
                for _ in 0..k {
                    p = add(p, d, circle(p, d, a, 2)?[1]);
                    if p[2] > h || p[2] < 0.0 {
                        return None;
                    }
                    d = mirrored(d, [p[0] / a, p[1] / a, 0.0]);
                    weight *= r;
                }
                Some(End {
                    at: p,
                    normal: [-p[0] / a, -p[1] / a, 0.0],
                    exact: d,
                    weight,
                    mirror: true,
                })
            }
        }
    }

    /// A glass sphere (3 dimensions) or vertical cylinder (2) about 0, then displaced by c.
    fn round(k: u32, from: V, d: V, a: f64, n: f64, dims: usize, c: V) -> Option<End> {
        let t = circle(from, d, a, dims)?[0];
        if t <= 0.0 {
            return None;
        }
        let outward = |p: V| {
            let mut n = [p[0] / a, p[1] / a, p[2] / a];
            if dims == 2 {
                n[2] = 0.0;
            }
            n
        };
        let mut p = add(from, d, t);
        let normal = outward(p);
        let (mut g, mut weight) = bent(d, normal, n)?;
        if k == 1 {
            return Some(End {
                at: add(p, c, 1.0),
                normal,
                exact: mirrored(d, normal),
                weight: 1.0 - weight,
                mirror: false,
            });
        }
        for step in 1..k {
            p = add(p, g, circle(p, g, a, dims)?[1]);
            let normal = outward(p);
            let (out, t) = bent(g, add([0.0; 3], normal, -1.0), 1.0 / n)?;
            if step == k - 1 {
                return Some(End {
                    at: add(p, c, 1.0),
                    normal,
                    exact: out,
                    weight: weight * t,
                    mirror: false,
                });
            }
            weight *= 1.0 - t;
            g = mirrored(g, normal);
        }
        None
    }

    /// Whether nothing stops the way from the last vertex of a chain to the light, and how far and how strong that is.
    pub fn towards_light(&self, s: V, light: Light) -> Option<(V, f64)> {
        let (d, strength) = match light {
            Light::Point(y, intensity) => {
                let v = add(y, s, -1.0);
                let r = length(v);
                (add([0.0; 3], v, 1.0 / r), intensity / (r * r))
            }
            Light::Sun(e, irradiance) => ([-libm::cos(e), 0.0, libm::sin(e)], irradiance),
            Light::Down(irradiance) => ([0.0, 0.0, 1.0], irradiance),
        };
        if let World::Cup(a, h, _) = *self {
            let t = circle(s, d, a, 2)?[1];
            if s[2] + t * d[2] < h {
                return None;
            }
        }
        Some((d, strength))
    }
}
