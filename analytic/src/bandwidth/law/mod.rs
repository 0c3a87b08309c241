//! How the expectation of a biased estimator behaves at small bandwidth: the order of its bias and of its variance with their coefficients.
//!
//! At a floor point and per path class,
//!
//! ```text
//! mean = limit + coefficient α^order + …,      second moment = squared α^(−squared_order) + …
//! ```
//!
//! | place | limit | order | coefficient |
//! | --- | --- | --- | --- |
//! | smooth | E₀ | 2 | a quarter of the Laplacian of weight/Jacobian, times ⟨t²⟩ (`smooth`) |
//! | edge (of the mirror, its shadow, the receiver) | E₀ times the share of directions inside | 1 | `smooth` |
//! | dark | 0 | none: exactly 0 below `reach` (2 under a linked bandwidth, by the foot of a wall) | 0 (`foot`) |
//! | fold, cusp, line focus, point focus | none | −1/2, −2/3, −1, −2 | `singular` |
//!
//! All of it comes from derivatives of the offsets of paths (the chord of the deflection, the way on the floor) at the perfect
//! paths themselves, by differences of nine points: no expectation is computed, and the tests hold both against one another. Where the
//! closed form of the scene is known, the limit must agree with it; else there is no law. Away from a caustic, on either side,
//! the point is smooth or dark, and `reach` says how small a bandwidth must be to see it as such.
//!
//! A kink of the irradiance without a jump does not occur among the kinds' classes, whose light ends at edges. The one in the theory's
//! tables, the critical circle of an inner reflection (order 1/2), is in closed form ([`closed::CriticalCircle`]).

pub mod closed;
mod constants;
pub(in crate::bandwidth) mod family;
mod foot;
mod jet;
mod roots;
mod singular;
mod smooth;

use crate::bandwidth::light::Class;
use constants::Shape;
use family::{Family, Map};
use foot::Foot;
use roots::{Found, complete, find};
use singular::Leading;

use super::{Convention, Kernel, Technique};
use crate::class::PathClass;
use crate::entries::FloorTruth;
use crate::kinds::flat_interface::FlatInterface;
use crate::kinds::sphere_mirror::SphereMirror;
use crate::scene::{Entry, InvalidParameter};

/// What a floor point is to the light of a class.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// A finite irradiance that changes smoothly.
    Smooth,
    /// No light within reach.
    Dark,
    /// The border of a lit region: of the surface's shadow, or of the receiver for what is merged.
    Edge,
    /// On a caustic.
    Fold,
    /// Where two folds meet.
    Cusp,
    /// On a line on which a ring of rays meets.
    LineFocus,
    /// Where all rays meet.
    PointFocus,
}

impl Place {
    /// The word for it.
    pub const fn name(self) -> &'static str {
        match self {
            Place::Smooth => "smooth",
            Place::Dark => "dark",
            Place::Edge => "edge",
            Place::Fold => "fold",
            Place::Cusp => "cusp",
            Place::LineFocus => "line_focus",
            Place::PointFocus => "point_focus",
        }
    }
}

/// The leading terms at a floor point.
#[derive(Clone, Copy, Debug)]
pub struct Law {
    /// The class.
    pub class: PathClass,
    /// What the point is.
    pub place: Place,
    /// Limit of the mean [W/m²]; `None` where it grows without bound.
    pub limit: Option<f64>,
    /// Exponent p of the next term; `None` in the dark, unless the foot of a wall is linked.
    pub order: Option<f64>,
    /// Its coefficient [W/m² per bandwidthᵖ].
    pub coefficient: f64,
    /// Estimated error of the coefficient, from two steps of the differences; 0 where there is none.
    pub error: f64,
    /// d of the second moment's α^(−d).
    pub squared_order: f64,
    /// Its coefficient.
    pub squared: f64,
    /// About the bandwidth at which the support meets something else: an edge or a fold (to first order), or a part of the surface
    /// without a perfect path (exactly, in the dark); 0 on a caustic.
    pub reach: f64,
    /// Number of perfect paths; those on a singularity count as one.
    pub roots: usize,
}

