//! Pixels that a fold crosses, against a count and an energy that are found in other ways: the nephroid as a curve drawn point
//! by point, a pinhole of this file's own, and light that is traced.

use libm::{atan2, cos, hypot, sin, tan};
use nephroid::entry;
use nephroid::film::Film;
use nephroid::integrators::{Integrator, Plan, Prepared, Settings, by_name};
use nephroid::judge::evidence::moments;
use nephroid::judge::finding::State;
use nephroid::verify::effort::Effort;
use nephroid::verify::excluded::{Kept, crossed_by_folds};
use nephroid::verify::expected::Truths;
use nephroid::verify::run::{Request, run};
use nephroid::verify::suite::{Coverage, Subject};
use nephroid::verify::verdicts::Verdict;
use nephroid_analytic::scene::{Entry, Kind};

/// Light tracing that says its variance is infinite at folds.
struct Spiky(Box<dyn Integrator>);

impl Integrator for Spiky {
    fn name(&self) -> &'static str {
        "spiky"
    }

    fn title(&self) -> &'static str {
        self.0.title()
    }

    fn plan(&self, entry: &Entry) -> Plan {
        self.0.plan(entry)
    }

    fn has_infinite_variance_at_folds(&self) -> bool {
        true
    }

    fn prepare(&self, entry: &Entry) -> Box<dyn Prepared> {
        self.0.prepare(entry)
    }
}

fn light_tracing() -> Box<dyn Integrator> {
    by_name("lt", &Settings::default()).unwrap()
}

type V = [f64; 3];

fn minus(a: V, b: V) -> V {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: V, b: V) -> V {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn unit(a: V) -> V {
    let length = (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]).sqrt();
    a.map(|x| x / length)
}

/// Where the ray through a film point meets the plane of the floor, after a reflection at the inner side of the cup's wall if it
/// meets that before, which is told as well.
fn floor_point(entry: &Entry, u: f64, v: f64) -> ([f64; 2], bool) {
    let c = &entry.camera;
    let forward = unit(minus(c.look_at, c.position));
    let right = unit(cross(forward, [0.0, 0.0, 1.0]));
    let up = cross(right, forward);
    let half = tan(0.5 * c.field_of_view_degrees.to_radians());
    let (w, h) = (f64::from(c.width), f64::from(c.height));
    let (x, y) = ((2.0 * u - w) / h * half, (h - 2.0 * v) / h * half);
    let d: V = core::array::from_fn(|k| forward[k] + x * right[k] + y * up[k]);
    let mut floor = -c.position[2] / d[2];
    let at = |t: f64| [0, 1, 2].map(|k| c.position[k] + t * d[k]);
    let Kind::CylinderCup(cup) = &entry.kind else {
        return ([at(floor)[0], at(floor)[1]], false);
    };
    // Where the ray leaves the circle, if that is on the wall and above the floor.
    let (radius, half_arc) = (cup.wall.radius, cup.wall.half_arc_degrees.to_radians());
    let (a, b) = (
        d[0] * d[0] + d[1] * d[1],
        c.position[0] * d[0] + c.position[1] * d[1],
    );
    let e = c.position[0] * c.position[0] + c.position[1] * c.position[1] - radius * radius;
    let leaves = ((b * b - a * e).sqrt() - b) / a;
    let p = at(leaves);
    let on_wall = p[2] >= 0.0 && p[2] <= cup.wall.height && atan2(p[1], p[0]).abs() <= half_arc;
    if !on_wall {
        return ([at(floor)[0], at(floor)[1]], false);
    }
    let outward = (p[0] * d[0] + p[1] * d[1]) / (radius * radius);
    let reflected = [d[0] - 2.0 * outward * p[0], d[1] - 2.0 * outward * p[1]];
    floor = -p[2] / d[2];
    (
        [p[0] + floor * reflected[0], p[1] + floor * reflected[1]],
        true,
    )
}

/// The fold of one reflection of parallel light in an arc of a circle: each ray touches it half-way down its chord's half,
/// cos φ radius/2 behind the wall (`theory/scenes.md`, G).
fn nephroid(radius: f64, half_arc: f64) -> Vec<[f64; 2]> {
    const POINTS: i32 = 1000;
    (-POINTS..=POINTS)
        .map(|k| {
            let phi = half_arc * f64::from(k) / f64::from(POINTS);
            let (back, along) = (2.0 * phi + core::f64::consts::PI, 0.5 * radius * cos(phi));
            [
                radius * cos(phi) + along * cos(back),
                radius * sin(phi) + along * sin(back),
            ]
        })
        .collect()
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    hypot(a[0] - b[0], a[1] - b[1])
}

/// Per pixel by how much the fold is nearer than the farthest corner, as a part of that.
fn nearness(entry: &Entry) -> Vec<f64> {
    let Kind::CylinderCup(cup) = &entry.kind else {
        panic!("a cup");
    };
    let fold = nephroid(cup.wall.radius, cup.wall.half_arc_degrees.to_radians());
    let camera = &entry.camera;
    (0..camera.width * camera.height)
        .map(|k| {
            let (i, j) = (f64::from(k % camera.width), f64::from(k / camera.width));
            let (center, via) = floor_point(entry, i + 0.5, j + 0.5);
            let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)]
                .map(|(a, b)| floor_point(entry, i + a, j + b));
            if corners.iter().any(|c| c.1 != via) {
                // A pixel on the wall's border: not for this count.
                return f64::NAN;
            }
            let reach = corners.map(|c| distance(center, c.0));
            let reach = reach.into_iter().fold(0.0, f64::max);
            let square = |p: &[f64; 2]| {
                let [x, y] = [p[0] - center[0], p[1] - center[1]];
                x * x + y * y
            };
            let nearest = fold.iter().map(square).fold(f64::INFINITY, f64::min);
            1.0 - nearest.sqrt() / reach
        })
        .collect()
}

