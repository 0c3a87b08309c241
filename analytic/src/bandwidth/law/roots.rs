//! Perfect paths of a family, and the nearest approaches where there is none.

use super::family::{Map, Sample};
use super::jet::dot;

/// What a search over the parameters finds.
#[derive(Clone, Debug, Default)]
pub(super) struct Found {
    /// Parameters of perfect paths at which the map is regular.
    pub regular: Vec<[f64; 2]>,
    /// Those at which it is not.
    pub degenerate: Vec<[f64; 2]>,
    /// Offsets of existing paths that are nearest to perfect within their surroundings: the bandwidth at which a part of the support
    /// without a root begins.
    pub approaches: Vec<([f64; 2], f64)>,
    /// Whether every path is perfect.
    pub stigmatic: bool,
}

/// An offset below this, in natural units, is none.
const TINY: f64 = 1e-11;
/// Newton's steps.
const STEPS: usize = 60;
/// Singular values below this ratio belong to a fold.
const FLAT: f64 = 1e-4;
/// Roots nearer than this part of the domain are one.
const SAME: f64 = 1e-6;

/// Width of the domain along both axes.
pub(super) fn size(map: &Map<'_>) -> [f64; 2] {
    map.domain().map(|[low, high]| high - low)
}

/// A look at `cells`² parameters, each local minimum of the offset followed down. `unit`: the natural size of an offset.
pub(super) fn find(map: &Map<'_>, cells: usize, unit: f64) -> Found {
    let (domain, size) = (map.domain(), size(map));
    let node = |k: usize, l: usize| [k, l].map(|i| (i as f64 + 0.5) / cells as f64);
    let place = |t: [f64; 2]| [0, 1].map(|i| domain[i][0] + t[i] * size[i]);
    let mut levels = vec![f64::INFINITY; cells * cells];
    for l in 0..cells {
        for k in 0..cells {
            let s = map.at(place(node(k, l)));
            if s.exists() {
                levels[l * cells + k] = s.square();
            }
        }
    }
    let mut found = Found::default();
    let tiny = TINY * unit;
    let existing = levels.iter().filter(|v| v.is_finite());
    if existing.clone().count() > 4 && existing.clone().all(|v| *v < tiny * tiny) {
        found.stigmatic = true;
        return found;
    }
    for l in 0..cells {
        for k in 0..cells {
            let here = levels[l * cells + k];
            let lowest = here.is_finite()
                && (l.saturating_sub(1)..(l + 2).min(cells)).all(|b| {
                    (k.saturating_sub(1)..(k + 2).min(cells)).all(|a| here <= levels[b * cells + a])
                });
            if lowest {
                follow(
                    map,
                    place(node(k, l)),
                    Some(0.5 / cells as f64),
                    size,
                    unit,
                    &mut found,
                );
            }
        }
    }
    // Roots that share a valley: from everywhere.
    let coarse = cells / 2;
    for k in 0..coarse * coarse {
        let t = [k % coarse, k / coarse].map(|i| (i as f64 + 0.5) / coarse as f64);
        if map.at(place(t)).exists() {
            follow(map, place(t), None, size, unit, &mut found);
        }
    }
    found.approaches.sort_by(|a, b| a.1.total_cmp(&b.1));
    found
}

fn is_new(list: &[[f64; 2]], u: [f64; 2], size: [f64; 2]) -> bool {
    list.iter()
        .all(|r| (0..2).any(|k| f64::abs(r[k] - u[k]) > SAME * size[k]))
}

/// Follows a start down; a nearest approach counts if `descends`.
fn follow(
    map: &Map<'_>,
    start: [f64; 2],
    step: Option<f64>,
    size: [f64; 2],
    unit: f64,
    found: &mut Found,
) {
    let tiny = TINY * unit;
    let (end, level) = newton(map, start, size);
    if level < tiny * tiny && record(map, end, size, found) {
        return;
    }
    let Some(step) = step else { return };
    let (u, distance) = descend(map, start, step, size);
    let (end, level) = newton(map, u, size);
    if distance < 1e-3 * unit && level < tiny * tiny && record(map, end, size, found) {
        return;
    }
    // A fold is approached slowly.
    let [a, b] = singular_values(map, u, size);
    if distance < 1e-3 * unit && b < 0.1 * a {
        note(&mut found.degenerate, u, size);
    }
    if distance > tiny {
        found.approaches.push((u, distance));
    }
}

/// Adds a root from a start, if it is new and regular.
pub(super) fn complete(map: &Map<'_>, start: [f64; 2], unit: f64, found: &mut Found) {
    let size = size(map);
    let (u, level) = newton(map, start, size);
    if level < TINY * unit * TINY * unit {
        record(map, u, size, found);
    }
}