impl Law {
    /// Mean to the orders of the law.
    pub fn mean(&self, bandwidth: f64) -> f64 {
        self.limit.unwrap_or(0.0) + self.bias(bandwidth)
    }

    /// Mean without the limit: the bias, where there is a limit.
    pub fn bias(&self, bandwidth: f64) -> f64 {
        self.order
            .map_or(0.0, |p| self.coefficient * libm::pow(bandwidth, p))
    }

    /// Second moment to leading order.
    pub fn second_moment(&self, bandwidth: f64) -> f64 {
        self.squared * libm::pow(bandwidth, -self.squared_order)
    }

    /// The angle or radius that minimises bias² + variance/n by the law alone: α^(d+2p) = d C/(2 p c² n); `None` where no bandwidth is
    /// best.
    pub fn best(&self, paths: f64) -> Option<f64> {
        let (p, d) = (self.order.filter(|p| *p > 0.0)?, self.squared_order);
        let c = self.coefficient * self.coefficient;
        let alpha = libm::pow(
            d * self.squared / (2.0 * p * c * paths),
            1.0 / (d + 2.0 * p),
        );
        (alpha.is_finite() && alpha > 0.0).then_some(alpha)
    }
}

/// The small-bandwidth laws of an estimator.
#[derive(Clone, Debug)]
pub struct SmallBandwidth {
    pub(in crate::bandwidth) family: Family,
    shape: Shape,
    truth: Option<FloorTruth>,
}

/// Cells of the looks along both axes: the next one where the limit is not that of the closed form.
const LOOKS: [usize; 4] = [16, 32, 64, 128];
/// Relative agreement of the limit with the closed form.
const AGREES: f64 = 1e-6;
/// A point is on a caustic if it is nearer than this, in natural units of the offset.
const ON: f64 = 1e-8;
/// Linked distances below this are those of a foot [m].
const FOOT: f64 = 1e-6;
/// Rings have more degenerate roots than a fold or a cusp.
const RING: usize = 3;

impl SmallBandwidth {
    /// Prepares an estimator; arguments as in [`super::entry::EntryExpectation::new`].
    ///
    /// # Errors
    /// What [`Entry::validate`] and [`super::check`] find; a kind of which the technique has no expectation.
    pub fn new(
        entry: &Entry,
        technique: Technique,
        kernel: Kernel,
        convention: Convention,
        beam_area: f64,
    ) -> Result<Self, InvalidParameter> {
        let family = Family::of_entry(entry, technique, kernel, convention, beam_area)?;
        Ok(Self::of(family, FloorTruth::new(entry)))
    }

    /// The light of a spherical mirror on an unbounded receiver; `None` for parallel light or a kernel that does not fit.
    pub fn of_sphere(
        mirror: &SphereMirror<f64>,
        technique: Technique,
        kernel: Kernel,
    ) -> Option<Self> {
        Some(Self::of(
            Family::of_sphere(mirror, technique, kernel)?,
            None,
        ))
    }

    /// The light refracted by a flat interface onto an unbounded receiver; `None` where it is reflected or a kernel does not fit.
    pub fn of_interface(
        form: &FlatInterface<f64>,
        technique: Technique,
        kernel: Kernel,
    ) -> Option<Self> {
        Some(Self::of(
            Family::of_interface(form, technique, kernel)?,
            None,
        ))
    }

    fn of(family: Family, truth: Option<FloorTruth>) -> Self {
        SmallBandwidth {
            shape: Shape::new(family.kernel, family.technique != Technique::Merge),
            family,
            truth,
        }
    }

    /// The classes, in the order of [`Self::at`].
    pub fn classes(&self) -> Vec<PathClass> {
        self.family.classes.iter().map(|c| c.class).collect()
    }

