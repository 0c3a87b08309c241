//! The certificates of a point light in a circular wall against the closed form: any number of bounces, points inside and
//! outside the circle, walls over an arc, closed walls, lights inside and on the wall.

use std::collections::BTreeMap;

use nephroid_analytic::certificate::cylinder_cup::CylinderCup as Certificate;
use nephroid_analytic::certificate::source::Source;
use nephroid_analytic::enclosure::Enclosure;
use nephroid_analytic::kinds::cylinder_cup::point_light::Lamp;
use nephroid_analytic::kinds::cylinder_cup::{CylinderCup, Light, Wall};
use nephroid_analytic::scalar::Scalar;
use nephroid_analytic::vector::vec3;

/// Words and doubles under names; a double is written with all its digits.
struct Named(BTreeMap<&'static str, Vec<String>>);

impl Source for Named {
    fn text(&self, key: &str, indices: &[usize]) -> Option<String> {
        let index = indices.first().copied().unwrap_or(0);
        self.0.get(key)?.get(index).cloned()
    }
}

/// Evenly spread numbers in [-1, 1].
struct Spread(u64);

impl Spread {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z >> 11) as f64 / 4_503_599_627_370_496.0 - 1.0
    }
}

#[derive(Debug, Default)]
struct Tally {
    proven: u32,
    undecided: u32,
    lit: u32,
    outside_lit: u32,
    widest: f64,
}

fn compare(form: &CylinderCup<f64>, on_wall: bool, spread: &mut Spread, tally: &mut Tally) {
    let Light::Point(lamp) = form.light else {
        panic!("another light")
    };
    let mut named = BTreeMap::new();
    let mut set = |key, values: &[f64]| {
        named.insert(key, values.iter().map(f64::to_string).collect::<Vec<_>>());
    };
    set("a", &[form.wall.radius]);
    set("R", &[form.reflectance]);
    set("light", &[lamp.x, lamp.y, lamp.height]);
    set("I", &[lamp.intensity]);
    set("max_bounces", &[4.0]);
    if let Some(end) = form.wall.cos_half_arc {
        set("cos_half_arc", &[end]);
    }
    if let Some(height) = form.wall.height {
        set("wall_height", &[height]);
    }
    let mut word = |key, word: &str| named.insert(key, vec![word.to_owned()]);
    word(
        "wall",
        if form.wall.cos_half_arc.is_some() {
            "arc"
        } else {
            "full"
        },
    );
    if form.wall.height.is_none() {
        word("wall_height", "unbounded");
    }
    if on_wall {
        word("light_on_wall", "yes");
    }
    let proof = Certificate::read(&Named(named)).expect("a cup");
    for _ in 0..12 {
        let (x, y) = (1.9 * spread.next(), 1.9 * spread.next());
        let at = vec3(Enclosure::point(x), Enclosure::point(y), Enclosure::ZERO);
        let mut pairs = vec![(form.direct(x, y), proof.direct_enclosed(at), 0)];
        for k in 1..=4 {
            pairs.push((
                form.caustic(x, y, k),
                proof.caustic_enclosed(at, k).total,
                k,
            ));
        }
        for (value, certified, k) in pairs {
            let (low, high) = (value.value - value.error, value.value + value.error);
            let place = format!("{form:?} ({x}, {y}) {k} bounces: {value:?} {certified:?}");
            // A light on the wall is there to within rounding only.
            let room = if on_wall { 1e-12 * value.value } else { 0.0 };
            assert!(low - room <= certified.value.high(), "{place}");
            assert!(high + room >= certified.value.low(), "{place}");
            if !certified.is_proven() {
                tally.undecided += 1;
                continue;
            }
            tally.proven += 1;
            assert_eq!(certified.roots, value.roots, "{place}");
            if value.value > 0.0 && k > 0 {
                tally.lit += 1;
                tally.outside_lit += u32::from(libm::hypot(x, y) > form.wall.radius);
                if value.conditioning() < 100.0 {
                    tally.widest = tally.widest.max(certified.value.relative_width());
                }
                // A value that is wrong by 1e-9 is not in a narrow interval.
                if certified.value.relative_width() < 1e-10 {
                    assert!(
                        !certified.value.contains(value.value * (1.0 + 1e-9)),
                        "{place}"
                    );
                }
            }
        }
    }
}

#[test]
fn chains_of_a_lamp() {
    let mut spread = Spread(20_261_122);
    let mut tally = Tally::default();
    for n in 0..90 {
        let radius = 1.0 + 0.2 * spread.next();
        let arc = 1.0 + 2.0 * spread.next().abs();
        let on_wall = n % 3 == 2;
        let azimuth = if on_wall && n % 2 == 0 {
            // In the opening, as in the catalogue.
            core::f64::consts::PI - 0.02 * spread.next()
        } else {
            3.1 * spread.next()
        };
        let distance = if on_wall {
            radius
        } else {
            radius * 0.95 * spread.next().abs()
        };
        let form = CylinderCup {
            wall: Wall {
                radius,
                height: (n % 4 != 0).then(|| 0.9 + 0.6 * spread.next()),
                cos_half_arc: (n % 5 != 0).then(|| libm::cos(arc)),
            },
            reflectance: 0.9,
            light: Light::Point(Lamp {
                x: distance * libm::cos(azimuth),
                y: distance * libm::sin(azimuth),
                height: 1.4 + 0.5 * spread.next(),
                intensity: 3.0,
            }),
        };
        compare(&form, on_wall, &mut spread, &mut tally);
    }
    println!("{tally:?}");
    assert!(
        tally.proven > 5000 && tally.undecided * 50 < tally.proven,
        "{tally:?}"
    );
    assert!(tally.lit > 500 && tally.outside_lit > 200, "{tally:?}");
    assert!(tally.widest < 1e-10, "{tally:?}");
}
