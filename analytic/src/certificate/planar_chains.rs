//! Chains of plane mirrors: a wedge of angle π/m and a corridor. All images, explicitly. Theory block M.
//!
//! **Wedge.** The images of a light at the polar angle β stand at 2πj/m + β and 2πj/m - β; the former is 2j mirror
//! sectors away, the latter 2j - 1, counted the shorter way round: that is its number of bounces.
//!
//! **Corridor.** Images of k bounces are at least (k - 1)W away from every point between the mirrors, so that the orders
//! after K ≥ 1 add up to at most 2 I h/W³ Σ_{k>K} R^k/(k-1)³ ≤ 2 I h/W³ R^{K+1} · min(1/((1-R)K³), 1/K³ + 1/(2K²)).

use crate::certificate::radiometry::{
    Bundle, Facing, Point, point_light_enclosed, power_enclosed, whole,
};
use crate::certificate::{Certified, Lit, source::Source};
use crate::enclosure::Enclosure;
use crate::scalar::Scalar;
use crate::vector::vec3;

/// The most orders of a corridor that are added up.
const MAX_ORDERS: u32 = 1 << 13;

/// A wedge of angle π/m with its light.
#[derive(Clone, Copy, Debug)]
pub struct Wedge {
    m: u32,
    radius: Enclosure,
    angle: Enclosure,
    height: Enclosure,
    intensity: Enclosure,
    reflectance: Enclosure,
}

impl Wedge {
    /// The wedge of `m`, `light_polar`, `I` and `R`.
    pub fn read(p: &dyn Source) -> Option<Self> {
        let m = p.whole("m").filter(|m| (1..=64).contains(m))?;
        Some(Wedge {
            m,
            radius: p.entry("light_polar", &[0])?,
            angle: p.entry("light_polar", &[1])?,
            height: p.entry("light_polar", &[2])?,
            intensity: p.number("I")?,
            reflectance: p.number("R")?,
        })
    }

    /// The largest number of bounces, m.
    pub fn orders(&self) -> u32 {
        self.m
    }

    fn holds(&self, x: Point) -> Lit {
        let opening = Enclosure::PI / whole(self.m);
        Lit::where_not_negative(x.y).and(Lit::where_not_negative(
            x.x * opening.sin() - x.y * opening.cos(),
        ))
    }

    fn from(&self, angle: Enclosure, x: Point) -> Enclosure {
        let image = vec3(
            self.radius * angle.cos(),
            self.radius * angle.sin(),
            self.height,
        );
        point_light_enclosed(image, self.intensity, x, Facing::Up).0
    }

    /// Light with exactly `bounces` ≥ 1 reflections.
    pub fn caustic_enclosed(&self, x: Point, bounces: u32) -> Bundle {
        let mut bundle = Bundle::default();
        let lit = self.holds(x);
        let weight = power_enclosed(self.reflectance, bounces);
        let turn = Enclosure::TWO * Enclosure::PI / whole(self.m);
        for j in 1..=self.m {
            let (even, odd) = (2 * j, 2 * j - 1);
            let way_round = |sectors: u32| sectors.min(2 * self.m - sectors);
            if j < self.m && way_round(even) == bounces {
                bundle.add(weight * self.from(turn * whole(j) + self.angle, x), lit);
            }
            if way_round(odd) == bounces {
                bundle.add(weight * self.from(turn * whole(j) - self.angle, x), lit);
            }
        }
        bundle
    }

    /// Direct light.
    pub fn direct_enclosed(&self, x: Point) -> Certified {
        let mut sum = Certified::NONE;
        sum.add(self.from(self.angle, x), self.holds(x));
        sum
    }
}

/// A corridor between the mirrors x = 0 and x = W with its light.
#[derive(Clone, Copy, Debug)]
pub struct Corridor {
    width: Enclosure,
    light: Point,
    intensity: Enclosure,
    reflectance: Enclosure,
    orders: u32,
}

impl Corridor {
    /// The corridor of `W`, `light`, `I`, `R` and `orders_listed`.
    pub fn read(p: &dyn Source) -> Option<Self> {
        Some(Corridor {
            width: p.number("W")?,
            light: p.point("light")?,
            intensity: p.number("I")?,
            reflectance: p.number("R")?,
            orders: p.whole("orders_listed").filter(|k| (1..=64).contains(k))?,
        })
    }

    /// The number of orders in the listed sum.
    pub fn orders(&self) -> u32 {
        self.orders
    }

    fn holds(&self, x: Point) -> Lit {
        Lit::where_not_negative(x.x).and(Lit::where_not_negative(self.width - x.x))
    }

    fn from(&self, image_x: Enclosure, x: Point) -> Enclosure {
        let image = vec3(image_x, self.light.y, self.light.z);
        point_light_enclosed(image, self.intensity, x, Facing::Up).0
    }

    /// Light with exactly `bounces` ≥ 1 reflections.
    pub fn caustic_enclosed(&self, x: Point, bounces: u32) -> Bundle {
        let (lit, weight) = (self.holds(x), power_enclosed(self.reflectance, bounces));
        let mut bundle = Bundle::default();
        for e in self.images(x, bounces) {
            bundle.add(weight * e, lit);
        }
        bundle
    }

    /// The two images of `bounces` reflections, unweighted: 2jW + x_l for |2j| bounces, 2jW - x_l for |2j - 1|.
    fn images(&self, x: Point, bounces: u32) -> [Enclosure; 2] {
        let (k, one) = (whole(bounces), Enclosure::ONE);
        let (w, l) = (self.width, self.light.x);
        if bounces.is_multiple_of(2) {
            [self.from(k * w + l, x), self.from(l - k * w, x)]
        } else {
            [
                self.from((k + one) * w - l, x),
                self.from((one - k) * w - l, x),
            ]
        }
    }

    /// Light with any number of reflections from 1 on.
    pub fn all_orders_enclosed(&self, x: Point) -> Certified {
        let lit = self.holds(x);
        let mut sum = Enclosure::ZERO;
        let mut weight = self.reflectance;
        let mut tail = Enclosure::ENTIRE;
        let mut last = 0;
        while last < MAX_ORDERS && !(tail.high() <= 1e-18 * sum.low()) {
            last += 1;
            let [a, b] = self.images(x, last);
            sum += weight * (a + b);
            weight = weight * self.reflectance;
            tail = self.tail(last, weight);
        }
        let mut out = Certified::NONE;
        out.add(sum + tail.hull(Enclosure::ZERO), lit);
        out.roots *= 2 * last;
        out
    }

    /// Upper bound of all orders after `last`, of which the first has the weight `weight`.
    fn tail(&self, last: u32, weight: Enclosure) -> Enclosure {
        let k = whole(last);
        let cube = k.squared() * k;
        let geometric = Enclosure::ONE / ((Enclosure::ONE - self.reflectance) * cube);
        let harmonic = Enclosure::ONE / cube + Enclosure::HALF / k.squared();
        let few = if self.reflectance.high() < 1.0 {
            geometric.min(harmonic)
        } else {
            harmonic
        };
        let scale =
            Enclosure::TWO * self.intensity * self.light.z / (self.width.squared() * self.width);
        scale * weight * few
    }

    /// Direct light.
    pub fn direct_enclosed(&self, x: Point) -> Certified {
        let mut sum = Certified::NONE;
        sum.add(self.from(self.light.x, x), self.holds(x));
        sum
    }
}
