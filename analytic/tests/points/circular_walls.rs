//! Circular walls as scenes: what their validation claims about the number of reflections, by rays that are traced from wall
//! to wall; and where their caustics have cusps.

use nephroid_analytic::class::PathClass;
use nephroid_analytic::entries::FloorTruth;
use nephroid_analytic::kinds::singularity::SingularityKind;
use nephroid_analytic::scene::{
    ArcWall, Camera, CircleLight, ClosedCupScene, ClosedWall, CylinderLampScene, DirectionalLight,
    Entry, Floor, Kind,
};
use nephroid_analytic::vector::{Vec3, vec3};

fn entry(kind: Kind) -> Entry {
    Entry {
        name: "circular".to_owned(),
        title: String::new(),
        kind,
        camera: Camera {
            position: [0.02, -0.03, 6.0],
            look_at: [0.0, 0.01, 0.0],
            up: [0.0, 1.0, 0.0],
            field_of_view_degrees: 8.0,
            width: 16,
            height: 16,
        },
    }
}

fn floor(half: f64) -> Floor {
    Floor {
        center: [0.0, 0.0],
        half_width: [half, half],
        albedo: 0.6,
    }
}

const RADIUS: f64 = 1.2;
const HEIGHT: f64 = 0.7;

fn lamp(azimuth_degrees: f64, inset: f64, height: f64, half_arc_degrees: f64) -> Entry {
    entry(Kind::CylinderLamp(CylinderLampScene {
        light: CircleLight {
            azimuth_degrees,
            inset,
            height,
            intensity: 3.2,
        },
        floor: floor(2.0),
        wall: ArcWall {
            radius: RADIUS,
            height: HEIGHT,
            half_arc_degrees,
            reflectance: 0.9,
        },
    }))
}

fn sun(elevation_degrees: f64, half_floor: f64) -> Entry {
    entry(Kind::ClosedCup(ClosedCupScene {
        light: DirectionalLight {
            elevation_degrees,
            irradiance: 2.3,
        },
        floor: floor(half_floor),
        wall: ClosedWall {
            radius: RADIUS,
            height: HEIGHT,
            reflectance: 0.9,
        },
    }))
}

/// The direction after reflection at a point of the wall.
fn reflected(q: Vec3<f64>, d: Vec3<f64>) -> Vec3<f64> {
    let n = vec3(q.x / RADIUS, q.y / RADIUS, 0.0);
    d - n * (2.0 * d.dot(n))
}

/// Where a ray that starts in the circle, or on it and inwards, leaves it.
fn leave(q: Vec3<f64>, d: Vec3<f64>) -> Vec3<f64> {
    let (a, b) = (d.x * d.x + d.y * d.y, q.x * d.x + q.y * d.y);
    let rest = b * b - a * (q.x * q.x + q.y * q.y - RADIUS * RADIUS);
    q + d * ((rest.max(0.0).sqrt() - b) / a)
}

/// Heights at which the rays of a lamp over the whole circle come back to it, largest.
fn highest_second_meeting(light: [f64; 3]) -> f64 {
    let light = Vec3::from_f64(light);
    let mut highest = f64::NEG_INFINITY;
    for k in 0..720 {
        let phi = f64::from(k) * core::f64::consts::PI / 360.0 + 1e-3;
        for z in [0.2, 0.6, 1.0] {
            let q = vec3(RADIUS * libm::cos(phi), RADIUS * libm::sin(phi), HEIGHT * z);
            let again = leave(q, reflected(q, q - light));
            highest = highest.max(again.z);
        }
    }
    highest
}

