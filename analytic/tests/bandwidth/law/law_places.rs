//! Places where the law is neither that of a smooth point nor of a caustic's fold: the foot of a wall, the corner of a mirror, a point
//! focus. Against exact expectations, which share no code with it.

use core::f64::consts::{PI, TAU};

use nephroid_analytic::bandwidth::entry::EntryExpectation;
use nephroid_analytic::bandwidth::law::{Law, Place, SmallBandwidth};
use nephroid_analytic::bandwidth::{
    Convention, Expectation, Kernel, Moments, PlanarSetting, Technique,
};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::Entry;
use serde_json::{Value, json};

use super::estimator;

fn entry(mut scene: Value, camera: Value) -> Entry {
    scene["name"] = json!("test");
    scene["title"] = json!("a test");
    scene["camera"] = camera;
    let entry: Entry = serde_json::from_value(scene).unwrap();
    entry.validate().unwrap();
    entry
}

fn view(position: [f64; 3], look_at: [f64; 3], degrees: f64) -> Value {
    json!({ "position": position, "look_at": look_at, "field_of_view_degrees": degrees, "width": 16, "height": 16 })
}

/// The catalogue's `pillar`.
fn pillar() -> Entry {
    let scene = json!({
        "kind": "pillar",
        "light": { "position": [-1.3, 0.55, 1.25], "intensity": 5.3 },
        "floor": { "center": [0.1, -0.6], "half_width": [2.4, 2.7], "albedo": 0.62 },
        "pillar": { "center": [0.15, 0.45], "radius": 0.78, "height": 0.83, "reflectance": 0.87 },
    });
    entry(scene, view([-0.15, -3.1, 3.8], [-0.15, -1.45, 0.0], 25.0))
}

/// `mirror-wall`.
fn wall() -> Entry {
    let scene = json!({
        "kind": "planar-mirror",
        "light": { "position": [0.25, 0.0, 2.0], "intensity": 1.0 },
        "floor": { "half_width": [3.0, 3.0], "albedo": 0.5 },
        "mirror": {
            "center": [0.0, 1.0, 0.625], "normal": [0.0, -1.0, 0.0], "edge": [1.0, 0.0, 0.0],
            "half_width": 0.75, "half_height": 0.5, "reflectance": 1.0,
        },
    });
    entry(scene, view([0.0, -3.0, 2.0], [0.0, 0.6, 0.3], 45.0))
}

/// `ellipsoid`, let down until its lower focus is on the floor.
fn ellipsoid() -> Entry {
    let scene = json!({
        "kind": "conic-mirrors",
        "light": { "intensity": 1.3 },
        "floor": { "center": [0.3, 0.1], "half_width": [2.8, 2.7], "albedo": 0.7 },
        "conic": {
            "center": [0.1, 0.05], "semi_axis": 1.3, "eccentricity": 0.6, "image_z": 0.0, "rim_z": 0.81,
            "reflectance": 0.91,
        },
    });
    entry(scene, view([-1.1, -0.9, 0.7], [0.1, 0.05, 0.0], 42.0))
}

fn law(entry: &Entry, t: Technique, k: Kernel, x: [f64; 2]) -> Option<Law> {
    let laws = SmallBandwidth::new(entry, t, k, Convention::Exact, 1.0).unwrap();
    let class = laws.classes().iter().position(|c| *c == PathClass::LSDE);
    laws.at(x[0], x[1])[class.unwrap()]
}

fn moments(entry: &Entry, t: Technique, k: Kernel, x: [f64; 2], b: f64, tolerance: f64) -> Moments {
    let e = EntryExpectation::new(entry, estimator(t, k, &[b]), 1.0).unwrap();
    let class = e.classes().iter().position(|c| *c == PathClass::LSDE);
    e.at(x[0], x[1], tolerance)[class.unwrap()]
}

