//! The surfaces of a model against the optics that the kinds are named for, and meshes against the error that is stated.

use glam::DVec3;
use nephroid::entry;
use nephroid::export::kinds::model;
use nephroid::export::model::{Geometry, Light, Material, Model, Patch, Shape};
use nephroid::export::tessellation::{self, tessellate};
use nephroid_analytic::camera::Film;
use nephroid_analytic::scene::Kind;

use super::load;

fn of(name: &str) -> Model {
    model(&load(name))
}

fn patch(model: &Model, name: &str) -> Patch {
    let shape = model.shapes.iter().find(|s| s.name == name).unwrap();
    shape.geometry.patch().unwrap()
}

fn light(model: &Model) -> DVec3 {
    match model.light {
        Light::Point { position, .. } => position,
        Light::Directional { .. } => panic!("no point light"),
    }
}

fn mirrored(direction: DVec3, normal: DVec3) -> DVec3 {
    direction - 2.0 * direction.dot(normal) * normal
}

/// Places on a patch, ends left out.
fn places() -> impl Iterator<Item = (f64, f64)> {
    (1..8).flat_map(|i| (1..8).map(move |j| (f64::from(i) / 8.3, f64::from(j) / 8.7)))
}

/// The distance of a point from a line.
fn miss(point: DVec3, origin: DVec3, direction: DVec3) -> f64 {
    (point - origin).cross(direction.normalize()).length()
}

#[test]
fn normals_are_perpendicular_to_the_surfaces_of_every_entry() {
    for name in entry::names() {
        for shape in of(name).shapes {
            let Some(patch) = shape.geometry.patch() else {
                continue;
            };
            for (s, t) in places() {
                let (_, normal) = (patch.at)(s, t);
                let step = 1e-6;
                let along =
                    |ds: f64, dt: f64| (patch.at)(s + ds, t + dt).0 - (patch.at)(s - ds, t - dt).0;
                for tangent in [along(step, 0.0), along(0.0, step)] {
                    let slope = tangent.normalize().dot(normal);
                    assert!(slope.abs() < 1e-6, "{name} {} {slope:e}", shape.name);
                }
                assert!((normal.length() - 1.0).abs() < 1e-14);
            }
        }
    }
}

#[test]
fn shapes_have_names_of_their_own_and_the_floor_is_first() {
    for name in entry::names() {
        let shapes = of(name).shapes;
        let mut names: Vec<_> = shapes.iter().map(|s| s.name).collect();
        let count = names.len();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), count, "{name}");
        assert_eq!(shapes[0].name == "floor", name != "furnace", "{name}");
    }
}

#[test]
fn mirrors_face_the_light() {
    for name in entry::names() {
        let model = of(name);
        let Light::Point { position, .. } = model.light else {
            continue;
        };
        let mirror = |s: &&Shape| matches!(s.material, Material::Mirror { .. });
        for shape in model.shapes.iter().filter(mirror) {
            let facing = match &shape.geometry {
                Geometry::Rectangle { center, u, v } => u.cross(*v).dot(position - *center) > 0.0,
                geometry => {
                    let patch = geometry.patch().unwrap();
                    let front = |(s, t)| {
                        let (point, normal) = (patch.at)(s, t);
                        normal.dot(position - point) > 0.0
                    };
                    places().any(front)
                }
            };
            assert!(facing, "{name} {}", shape.name);
        }
    }
}

#[test]
fn the_dish_sends_light_from_its_focus_straight_down() {
    let model = of("dish");
    let patch = patch(&model, "dish");
    for (s, t) in places() {
        let (point, normal) = (patch.at)(s, t);
        let out = mirrored((point - light(&model)).normalize(), normal);
        assert!((out + DVec3::Z).length() < 1e-12, "{out}");
    }
}

#[test]
fn conics_send_light_from_one_focus_to_the_other() {
    for name in ["ellipsoid", "hyperboloid"] {
        let model = of(name);
        let Kind::ConicMirrors(scene) = load(name).kind else {
            panic!()
        };
        let [x, y] = scene.conic.center;
        let image = DVec3::new(x, y, scene.conic.image_z);
        let patch = patch(&model, "conic");
        for (s, t) in places() {
            let (point, normal) = (patch.at)(s, t);
            let incoming = (point - light(&model)).normalize();
            assert!(incoming.dot(normal) < 0.0, "{name}");
            let distance = miss(image, point, mirrored(incoming, normal));
            assert!(distance < 1e-12, "{name} {distance:e}");
        }
        // The rim.
        assert!(((patch.at)(0.3, 1.0).0.z - scene.conic.rim_z).abs() < 1e-12);
    }
}