/// Degenerate roots that are apart.
fn note(degenerate: &mut Vec<[f64; 2]>, u: [f64; 2], size: [f64; 2]) {
    let apart = degenerate
        .iter()
        .all(|r| (0..2).any(|k| f64::abs(r[k] - u[k]) > 1e-2 * size[k]));
    if apart {
        degenerate.push(u);
    }
}

/// Takes down a root that exists; whether there is one.
fn record(map: &Map<'_>, u: [f64; 2], size: [f64; 2], found: &mut Found) -> bool {
    // On a border to within rounding is on it.
    if !(map.at(u).margins.iter().all(|m| *m >= -1e-10)) {
        return false;
    }
    let [a, b] = singular_values(map, u, size);
    if b < FLAT * a {
        note(&mut found.degenerate, u, size);
    } else if is_new(&found.regular, u, size) {
        found.regular.push(u);
    }
    true
}

fn gradient(map: &Map<'_>, u: [f64; 2], size: [f64; 2]) -> [[f64; 3]; 2] {
    const H: f64 = 1e-6;
    [0, 1].map(|k| {
        let (mut low, mut high) = (u, u);
        low[k] -= H * size[k];
        high[k] += H * size[k];
        let (a, b) = (map.at(low).offset, map.at(high).offset);
        core::array::from_fn(|c| (b[c] - a[c]) / (2.0 * H))
    })
}

/// The larger and the smaller singular value of the map, per width of the domain.
fn singular_values(map: &Map<'_>, u: [f64; 2], size: [f64; 2]) -> [f64; 2] {
    let [p, q] = gradient(map, u, size);
    let (a, b, c) = (dot(&p, &p), dot(&p, &q), dot(&q, &q));
    let (mean, gap) = (0.5 * (a + c), libm::hypot(0.5 * (a - c), b));
    [mean + gap, (mean - gap).max(0.0)].map(libm::sqrt)
}

/// Levenberg's damped steps towards a root: where they end, and the squared offset there.
fn newton(map: &Map<'_>, start: [f64; 2], size: [f64; 2]) -> ([f64; 2], f64) {
    let mut u = start;
    let mut level = map.at(u).square();
    let mut damping = 1e-10;
    for _ in 0..STEPS {
        if !level.is_finite() {
            break;
        }
        let d = map.at(u).offset;
        let j = gradient(map, u, size);
        let (a, b, c) = (dot(&j[0], &j[0]), dot(&j[0], &j[1]), dot(&j[1], &j[1]));
        let g = [dot(&j[0], &d), dot(&j[1], &d)];
        let lambda = damping * (a + c);
        let det = (a + lambda) * (c + lambda) - b * b;
        let step = [
            (b * g[1] - (c + lambda) * g[0]) / det,
            (b * g[0] - (a + lambda) * g[1]) / det,
        ];
        let next = [0, 1].map(|k| u[k] + step[k].clamp(-0.2, 0.2) * size[k]);
        let lower = map.at(next).square();
        if lower < level {
            (u, level) = (next, lower);
            damping = (damping * 0.1).max(1e-14);
        } else {
            damping *= 100.0;
        }
        if damping > 1e8 {
            break;
        }
    }
    (u, level)
}

/// Directions of a look around.
const AROUND: u32 = 12;

/// The nearest existing path to a perfect one around a start: a look into twelve directions, turned by the golden angle each time, with
/// steps that halve where none is better.
fn descend(map: &Map<'_>, start: [f64; 2], step: f64, size: [f64; 2]) -> ([f64; 2], f64) {
    let (mut u, mut best) = (start, map.at(start).square());
    let (mut step, mut turn) = (step, 0.0);
    let domain = map.domain();
    for _ in 0..600 {
        turn += 2.399_963_229_728_653;
        let mut next = None;
        for k in 0..AROUND {
            let (s, c) =
                libm::sincos(turn + core::f64::consts::TAU * f64::from(k) / f64::from(AROUND));
            let e = [c, s];
            // On the border of the rectangle it slides.
            let v =
                [0, 1].map(|k| (u[k] + step * e[k] * size[k]).clamp(domain[k][0], domain[k][1]));
            let sample: Sample = map.at(v);
            if sample.exists() && sample.square() < best {
                (next, best) = (Some(v), sample.square());
            }
        }
        match next {
            Some(v) => u = v,
            None => step *= 0.6,
        }
        if step < 1e-12 {
            break;
        }
    }
    (u, libm::sqrt(best))
}
