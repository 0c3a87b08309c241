//! Vectors, Snell's law and Fresnel's equations in angles, and a random stream: written anew for the tests.

pub type V = [f64; 3];

pub fn add(a: V, b: V, k: f64) -> V {
    [a[0] + k * b[0], a[1] + k * b[1], a[2] + k * b[2]]
}

pub fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn unit(a: V) -> V {
    let l = dot(a, a).sqrt();
    [a[0] / l, a[1] / l, a[2] / l]
}

pub fn mirror(d: V, normal: V) -> V {
    add(d, normal, -2.0 * dot(d, normal))
}

/// Refraction of the unit direction `d` from index 1 to `n` (or from n to 1 with 1/n), `normal` against `d`; the second
/// number is the unpolarised transmittance by Fresnel's sine and tangent laws.
pub fn refract(d: V, normal: V, n: f64) -> (V, f64) {
    let cos_i = -dot(d, normal);
    let along = add(d, normal, cos_i);
    let sin_i = dot(along, along).sqrt();
    let sin_t = sin_i / n;
    let cos_t = (1.0 - sin_t * sin_t).sqrt();
    let out = add([along[0] / n, along[1] / n, along[2] / n], normal, -cos_t);
    let (i, t) = (libm::atan2(sin_i, cos_i), libm::asin(sin_t));
    let f = if i < 1e-6 {
        let r = (n - 1.0) / (n + 1.0);
        r * r
    } else {
        let s = libm::sin(i - t) / libm::sin(i + t);
        let p = libm::tan(i - t) / libm::tan(i + t);
        0.5 * (s * s + p * p)
    };
    (unit(out), 1.0 - f)
}

/// Where a ray from `from` along `d` meets f = 0 first: the first sign change on a grid, then bisection.
pub fn meet(f: impl Fn(V) -> f64, from: V, d: V, near: f64, far: f64) -> Option<V> {
    let steps = 4000;
    let at = |k: i32| near + (far - near) * f64::from(k) / f64::from(steps);
    let value = |t: f64| f(add(from, d, t));
    let k = (0..steps).find(|&k| (value(at(k)) < 0.0) != (value(at(k + 1)) < 0.0))?;
    let (mut low, mut high) = (at(k), at(k + 1));
    let below = value(low) < 0.0;
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if (value(middle) < 0.0) == below {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(add(from, d, 0.5 * (low + high)))
}

/// The gradient of f, by central differences of fourth order, made a unit vector.
pub fn normal(f: impl Fn(V) -> f64, at: V) -> V {
    let h = 1e-3;
    let mut out = [0.0; 3];
    for (k, o) in out.iter_mut().enumerate() {
        let shift = |s: f64| {
            let mut p = at;
            p[k] += s;
            f(p)
        };
        *o = 8.0 * (shift(h) - shift(-h)) - (shift(2.0 * h) - shift(-2.0 * h));
    }
    unit(out)
}

/// Where a ray meets the plane z = c.
pub fn to_plane(from: V, d: V, c: f64) -> Option<V> {
    let t = (c - from[2]) / d[2];
    (t > 0.0).then(|| add(from, d, t))
}

/// |det| of a map of two parameters into the plane, by central differences of fourth order.
pub fn determinant(map: impl Fn(f64, f64) -> Option<V>, h: f64) -> Option<f64> {
    let column = |du: f64, dv: f64| {
        let at = |k: f64| map(k * du, k * dv);
        let (a, b, c, d) = (at(1.0)?, at(-1.0)?, at(2.0)?, at(-2.0)?);
        let derivative = |k: usize| (8.0 * (a[k] - b[k]) - (c[k] - d[k])) / (12.0 * h);
        Some([derivative(0), derivative(1)])
    };
    let (u, v) = (column(h, 0.0)?, column(0.0, h)?);
    Some((u[0] * v[1] - u[1] * v[0]).abs())
}

/// Two unit vectors perpendicular to a unit vector and each other.
pub fn frame(d: V) -> (V, V) {
    let helper = if d[2].abs() < 0.9 {
        [0.0, 0.0, 1.0]
    } else {
        [1.0, 0.0, 0.0]
    };
    let cross = |a: V, b: V| {
        [
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ]
    };
    let u = unit(cross(helper, d));
    (u, cross(d, u))
}

/// SplitMix64 (G. Steele, D. Lea & C. Flood, OOPSLA 2014): fixed parameters for the tests.
pub struct Random(pub u64);

impl Random {
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let unit = ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64;
        low + (high - low) * unit
    }
}
