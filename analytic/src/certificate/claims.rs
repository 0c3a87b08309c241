//! Values at a point, with their names and proofs.

use crate::certificate::Certified;
use crate::certificate::radiometry::Bundle;
use crate::enclosure::Enclosure;

/// A value with its name.
#[derive(Clone, Debug)]
pub struct Claim {
    /// The name.
    pub key: String,
    /// The proof.
    pub certified: Certified,
}

/// All light at a point.
#[derive(Clone, Debug, Default)]
pub struct Light {
    /// Light that meets no specular surface, where the scene defines it.
    pub direct: Option<Certified>,
    /// Each listed path class.
    pub classes: Vec<(String, Bundle)>,
    /// Sums of unbounded series and the like, by name.
    pub further: Vec<(String, Certified)>,
}

impl Light {
    /// The sum of the listed classes.
    pub fn caustic(&self) -> Certified {
        let mut sum = Certified::NONE;
        for (_, bundle) in &self.classes {
            sum.join(bundle.total);
        }
        sum
    }
}

/// Collects claims.
pub(super) struct Claims(pub(super) Vec<Claim>);

impl Claims {
    pub(super) fn add(&mut self, key: &str, certified: Certified) {
        self.0.push(Claim {
            key: key.to_owned(),
            certified,
        });
    }

    /// All light at a point, and what a receiver of which `radiance` is known makes of it.
    pub(super) fn add_light(&mut self, light: &Light, radiance: impl Fn(Certified) -> Certified) {
        let caustic = light.caustic();
        self.add("E_caustic", caustic);
        self.add("L_caustic", radiance(caustic));
        if let Some(direct) = light.direct {
            let mut total = direct;
            total.join(caustic);
            self.add("E_direct", direct);
            self.add("L_total", radiance(total));
        }
        for (key, value) in &light.further {
            self.add(key, *value);
        }
        for (class, bundle) in &light.classes {
            self.add(&format!("paths.{class}.E"), bundle.total);
            self.add_rays(&format!("paths.{class}.roots"), "E", bundle);
        }
    }

    /// The rays in descending order: the n-th largest value is between the n-th largest of all lower and of all upper ends.
    /// Nothing where a ray may be missing.
    pub(super) fn add_rays(&mut self, place: &str, key: &str, bundle: &Bundle) {
        if bundle.total.undecided {
            return;
        }
        let sorted = |end: fn(Enclosure) -> f64| {
            let mut ends: Vec<_> = bundle.rays.iter().map(|(e, _)| end(*e)).collect();
            ends.sort_by(|a, b| b.total_cmp(a));
            ends
        };
        let ends = sorted(Enclosure::low)
            .into_iter()
            .zip(sorted(Enclosure::high));
        for (i, (low, high)) in ends.enumerate() {
            let ray = Certified::of(Enclosure::new(low, high));
            self.add(&format!("{place}.{i}.{key}"), ray);
        }
    }
}