#[test]
fn a_lamp_twice_as_high_as_the_wall_meets_it_once_and_a_lower_one_is_refused() {
    for (azimuth, inset) in [(180.0, 0.0), (-40.0, 0.0), (77.0, 0.3), (123.0, 1.1)] {
        for half_arc in [60.0, 125.0, 180.0] {
            let high = lamp(azimuth, inset, 2.01 * HEIGHT, half_arc);
            assert_eq!(high.validate(), Ok(()));
            let low = lamp(azimuth, inset, 1.99 * HEIGHT, half_arc);
            let refused = low.validate().expect_err("too low");
            assert_eq!(refused.key, "light.height");
            assert!(refused.allowed.contains("twice"), "{refused}");
        }
        let Kind::CylinderLamp(scene) = lamp(azimuth, inset, 2.01 * HEIGHT, 60.0).kind else {
            panic!("a lamp");
        };
        let at = scene.light.position(RADIUS);
        assert!(highest_second_meeting(at) < 0.0, "{at:?}");
        if inset == 0.0 {
            // From the circle all chords are as long as the way to the wall: the condition is sharp.
            let lower = [at[0], at[1], 1.95 * HEIGHT];
            assert!(highest_second_meeting(lower) > 0.0);
        }
    }
}

#[test]
fn a_lamp_next_to_the_wall_and_a_wall_in_the_frame_are_refused() {
    let near = lamp(180.0, 0.011, 1.9, 60.0)
        .validate()
        .expect_err("too near");
    assert_eq!(near.key, "light.inset");
    let mut wide = lamp(180.0, 0.0, 1.9, 60.0);
    wide.camera.field_of_view_degrees = 30.0;
    let refused = wide.validate().expect_err("the wall is in the frame");
    assert_eq!(refused.key, "camera.look_at");
}

/// The cusp of the cardioid is a third of the radius from the axis, opposite the light (theory block G).
#[test]
fn the_cardioid_has_its_cusp_opposite_the_lamp() {
    let truth = FloorTruth::new(&lamp(180.0, 0.0, 2.4 * HEIGHT, 60.0)).unwrap();
    let at = |x: f64, y: f64| truth.singularity(x, y, 1).unwrap();
    let cusp = at(RADIUS / 3.0 - 0.01, 0.0);
    assert_eq!(cusp.kind, SingularityKind::Cusp);
    assert!((cusp.distance - 0.01).abs() < 1e-9, "{cusp:?}");
    for t in [0.3_f64, 0.6, 0.9] {
        let x = RADIUS / 3.0 * (2.0 * libm::cos(t) - libm::cos(2.0 * t));
        let y = RADIUS / 3.0 * (2.0 * libm::sin(t) - libm::sin(2.0 * t));
        let fold = at(x, y);
        assert!(
            fold.kind == SingularityKind::Fold && fold.distance < 1e-9,
            "{fold:?}"
        );
    }
}

/// After k bounces the ray through the axis has its cusp (2k-1)/(2k) a from its last meeting with the wall.
#[test]
fn the_sun_makes_a_cusp_for_every_number_of_bounces() {
    for (depth, k, x) in [
        (0.7, 1, 0.5),
        (1.6, 2, -0.25),
        (2.6, 3, 1.0 / 6.0),
        (3.6, 4, -0.125),
    ] {
        let slope: f64 = HEIGHT / (2.0 * RADIUS * depth);
        let truth = FloorTruth::new(&sun(libm::atan(slope).to_degrees(), 0.5)).unwrap();
        let class = PathClass::new(k, 0);
        // On the side of the cusp where the caustic is not.
        let off = -0.004 * f64::copysign(1.0, x);
        let points = truth.at(x * RADIUS + off, 0.0);
        let index = points.iter().position(|p| p.class == class).unwrap();
        let cusp = truth.singularity(x * RADIUS + off, 0.0, index).unwrap();
        assert_eq!(cusp.kind, SingularityKind::Cusp, "{k}");
        assert!((cusp.distance - 0.004).abs() < 1e-9, "{k} {cusp:?}");
    }
}