#[test]
fn the_vertical_ellipse_maps_focus_to_focus_in_plan() {
    let model = of("conic-wall");
    let Kind::ConicWall(scene) = load("conic-wall").kind else {
        panic!()
    };
    let wall = &scene.wall;
    let (cx, cy) = wall.axis();
    let focus = DVec3::new(wall.focus[0], wall.focus[1], 0.0);
    // The other focus of r = p/(1 + e cos θ) is 2 e p/(1 - e²) behind the first.
    let apart =
        2.0 * wall.eccentricity * wall.parameter / (1.0 - wall.eccentricity * wall.eccentricity);
    let other = focus - DVec3::new(cx, cy, 0.0) * apart;
    let patch = patch(&model, "wall");
    for (s, _) in places() {
        let (point, normal) = (patch.at)(s, 0.0);
        let out = mirrored((point - focus).normalize(), normal);
        assert!(miss(other, point, out) < 1e-12);
        assert!((point - focus).dot(normal) < 0.0);
    }
}

#[test]
fn the_lens_brings_vertical_light_to_its_focus() {
    let model = of("lens");
    let Kind::StigmaticRefractors(scene) = load("lens").kind else {
        panic!()
    };
    let lens = &scene.lens;
    let focus = DVec3::new(lens.center[0], lens.center[1], lens.defocus);
    let patch = patch(&model, "lens");
    for (s, t) in places() {
        let (point, normal) = (patch.at)(s, t);
        // Snell's law in vectors: n out - in is along the normal.
        let out = (focus - point).normalize();
        let difference = lens.index * out + DVec3::Z;
        assert!(difference.cross(normal).length() < 1e-12);
        assert!(normal.z > 0.0);
    }
    assert!(((patch.at)(0.7, 1.0).0.z - lens.rim_z()).abs() < 1e-12);
}

/// The mesh of the cup's wall: rays of the sun at random places of its facets, with the exact circle beside them.
#[test]
fn the_stated_displacement_of_the_cup_is_what_rays_do() {
    let entry = load("cup");
    let Kind::CylinderCup(scene) = &entry.kind else {
        panic!()
    };
    let model = model(&entry);
    let Light::Directional { travel, .. } = model.light else {
        panic!()
    };
    let patch = patch(&model, "wall");
    let told = tessellate(&model, &patch, Material::Mirror { reflectance: 0.9 });
    assert!(told.displacement > 0.0 && told.displacement <= tessellation::ALLOWED);
    let film = Film::new(&entry.camera);
    let eye = DVec3::from_array(entry.camera.position);
    let a = scene.wall.radius;
    let landing = |point: DVec3, out: DVec3| point - out * (point.z / out.z);
    let mut largest = 0.0_f64;
    for (k, triangle) in told.mesh.triangles.iter().enumerate() {
        let [p, q, r] = triangle.map(|i| told.mesh.vertices[i as usize]);
        // Weights that change from facet to facet.
        let u = 0.1 + 0.8 * ((k * 7919) % 101) as f64 / 101.0;
        let v = (1.0 - u) * (0.1 + 0.8 * ((k * 104_729) % 97) as f64 / 97.0);
        let mix = |f: fn(&(DVec3, DVec3)) -> DVec3| f(&p) * (1.0 - u - v) + f(&q) * u + f(&r) * v;
        let (on_facet, normal) = (mix(|e| e.0), mix(|e| e.1).normalize());
        if travel.dot(normal) >= 0.0 {
            continue;
        }
        let told_at = landing(on_facet, mirrored(travel, normal));
        // The same ray on the circle: |plan + τ d| = a.
        let (x, y, dx, dy) = (on_facet.x, on_facet.y, travel.x, travel.y);
        let (dd, pd) = (dx * dx + dy * dy, x * dx + y * dy);
        let rest = a * a - x * x - y * y;
        let tau = rest / (pd + f64::sqrt(pd * pd + dd * rest));
        let exact = on_facet + travel * tau;
        let inner = -DVec3::new(exact.x, exact.y, 0.0).normalize();
        let at = landing(exact, mirrored(travel, inner));
        let pixel = (at - eye).length() * film.du.length();
        largest = largest.max((at - told_at).length() / pixel);
    }
    assert!(
        largest <= 1.2 * told.displacement,
        "{largest:e} {:e}",
        told.displacement
    );
    assert!(
        largest >= 0.1 * told.displacement,
        "{largest:e} {:e}",
        told.displacement
    );
}
