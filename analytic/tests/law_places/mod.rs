//! Places where the law is neither that of a smooth point nor of a caustic's fold: the corner of a mirror, a point focus. Against
//! exact expectations, which share no code with it.

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