#[test]
fn the_crossed_pixels_of_the_cup_are_those_along_the_nephroid() {
    let entry = entry::load("cup").unwrap();
    let crossed = crossed_by_folds(&entry);
    let near = nearness(&entry);
    let (mut doubtful, mut borders) = (0, 0);
    for (k, (crossed, near)) in crossed.iter().zip(&near).enumerate() {
        // The curve is drawn to 1e-3 of a pixel.
        if near.abs() < 1e-3 {
            doubtful += 1;
        } else if near.is_nan() {
            borders += usize::from(*crossed);
        } else {
            assert_eq!(*crossed, *near > 0.0, "pixel {k}: {near}");
        }
    }
    // As many as a curve of that length crosses of pixels of that size.
    let count = crossed.iter().filter(|c| **c).count();
    assert!(count > 50 && doubtful < 5, "{count} {doubtful}");
    // The upper border of the wall is a row or two of pixels, of which a point is far from the next one.
    assert!(borders <= 2 * entry.camera.width as usize, "{borders}");
    println!("{count} pixels, of which {borders} on the wall's border");
    // A floor without a fold loses nothing.
    let floor = entry::load("floor").unwrap();
    assert!(!crossed_by_folds(&floor).contains(&true));
}

#[test]
fn a_mask_and_folds_leave_what_both_leave() {
    let entry = entry::load("cup").unwrap();
    let crossed = crossed_by_folds(&entry);
    let selected: Vec<bool> = (0..crossed.len()).map(|k| k % 3 == 0).collect();
    let kept = Kept::of(&entry, Some(&selected)).unwrap();
    let count = |f: &dyn Fn(usize) -> bool| (0..crossed.len()).filter(|&k| f(k)).count() as u64;
    assert_eq!(kept.pixels, count(&|k| selected[k] && crossed[k]));
    assert_eq!(
        kept.regions.pixels(),
        [count(&|k| selected[k] && !crossed[k])]
    );
    assert_eq!(kept.all.pixels(), [count(&|k| selected[k])]);
    // Where folds are everywhere nothing is left.
    assert!(Kept::of(&entry, Some(&crossed)).is_none());
}

/// The energy that is left out against traced light: 32 replicates give it to about 0.1 %, and seven standard errors of their mean
/// are exceeded with probability 1e-7 (t with 31 degrees of freedom). Would catch the energy of the kept pixels in place of the
/// others', a mean in place of a sum, or a class that is forgotten.
#[test]
fn a_verdict_tells_the_energy_that_is_left_out() {
    let entry = entry::load("cup").unwrap();
    let near = nearness(&entry);
    let request = Request {
        scenes: vec![Subject {
            argument: "cup".to_owned(),
            entry: entry.clone(),
        }],
        integrators: vec![Box::new(Spiky(light_tracing()))],
        left_out: Vec::new(),
        effort: Effort::Quick,
        coverage: Coverage::Everything,
        margin: 0.05,
        level: 1e-6,
        checks: None,
        seed: 3,
        bandwidth: 0.2,
        most_paths: Effort::Quick.most_paths(),
        variations: false,
        kernel: None,
        mask: None,
    };
    let outcome = run(&request, &mut Truths::for_margin(0.05), &|_, _, _, _| {}).unwrap();
    let judged = |class: &str| {
        let of = |v: &&Verdict| v.class == class;
        outcome.verdicts.iter().find(of).unwrap()
    };
    for class in ["LDE", "LSDE", "all"] {
        let v = judged(class);
        assert_eq!(v.finding.state, State::Equivalent, "{:?}", v.finding);
        assert_eq!(v.region, "image");
    }
    let excluded = judged("all").excluded.unwrap();
    // What the wall's border sees is not counted here: its pixels are taken as they are.
    let crossed = crossed_by_folds(&entry);
    let near: Vec<f64> = near
        .iter()
        .zip(&crossed)
        .map(|(n, c)| {
            if n.is_nan() {
                f64::from(u8::from(*c))
            } else {
                *n
            }
        })
        .collect();
    let along = near.iter().filter(|n| **n > 0.0).count() as i64;
    assert!((excluded.pixels as i64 - along).abs() < 5);

    let prepared = light_tracing().prepare(&entry);
    let parts: Vec<f64> = (0..32)
        .map(|seed| {
            let mut film = Film::new(128, 128, entry.kind.classes());
            prepared.iterate(1000 + seed, 0, 100_000, 0.0, &mut film);
            let (mut left_out, mut all) = (0.0, 0.0);
            for layer in &film.layers {
                for (v, n) in layer.iter().zip(&near) {
                    all += v;
                    left_out += if *n > 0.0 { *v } else { 0.0 };
                }
            }
            left_out / all
        })
        .collect();
    let (part, variance) = moments(&parts);
    let error = (variance / 32.0).sqrt();
    assert!(error < 0.005 * part, "{error} of {part}");
    assert!(
        (excluded.energy - part).abs() < 7.0 * error,
        "{} {part} ± {error}",
        excluded.energy
    );
}
