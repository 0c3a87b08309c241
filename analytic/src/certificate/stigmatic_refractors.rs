//! Glass that brings all light to one point: an ellipsoid in a beam, a Cartesian oval. Explicit. Theory block J.
//!
//! On the oval r1 + n r2 = C at the angle t, (C - n r)² - (r² + d² - 2 r d cos t) is a parabola in r that opens upward and is
//! negative at r = C/n, where r1 = 0: one of its zeros is below and has r1 > 0, the other is not on the oval.

use crate::certificate::Lit;
use crate::certificate::radiometry::{Bundle, Point, plan_squared, transmittance_enclosed};
use crate::certificate::source::Source;
use crate::enclosure::Enclosure;
use crate::scalar::Scalar;

/// A stigmatic refractor, its receiver at z = -δ in the glass.
#[derive(Clone, Copy, Debug)]
pub struct StigmaticRefractor {
    index: Enclosure,
    front: Front,
    defocus: Enclosure,
}

#[derive(Clone, Copy, Debug)]
enum Front {
    /// Semi-major axis a, beam E0.
    Ellipsoid(Enclosure, Enclosure),
    /// Light height d, optical length C, intensity I.
    Oval(Enclosure, Enclosure, Enclosure),
}

impl StigmaticRefractor {
    /// `n`, `delta` and `a`, `E0` or `D`, `C`, `I`.
    pub fn read(p: &dyn Source) -> Option<Self> {
        Some(StigmaticRefractor {
            index: p.number("n")?,
            front: if p.has("a") {
                Front::Ellipsoid(p.number("a")?, p.number("E0")?)
            } else {
                Front::Oval(p.number("D")?, p.number("C")?, p.number("I")?)
            },
            defocus: p.number("delta")?,
        })
    }

    /// Height of the receiver.
    pub fn receiver_z(&self) -> Enclosure {
        -self.defocus
    }

    /// The refracted light at (x, y).
    pub fn caustic_enclosed(&self, x: Point) -> Bundle {
        let (n, one, two) = (self.index, Enclosure::ONE, Enclosure::TWO);
        let g = self.defocus.abs();
        let squared = plan_squared(x.x, x.y) + g.squared();
        let distance = squared.sqrt();
        let cosine = g / distance;
        // κ: cosine between the ray in the air and the ray in the glass.
        let (r2, kappa, strength);
        match self.front {
            Front::Ellipsoid(a, e0) => {
                let e = one / n;
                r2 = a * (one - e.squared()) / (one - e * cosine);
                kappa = cosine;
                strength = e0 * r2.squared();
            }
            Front::Oval(d, c, intensity) => {
                let b = n * c - d * cosine;
                let rest = (c - d) * (c + d);
                let root = (b.squared() - (n - one) * (n + one) * rest).sqrt();
                r2 = rest / (b + root);
                let r1 = c - n * r2;
                kappa = (d * cosine - r2) / r1;
                strength = intensity * (r2 / r1).squared();
            }
        }
        // The normal is along (ray in) - n (ray out), of length M: cos i1 = (nκ - 1)/M, cos i2 = (n - κ)/M.
        let long = (n.squared() + one - two * n * kappa).sqrt();
        let (entering, leaving) = ((n * kappa - one) / long, (n - kappa) / long);
        let t = transmittance_enclosed(one, entering, n, n * leaving);
        let e = strength * t * entering / leaving * g / (squared * distance);
        let inside = match self.defocus.sign() {
            Some(1) => Lit::Yes,
            Some(_) => Lit::where_positive(r2 - distance),
            None => Lit::Undecided,
        };
        Bundle::single(e, inside.and(Lit::where_positive(entering)))
    }
}