    /// The law at the floor point (x, y), per class; `None` where the limit found does not agree with the closed form. At the foot of a
    /// wall that stands on the floor a linked distance vanishes and the kernel opens to a half-space: its share of the bias is of
    /// the same order r² and included (`foot`), so that a dark point is of order 2 there; the next order is r³, not r⁴.
    ///
    /// **Accuracy**: smooth coefficients as stated by their error, about 1e-8 relative; of singularities 1e-5.
    pub fn at(&self, x: f64, y: f64) -> Vec<Option<Law>> {
        let light = self.truth.as_ref().map(|t| t.at(x, y)).unwrap_or_default();
        self.family
            .classes
            .iter()
            .map(|class| {
                let truth = light
                    .iter()
                    .find(|t| t.class == class.class && t.is_finite())
                    .map(|t| t.irradiance.value);
                LOOKS
                    .into_iter()
                    .find_map(|cells| self.look(class, [x, y], cells, truth))
            })
            .collect()
    }

    fn look(&self, class: &Class, x: [f64; 2], cells: usize, truth: Option<f64>) -> Option<Law> {
        let mut law = Law {
            class: class.class,
            place: Place::Dark,
            limit: Some(0.0),
            order: None,
            coefficient: 0.0,
            error: 0.0,
            squared_order: 2.0,
            squared: 0.0,
            reach: f64::INFINITY,
            roots: 0,
        };
        // Natural unit of an offset: a radian, or the size of the coordinates.
        let unit = match self.family.technique.bandwidth_is_angle() {
            true => 1.0,
            false => 1.0 + libm::hypot(x[0], x[1]),
        };
        let (mut edge, mut first) = (false, 0.0);
        let mut leading: Option<(Place, Leading)> = None;
        let mut foot = Foot::default();
        for map in &self.family.maps(class, x) {
            if foot::stands(map).ok()? {
                let share = foot::share(map, self.family.kernel);
                (foot.mean, foot.squared) = (foot.mean + share.mean, foot.squared + share.squared);
            }
            let mut found = find(map, cells, unit);
            // At a foot the offset vanishes with the distance, and no path is perfect.
            let off_the_foot = |found: &mut Found| {
                let is_linked = |u: &[f64; 2]| map.linked_distance(*u) > FOOT;
                found.regular.retain(is_linked);
                found.degenerate.retain(is_linked);
                found.approaches.retain(|(u, _)| is_linked(u));
            };
            off_the_foot(&mut found);
            // Roots come in pairs at a fold: the other one is across.
            let mut folds = Vec::new();
            for k in 0..found.regular.len() {
                let u = found.regular[k];
                if let Some((at, fold)) = singular::fold(map, u, &self.shape) {
                    folds.push(fold.distance);
                    let across = [0, 1].map(|i| 2.0 * at[i] - u[i]);
                    complete(map, across, unit, &mut found);
                }
            }
            off_the_foot(&mut found);
            let singular = self.singularity(map, &found, unit);
            // A path that is both perfect and degenerate, and of which more is not known.
            let hidden = |u: &[f64; 2]| libm::sqrt(map.at(*u).square()) <= ON * unit;
            if singular.is_none() && found.degenerate.iter().any(hidden) {
                return None;
            }
            if singular.is_none() {
                let nearest = found.approaches.first().map(|a| a.1);
                let folds = folds.into_iter().filter(|d| *d > ON * unit);
                law.reach = folds.chain(nearest).fold(law.reach, f64::min);
            }
            for u in &found.regular {
                let term = smooth::term(map, *u, &self.shape)?;
                law.limit = law.limit.map(|l| l + term.limit);
                law.coefficient += term.second[0];
                law.error += term.second[1];
                first += term.first;
                law.squared += term.squared;
                law.reach = law.reach.min(term.reach);
                edge |= term.on_edge;
                law.roots += 1;
            }
            if singular.is_some() {
                leading = singular;
                law.roots += 1;
            }
        }
        if let Some((place, leading)) = leading {
            law.place = place;
            law.limit = None;
            law.order = Some(leading.order);
            law.coefficient = leading.coefficient;
            law.error = 0.0;
            law.squared_order = 2.0 - leading.order;
            law.squared = leading.squared;
            // Corrections are relative powers of the bandwidth: nothing that begins somewhere.
            law.reach = 0.0;
            return Some(law);
        }
        if edge {
            // At an edge α is the next term and α² unknown.
            (law.place, law.order) = (Place::Edge, Some(1.0));
            (law.coefficient, law.error) = (first, 0.0);
            return Some(law);
        }
        law.coefficient += foot.mean;
        if law.roots > 0 {
            (law.place, law.order) = (Place::Smooth, Some(2.0));
        } else if foot.mean > 0.0 {
            law.order = Some(2.0);
            (law.squared_order, law.squared) = (-3.0, foot.squared);
        }
        let limit = law.limit?;
        let agrees = truth.is_none_or(|t| f64::abs(limit - t) <= AGREES * t.max(1e-12));
        agrees.then_some(law)
    }

