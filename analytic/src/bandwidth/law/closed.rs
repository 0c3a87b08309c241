//! κ of E_α = E₀ (1 + κ ⟨g²⟩ + O(α⁴)) in closed form, for the camera's and the light's side [theory/bandwidth.md, section 3],
//! and the law at a kink, E_α = E₀ + c α^(1/2).

use super::constants::Shape;
use crate::bandwidth::unfold::Unfolded;
use crate::bandwidth::{Kernel, PlanarSetting, Technique};
use crate::kinds::flat_interface::FlatInterface;
use crate::vector::Vec3;

/// A plane mirror in any pose, at a point x of the receiver: `camera` and `light`. `None` for other techniques and behind the mirror.
///
/// With A = 1/r₁, B = 1/r₂, C = A + B, Q = A² − AB + B², T the tangent of the angle of incidence, η = (e·n_x)/(w·n_x), w the
/// direction from x to the light's image, e the unit vector along the part of the mirror's normal across w that points away from x, and
/// (m, k) = (4, 2) from the camera, (3, 3) from the light.
pub fn planar_mirror(setting: &PlanarSetting, x: [f64; 3], technique: Technique) -> Option<f64> {
    let (m, k) = match technique {
        Technique::Camera => (4.0, 2.0),
        Technique::Light => (3.0, 3.0),
        _ => return None,
    };
    let x = Vec3::from_f64(x);
    let unfolded = Unfolded::new(setting, x, technique)?;
    let (a, b, t) = (1.0 / unfolded.a, 1.0 / unfolded.b, unfolded.tan_theta);
    let w = (setting.image() - x).normalized();
    // Away from x: ν·w > 0.
    let nu = -setting.mirror_normal;
    let across = nu - w * nu.dot(w);
    let length = across.length();
    let eta = if length > 1e-12 {
        across.dot(setting.receiver_normal) / length / w.dot(setting.receiver_normal)
    } else {
        0.0
    };
    let (c, q) = (a + b, a * a - a * b + b * b);
    let t2 = t * t;
    let slope = t * eta - t2;
    let bracket = 5.0 * t2 * (a - b) * (a - b) - 4.0 * (0.5 * t2 - 1.0 / 3.0) * q
        + a * a * (-0.5 * m + (m * m + m) * t2 / 4.0)
        + b * b * (-0.5 * k + (k * k + k) * t2 / 4.0)
        - 0.5 * m * k * a * b * t2
        + 0.5 * a * slope * (m * a - k * b)
        - 2.0 * (a - b) * (a * slope + (m * a - k * b) * t2);
    Some(1.0 / 6.0 + bracket / (c * c))
}

/// The axis of a spherical mirror of radius `a`, concave (negative: convex), receiver and light at the distances p and q from its
/// vertex: from the camera and from the light.
pub fn sphere_axis(a: f64, p: f64, q: f64) -> [f64; 2] {
    let (u, v) = (a / p, a / q);
    let g1 = u + v - 2.0;
    let g3 = -(u + v) / 6.0 + 0.5 * (u * u + v * v) - (u * u * u + v * v * v) / 3.0;
    [u, v].map(|s| {
        let last = 1.0 / 6.0 + 1.5 * u * u + v * v - u - v + 0.5 * (s - 1.0) * (s - 1.0);
        1.0 / 6.0 - 4.0 * g3 / (g1 * g1 * g1) - last / (g1 * g1)
    })
}

/// The axis of a flat interface, receiver at depth `depth`, light at `height`, relative index n: from the camera (kernel in the light's medium)
/// and from the light (kernel in the receiver's).
pub fn interface_axis(n: f64, depth: f64, height: f64) -> [f64; 2] {
    let (d, h) = (1.0 / depth, 1.0 / height);
    let cube = |x: f64| x * x * x;
    let camera = {
        let g1 = n * d + h;
        let g3 = -0.5 * n * cube(d) + cube(n) * cube(d) / 6.0 - cube(h) / 3.0;
        let h2 = -2.0 * d * d - h * h;
        1.0 / 6.0 - 4.0 * g3 / cube(g1) + h2 / (g1 * g1)
    };
    let light = {
        let g1 = d + h / n;
        let g3 = -cube(d) / 3.0 - 0.5 / n * cube(h) + cube(h) / (6.0 * cube(n));
        let h2 = -1.5 * (d * d + h * h);
        1.0 / 6.0 - 4.0 * g3 / cube(g1) + h2 / (g1 * g1)
    };
    [camera, light]
}

/// The critical circle of an inner reflection, and what is merged on it.
#[derive(Clone, Copy, Debug)]
pub struct CriticalCircle {
    /// Its radius X_c about the point under the light [m].
    pub radius: f64,
    /// Irradiance on it and just outside, where all light is reflected [W/m²].
    pub irradiance: f64,
    /// E ~ irradiance − strength (X_c − X)^(1/2) just inside [W/m²/m^(1/2)].
    pub strength: f64,
}

impl CriticalCircle {
    /// Of a flat interface that reflects inside the denser medium; `None` where there is no critical angle.
    ///
    /// With n the relative index and D the height of the folded way, sin i_c = 1/n and X_c = D tan i_c. Inside, the cosine in the rarer
    /// medium is c_t = √(2n cos³ i_c (X_c − X)/D) to leading order, the amplitudes are 1 − 2c_t/(n cos i) and 1 − 2n c_t/cos i, and so
    /// F = 1 − 2 (n + 1/n) c_t/cos i_c. Derived here.
    pub fn of(form: &FlatInterface<f64>) -> Option<Self> {
        let distance = form.distance_to_kink(form.light.x, form.light.y)?;
        let height =
            f64::abs(form.light.z - form.surface_z) + f64::abs(form.receiver_z - form.surface_z);
        // The critical angle exists: the light's medium is the denser one.
        let n = form.index.max(1.0 / form.index);
        let cosine = libm::sqrt((n - 1.0) * (n + 1.0)) / n;
        let cube = cosine * cosine * cosine;
        let irradiance = form.intensity * cube / (height * height);
        let grazing = libm::sqrt(2.0 * n * cube / height);
        Some(CriticalCircle {
            radius: distance,
            irradiance,
            strength: irradiance * 2.0 * (n + 1.0 / n) / cosine * grazing,
        })
    }

    /// The coefficient of r^(1/2) in what is merged on the circle: there E_r ~ irradiance + coefficient r^(1/2), order 1/2.
    pub fn coefficient(&self, kernel: Kernel) -> f64 {
        -0.5 * self.strength * Shape::new(kernel, false).across(1, 0.5)
    }
}