/// At the foot of a wall a linked distance vanishes: its share of the bias is of order r², at lit points and in the dark, with the
/// next term at r³, which halving r and halving it again takes out.
#[test]
fn the_foot_of_a_wall_has_its_share_of_a_linked_bias() {
    let entry = pillar();
    let t = Technique::Linked;
    let mut wrong = Vec::new();
    for (x, kernel, is_lit) in [
        ([-0.6, -0.35], Kernel::Cone, true),
        ([-0.812, -0.978], Kernel::Epanechnikov, true),
        ([-0.6, -0.35], Kernel::VonMisesFisher, true),
        ([-1.3, -2.9], Kernel::Cone, false),
    ] {
        let law = law(&entry, t, kernel, x).unwrap();
        let limit = law.limit.unwrap();
        println!("{x:?} {kernel} {law:?}");
        let is_smooth = (law.place, law.order) == (Place::Smooth, Some(2.0)) && law.roots > 0;
        let is_dark = (law.place, law.order, limit) == (Place::Dark, Some(2.0), 0.0);
        assert!(if is_lit { is_smooth } else { is_dark });
        let a = 0.02 * law.reach.min(1.0);
        let slope = |r: f64| (moments(&entry, t, kernel, x, r, 1e-12).mean.value - limit) / (r * r);
        let [f, g, h] = [a, 0.5 * a, 0.25 * a].map(slope);
        let [coarse, fine] = [2.0 * g - f, 2.0 * h - g];
        let found = (4.0 * fine - coarse) / 3.0;
        println!("  {f} {g} {h}: {found}, law {}", law.coefficient);
        let off = (found / law.coefficient - 1.0).abs();
        if off >= 1e-4 {
            wrong.push(format!("{x:?} {kernel} {found} {law:?}"));
        }
        if !is_lit {
            let second = moments(&entry, t, kernel, x, a, 1e-8).second_moment.value;
            let ratio = second / law.second_moment(a);
            if (ratio - 1.0).abs() >= 0.1 {
                wrong.push(format!("{ratio} {law:?}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// At the corner of a mirror the mean tends to the share of directions inside, that of the angle that the corner has among the
/// offsets.
#[test]
fn at_a_corner_the_mean_tends_to_the_share_of_directions() {
    let entry = wall();
    // From the light's image through the upper corner to the floor, a hair inside.
    let (image, corner): ([f64; 3], [f64; 3]) = ([0.25, 2.0, 2.0], [0.75, 1.0, 1.125]);
    let inside = 1e-10;
    let corner = [corner[0] - inside, corner[1], corner[2] - inside];
    let t = image[2] / (image[2] - corner[2]);
    let x = [0, 1].map(|k| image[k] + t * (corner[k] - image[k]));
    let setting = PlanarSetting::of_entry(&entry).unwrap().unwrap();
    let whole = Expectation::new(setting, Technique::Merge, Kernel::Disc, &[0.1]).unwrap();
    let e0 = whole.sharp([x[0], x[1], 0.0]);
    for (t, k) in [
        (Technique::Camera, Kernel::Cone),
        (Technique::Light, Kernel::Epanechnikov),
        (Technique::Merge, Kernel::Disc),
    ] {
        let law = law(&entry, t, k, x).unwrap();
        assert_eq!((law.place, law.order), (Place::Edge, Some(1.0)), "{t}");
        let limit = law.limit.unwrap();
        println!("{t}: share {}", limit / e0);
        assert!(limit > 0.05 * e0 && limit < 0.45 * e0, "{t}");
        let slope = |a: f64| (moments(&entry, t, k, x, a, 1e-12).mean.value - limit) / a;
        let (coarse, fine) = (slope(2e-2) - law.coefficient, slope(1e-2) - law.coefficient);
        assert!(
            fine.abs() < 0.03 * limit && (coarse / fine - 2.0).abs() < 0.1,
            "{t} {coarse} {fine} {law:?}"
        );
    }
}

/// All the light of an ellipsoid in one point. The law is what the kernel has at its top times the flux, R I times the mirror's
/// solid angle.
#[test]
fn all_light_of_an_ellipsoid_is_in_its_focus() {
    let entry = ellipsoid();
    // Half axes 1.3 and 1.3·0.8 about (0.1, 0.05, 0.78), foci 0.78 above and below.
    let z = (0.81 - 0.78) / 1.3;
    let (rise, radius) = (0.81 - 1.56, 1.3 * 0.8 * libm::sqrt(1.0 - z * z));
    let flux = 1.3 * 0.91 * TAU * (1.0 - rise / libm::hypot(rise, radius));
    let x = [0.1, 0.05];
    for (t, k, top) in [
        (Technique::Merge, Kernel::Disc, 1.0),
        (Technique::Merge, Kernel::Epanechnikov, 2.0),
        (Technique::Camera, Kernel::Cone, 1.0),
        (Technique::Light, Kernel::VonMisesFisher, 2.0),
    ] {
        let law = law(&entry, t, k, x).unwrap();
        println!("{t} {k} {law:?}");
        let orders = (law.place, law.order, law.squared_order);
        assert_eq!(orders, (Place::PointFocus, Some(-2.0), 4.0));
        if t == Technique::Merge {
            let exact = top * flux / PI;
            assert!(
                (law.coefficient / exact - 1.0).abs() < 1e-5,
                "{t} {k} {exact} {law:?}"
            );
            let beside = moments(&entry, t, k, [x[0] + 0.02, x[1]], 1e-2, 1e-6);
            assert_eq!(beside.mean.value, 0.0);
        }
        let m = moments(&entry, t, k, x, 1e-3, 1e-6);
        let mean = m.mean.value / law.mean(1e-3);
        let second = m.second_moment.value / law.second_moment(1e-3);
        assert!(
            (mean - 1.0).abs() < 1e-4 && (second - 1.0).abs() < 1e-4,
            "{t} {k} {mean} {second}"
        );
    }
}

/// A wall's foot in the dark, a linked cone: sums over 6000 azimuths and 6000 heights in equal ratios from 1e-8 m, with the definition written
/// out, which are good to 3e-4 (doubling their steps).
#[test]
fn a_foot_in_the_dark_is_a_sum_over_heights() {
    for (r, expected) in [
        (0.2, 2.137_22e-5),
        (0.05, 9.059_75e-7),
        (0.01, 3.315_25e-8),
        (0.002, 1.303_23e-9),
    ] {
        let m = moments(
            &pillar(),
            Technique::Linked,
            Kernel::Cone,
            [-1.3, -2.9],
            r,
            1e-10,
        );
        println!("{r} {:?} {expected}", m.mean);
        assert!(
            (m.mean.value / expected - 1.0).abs() < 3e-4,
            "{r} {m:?} {expected}"
        );
    }
}