    fn singularity(&self, map: &Map<'_>, found: &Found, unit: f64) -> Option<(Place, Leading)> {
        if found.stigmatic {
            return point(map, &self.shape).map(|l| (Place::PointFocus, l));
        }
        if found.degenerate.len() > RING
            && let Some(line) = singular::line(map, &found.degenerate, &self.shape)
        {
            return Some((Place::LineFocus, line));
        }
        found.degenerate.iter().find_map(|u| {
            let on = |l: &Leading, part: f64| l.distance <= part * unit;
            let cusp = singular::cusp(map, *u, &self.shape).filter(|(_, l)| on(l, 1e-5));
            let fold = singular::fold(map, *u, &self.shape).filter(|(_, l)| on(l, ON));
            match (cusp, fold) {
                (Some((_, l)), _) => Some((Place::Cusp, l)),
                (None, Some((_, l))) => Some((Place::Fold, l)),
                _ => None,
            }
        })
    }
}

/// All paths are perfect: f(0) ∫ w du, by cells of Gauss rules, halved where a margin changes its sign.
fn point(map: &Map<'_>, shape: &Shape) -> Option<Leading> {
    let domain = map.domain();
    let rule = crate::quadrature::gauss_legendre(8);
    let mut sum = [0.0; 2];
    let mut cells = vec![(domain, 0)];
    while let Some((cell, depth)) = cells.pop() {
        let half = cell.map(|[low, high]| 0.5 * (high - low));
        let (mut part, mut inside) = ([0.0; 2], 0);
        for (x, wx) in &rule {
            for (y, wy) in &rule {
                let u = [
                    cell[0][0] + half[0] * (1.0 + x),
                    cell[1][0] + half[1] * (1.0 + y),
                ];
                let s = map.at(u);
                if s.exists() {
                    inside += 1;
                    for (part, w) in part.iter_mut().zip(s.density) {
                        *part += wx * wy * half[0] * half[1] * w;
                    }
                }
            }
        }
        let all = rule.len() * rule.len();
        if (0 < inside && inside < all && depth < 9) || depth < 2 {
            let middle = cell.map(|[low, high]| 0.5 * (low + high));
            for k in 0..4 {
                let side = |axis: usize, high: bool| {
                    if high {
                        [middle[axis], cell[axis][1]]
                    } else {
                        [cell[axis][0], middle[axis]]
                    }
                };
                cells.push(([side(0, k & 1 != 0), side(1, k & 2 != 0)], depth + 1));
            }
        } else {
            sum = [sum[0] + part[0], sum[1] + part[1]];
        }
    }
    let top = shape.top();
    (sum[0] > 0.0).then_some(Leading {
        order: -2.0,
        coefficient: sum[0] * top,
        squared: sum[1] * top * top,
        distance: 0.0,
    })
}

/// The coefficient c of α^p in a mean L + c α^p + O(α^(p+2)) from its values at α, α/2 and α/4, whatever L: Richardson's
/// extrapolation, the second route to what [`SmallBandwidth`] derives.
pub fn extrapolated(mut mean: impl FnMut(f64) -> f64, bandwidth: f64, order: f64) -> f64 {
    let [a, b, c] = [1.0, 0.5, 0.25].map(|s| mean(s * bandwidth));
    let part = |d: f64, at: f64| d / (libm::pow(at, order) - libm::pow(0.5 * at, order));
    let (coarse, fine) = (part(a - b, bandwidth), part(b - c, 0.5 * bandwidth));
    // The next term is α² smaller.
    (4.0 * fine - coarse) / 3.0
}
