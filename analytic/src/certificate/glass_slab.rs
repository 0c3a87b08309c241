//! A glass slab between a point light and a floor: one ray for each even number of internal reflections. Theory block D.
//!
//! **Tail.** E_k = I T² F^{2k}/(q_a · Σ l_j/q_j · Σ l_j n_j²/q_j³), and the ray parameter p of order k falls as k grows,
//! the glass being passed more often. For all orders after K, F is thus at most its maximum F̄ on [0, p_K], which is
//! enclosed piece by piece; T ≤ 1, q_a ≥ √(1 - p_K²), and both sums are at least l_a + l_g/n for the l_g of order K + 1.
//! The tail is at most the geometric series of F̄².

use crate::certificate::layers::{Layer, LayeredRay};
use crate::certificate::radiometry::{
    Bundle, Point, plan_squared, power_enclosed, reflectance_enclosed, transmittance_enclosed,
    whole,
};
use crate::certificate::scene::Seen;
use crate::certificate::{Certified, Lit, source::Source};
use crate::enclosure::Enclosure;
use crate::scalar::Scalar;
use crate::vector::vec3;

/// The most orders that are added up.
const MAX_ORDERS: u32 = 400;

/// Pieces in which the largest reflectance of the tail is sought.
const PIECES: u32 = 32;

/// A slab in air with its light above and its receiver below, which faces up.
#[derive(Clone, Copy, Debug)]
pub struct GlassSlab {
    bottom: Enclosure,
    top: Enclosure,
    index: Enclosure,
    light: Point,
    intensity: Enclosure,
    receiver_z: Enclosure,
    orders: u32,
}

impl GlassSlab {
    /// `slab_z`, `n`, `light`, `I` and, where they are not 0 and 5, `Z` and `orders_listed`.
    pub fn read(p: &dyn Source) -> Option<Self> {
        Some(GlassSlab {
            bottom: p.entry("slab_z", &[0])?,
            top: p.entry("slab_z", &[1])?,
            index: p.number("n")?,
            light: p.point("light")?,
            intensity: p.number("I")?,
            receiver_z: p.number("Z").unwrap_or(Enclosure::ZERO),
            orders: p.whole("orders_listed").unwrap_or(5).min(64),
        })
    }

    /// The number of orders in the listed sum.
    pub fn orders(&self) -> u32 {
        self.orders
    }

    /// Air of both gaps and glass of an order.
    fn layers(&self, order: u32) -> [Layer; 2] {
        [
            Layer {
                thickness: (self.light.z - self.top) + (self.bottom - self.receiver_z),
                index: Enclosure::ONE,
            },
            Layer {
                thickness: whole(2 * order + 1) * (self.top - self.bottom),
                index: self.index,
            },
        ]
    }

    fn ray(&self, x: Point, order: u32) -> Option<LayeredRay> {
        let plan = plan_squared(x.x - self.light.x, x.y - self.light.y).sqrt();
        LayeredRay::through(self.layers(order), plan)
    }

    fn irradiance(&self, ray: &LayeredRay, order: u32) -> Enclosure {
        let (layers, n, [q_a, q_g]) = (self.layers(order), self.index, ray.q);
        let one = Enclosure::ONE;
        let t = transmittance_enclosed(one, q_a, n, q_g);
        let f = reflectance_enclosed(one, q_a, n, q_g);
        let weight = t.squared() * power_enclosed(f, 2 * order);
        self.intensity * weight / (q_a * ray.sagittal(layers) * ray.tangential(layers))
    }

    /// Light with 2·`order` internal reflections.
    pub fn caustic_enclosed(&self, x: Point, order: u32) -> Bundle {
        match self.ray(x, order) {
            Some(ray) => Bundle::single(self.irradiance(&ray, order), Lit::Yes),
            None => Bundle::single(Enclosure::new(0.0, f64::INFINITY), Lit::Undecided),
        }
    }

    /// Light of all orders from `first` on.
    pub fn orders_from_enclosed(&self, x: Point, first: u32) -> Certified {
        let mut sum = Certified::NONE;
        for order in first..first + MAX_ORDERS {
            let Some(ray) = self.ray(x, order) else {
                break;
            };
            sum.add(self.irradiance(&ray, order), Lit::Yes);
            let tail = self.tail(&ray, order);
            if tail.high() <= 1e-17 * sum.value.low() || order + 1 == first + MAX_ORDERS {
                sum.value += tail.hull(Enclosure::ZERO);
                return sum;
            }
        }
        sum.add_unresolved();
        sum
    }

    /// Upper bound of all orders after `order`.
    fn tail(&self, ray: &LayeredRay, order: u32) -> Enclosure {
        let (one, n) = (Enclosure::ONE, self.index);
        let largest = (0..PIECES).fold(0.0, |largest, i| {
            let at = |i: u32| ray.p * (whole(i) / whole(PIECES));
            let p = at(i).hull(at(i + 1));
            let q = |n: Enclosure| (n.squared() - p.squared()).sqrt();
            f64::max(largest, reflectance_enclosed(one, q(one), n, q(n)).high())
        });
        let square = Enclosure::point(largest).squared();
        let [air, glass] = self.layers(order + 1);
        let least = air.thickness + glass.thickness / n;
        let weight = power_enclosed(square, order + 1) / (one - square);
        if largest >= 1.0 {
            return Enclosure::new(0.0, f64::INFINITY);
        }
        self.intensity * weight / ((one - ray.p.squared()).sqrt() * least.squared())
    }

    /// The receiver point that a camera above sees through the slab, without internal reflection.
    pub fn look_enclosed(&self, camera: Point, aim: Point) -> Seen {
        let (ray, n, one) = (aim - camera, self.index, Enclosure::ONE);
        let above = camera.z - self.top;
        let squared = plan_squared(ray.x, ray.y);
        let length_squared = squared + ray.z.squared();
        let length = length_squared.sqrt();
        let q_a = -ray.z / length;
        let q_g_squared = n.squared() - squared / length_squared;
        let q_g = q_g_squared.sqrt();
        // Plan distance per length of the ray in plan: thickness/(length q) in each medium.
        let shift = (above + (self.bottom - self.receiver_z)) / (length * q_a)
            + (self.top - self.bottom) / (length * q_g);
        Seen {
            weight: transmittance_enclosed(one, q_a, n, q_g).squared(),
            transmittance: None,
            at: vec3(
                camera.x + ray.x * shift,
                camera.y + ray.y * shift,
                self.receiver_z,
            ),
            arrives: Lit::where_positive(above)
                .and(Lit::where_positive(-ray.z))
                .and(Lit::where_positive(q_g_squared)),
        }
    }
}