/// Rays over the whole opening, from wall to wall in space: how often each has been reflected when it reaches the floor.
/// None that lands on the entry's floor may be of another class than those of the scene, and every class must occur.
#[test]
fn every_ray_on_the_floor_of_a_closed_cup_is_of_a_class() {
    const N: i32 = 701;
    for (elevation, half_floor) in [(29.0, 0.62), (40.0, 0.68), (20.0, 0.75), (10.33, 0.68)] {
        let scene = sun(elevation, half_floor);
        assert_eq!(scene.validate(), Ok(()));
        let classes = scene.kind.classes();
        let e = elevation.to_radians();
        let mut counts = [0; 32];
        let mut beyond = 0;
        for n in 0..N * N {
            let at = |k: i32| RADIUS * (2.0 * (f64::from(k) + 0.5) / f64::from(N) - 1.0);
            let mut p = vec3(at(n % N), at(n / N), HEIGHT);
            if p.x * p.x + p.y * p.y >= RADIUS * RADIUS {
                continue;
            }
            let mut d = vec3(libm::cos(e), 0.0, -libm::sin(e));
            let mut reflections = 0;
            let on_floor = loop {
                let q = leave(p, d);
                if q.z < 0.0 {
                    break p + d * (p.z / -d.z);
                }
                (p, d) = (q, reflected(q, d));
                reflections += 1;
            };
            let inside = on_floor.x.abs() <= half_floor && on_floor.y.abs() <= half_floor;
            if inside {
                assert!(
                    classes.contains(&PathClass::new(reflections, 0)),
                    "{elevation}: {reflections} reflections at {on_floor:?}"
                );
                counts[reflections] += 1;
            } else {
                let last = classes.last().map_or(0, |c| c.light.len());
                beyond += usize::from(reflections > last);
            }
        }
        let lit = |c: &PathClass| counts[c.light.len()] > 0;
        assert!(
            classes.iter().all(lit),
            "{elevation}: {classes:?} {counts:?}"
        );
        // There is such light, beside the floor.
        assert!(beyond > 0, "{elevation}");
    }
}

/// Under a high sun part of the floor is lit directly: all but the shadow of the near rim, whose edge is the circle moved
/// along the beam.
#[test]
fn the_near_rim_throws_its_shadow_on_the_floor() {
    let elevation: f64 = 29.0;
    let scene = sun(elevation, 0.68);
    assert_eq!(scene.kind.classes()[0], PathClass::LDE);
    let truth = FloorTruth::new(&scene).unwrap();
    let shift = HEIGHT / libm::tan(elevation.to_radians());
    let (mut lit, mut dark) = (0, 0);
    for n in 0..40 * 40 {
        let at = |k: i32| 0.68 * (f64::from(k) / 19.5 - 1.0);
        let (x, y) = (at(n % 40), at(n / 40));
        // The ray seen from the point passes over the near rim where it leaves the circle, if that is high enough.
        let e = elevation.to_radians();
        let over = leave(vec3(x, y, 0.0), vec3(-libm::cos(e), 0.0, libm::sin(e))).z > HEIGHT;
        assert_eq!(over, libm::hypot(x - shift, y) < RADIUS);
        let found = truth.at(x, y)[0].irradiance.value;
        let expected = if over { 2.3 * libm::sin(e) } else { 0.0 };
        assert!((found - expected).abs() < 1e-14, "({x}, {y}) {found}");
        (lit, dark) = (lit + i32::from(over), dark + i32::from(!over));
    }
    assert!(lit > 20 && dark > 20, "{lit} {dark}");
}

#[test]
fn a_floor_up_to_the_wall_and_endless_reflections_are_refused() {
    let refused = sun(30.0, 0.9).validate().expect_err("beyond the wall");
    assert_eq!(refused.key, "floor.half_width");
    // η/√(1 - ρ²) is far above the longest chain.
    let refused = sun(1.1, 0.6).validate().expect_err("too many reflections");
    assert_eq!(refused.key, "wall.height");
    assert!(refused.allowed.contains("14 times"), "{refused}");
}
