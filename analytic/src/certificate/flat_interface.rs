//! Air over water: refracted or reflected light of a point light on either side. Theory block C.

use crate::certificate::layers::{Layer, LayeredRay};
use crate::certificate::radiometry::{
    Bundle, Facing, Point, plan_squared, point_light_enclosed, reflectance_enclosed,
    transmittance_enclosed,
};
use crate::certificate::scene::Seen;
use crate::certificate::{Certified, Lit, source::Source};
use crate::enclosure::Enclosure;
use crate::scalar::Scalar;
use crate::vector::vec3;

/// The surface with its light; a receiver below faces up, one above faces down.
#[derive(Clone, Copy, Debug)]
pub struct FlatInterface {
    surface_z: Enclosure,
    index: Enclosure,
    light: Point,
    intensity: Enclosure,
    receiver_z: Enclosure,
    light_above: bool,
    receiver_above: bool,
}

impl FlatInterface {
    /// `surface_z`, `n`, `light`, `I` and, if it is not 0, `Z`. `None` if light or receiver may be on the surface.
    pub fn read(p: &dyn Source) -> Option<Self> {
        let surface_z = p.number("surface_z")?;
        let light = p.point("light")?;
        let receiver_z = if p.has("Z") {
            p.number("Z")?
        } else {
            Enclosure::ZERO
        };
        Some(FlatInterface {
            surface_z,
            index: p.number("n")?,
            light,
            intensity: p.number("I")?,
            receiver_z,
            light_above: (light.z - surface_z).sign()? > 0,
            receiver_above: (receiver_z - surface_z).sign()? > 0,
        })
    }

    /// Height of the receiver.
    pub fn receiver_z(&self) -> Enclosure {
        self.receiver_z
    }

    fn index_on(&self, above: bool) -> Enclosure {
        if above { Enclosure::ONE } else { self.index }
    }

    /// The refracted or reflected light at (x, y).
    pub fn caustic_enclosed(&self, x: Point) -> Bundle {
        let squared = plan_squared(x.x - self.light.x, x.y - self.light.y);
        let layer = |z: Enclosure, above: bool| Layer {
            thickness: (z - self.surface_z).abs(),
            index: self.index_on(above),
        };
        let layers = [
            layer(self.light.z, self.light_above),
            layer(self.receiver_z, self.receiver_above),
        ];
        if self.light_above == self.receiver_above {
            let distance = layers[0].thickness + layers[1].thickness;
            let length_squared = squared + distance.squared();
            let n = layers[0].index;
            let sine_squared = squared / length_squared;
            let f = self.reflected(n, distance / length_squared.sqrt(), sine_squared);
            let e = self.intensity * f * distance / (length_squared * length_squared.sqrt());
            return Bundle::single(e, Lit::Yes);
        }
        let Some(ray) = LayeredRay::through(layers, squared.sqrt()) else {
            return Bundle::single(Enclosure::new(0.0, f64::INFINITY), Lit::Undecided);
        };
        let n = [layers[0].index, layers[1].index];
        let t = transmittance_enclosed(n[0], ray.q[0], n[1], ray.q[1]);
        let spread = ray.sagittal(layers) * ray.tangential(layers);
        Bundle::single(self.intensity * t / (n[0] * ray.q[0] * spread), Lit::Yes)
    }

    /// F of a ray in the medium of index `n`, 1 beyond the critical angle.
    fn reflected(&self, n: Enclosure, cosine: Enclosure, sine_squared: Enclosure) -> Enclosure {
        let other = self.index / n;
        let q2_squared = other.squared() - n.squared() * sine_squared;
        let total = Enclosure::ONE;
        if q2_squared.high() <= 0.0 {
            return total;
        }
        let partial = reflectance_enclosed(n, n * cosine, other, q2_squared.sqrt());
        if q2_squared.is_positive() {
            partial
        } else {
            partial.hull(total)
        }
    }

    /// Direct light, where both are on one side.
    pub fn direct_enclosed(&self, x: Point) -> Certified {
        let mut sum = Certified::NONE;
        if self.light_above == self.receiver_above {
            let facing = if self.receiver_above {
                Facing::Down
            } else {
                Facing::Up
            };
            let x = vec3(x.x, x.y, self.receiver_z);
            let (e, lit) = point_light_enclosed(self.light, self.intensity, x, facing);
            sum.add(e, lit);
        }
        sum
    }

    /// The receiver point that the camera sees through or in the surface. `None` if the camera may be on it.
    pub fn look_enclosed(&self, camera: Point, aim: Point) -> Option<Seen> {
        let camera_above = (camera.z - self.surface_z).sign()? > 0;
        let ray = aim - camera;
        let towards = (self.surface_z - camera.z) / ray.z;
        let hit = camera + ray * towards;
        let squared = plan_squared(ray.x, ray.y);
        let length_squared = squared + ray.z.squared();
        let length = length_squared.sqrt();
        let (n1, n2) = (self.index_on(camera_above), self.index_on(!camera_above));
        let (cosine, sine_squared) = (ray.z.abs() / length, squared / length_squared);
        let depth = (self.receiver_z - self.surface_z).abs();
        let q1 = n1 * cosine;
        let q2_squared = n2.squared() - n1.squared() * sine_squared;
        let mut arrives = Lit::where_positive(towards);
        // Plan distance behind the surface per length of the ray in plan.
        let (weight, transmittance, shift);
        if camera_above == self.receiver_above {
            weight = self.reflected(n1, cosine, sine_squared);
            transmittance = Enclosure::ONE - weight;
            shift = depth / ray.z.abs();
        } else {
            let q2 = q2_squared.sqrt();
            arrives = arrives.and(Lit::where_positive(q2_squared));
            transmittance = transmittance_enclosed(n1, q1, n2, q2);
            weight = transmittance * (n1 / n2).squared();
            shift = depth * n1 / (length * q2);
        }
        Some(Seen {
            weight,
            transmittance: Some(transmittance),
            at: vec3(
                hit.x + ray.x * shift,
                hit.y + ray.y * shift,
                self.receiver_z,
            ),
            arrives,
        })
    }
}
