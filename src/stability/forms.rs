//! The closed forms of every kind in any precision, from the same numbers as their certificates.

use nephroid_analytic::certificate::radiometry::Point;
use nephroid_analytic::certificate::scene::Scene;
use nephroid_analytic::certificate::{self, Certified};
use nephroid_analytic::enclosure::Enclosure;
use nephroid_analytic::kinds::Estimate;
use nephroid_analytic::kinds::conic_mirrors::{Ellipsoid, Hyperboloid};
use nephroid_analytic::kinds::conic_wall::ConicWall;
use nephroid_analytic::kinds::cylinder_cup::{self, Beam, CylinderCup, Wall, point_light::Lamp};
use nephroid_analytic::kinds::diffuse;
use nephroid_analytic::kinds::flat_interface::FlatInterface;
use nephroid_analytic::kinds::glass_pillar::GlassPillar;
use nephroid_analytic::kinds::glass_slab::GlassSlab;
use nephroid_analytic::kinds::glass_sphere::GlassSphere;
use nephroid_analytic::kinds::paraboloid::{self, Paraboloid};
use nephroid_analytic::kinds::pillar::Pillar;
use nephroid_analytic::kinds::planar_chains::Wedge;
use nephroid_analytic::kinds::planar_mirror::PlanarMirror;
use nephroid_analytic::kinds::sphere_mirror::{self, Side, SphereMirror};
use nephroid_analytic::kinds::stigmatic_refractors::{Front, StigmaticRefractor};
use nephroid_analytic::kinds::water_waves::{WaterWaves, Wave};
use nephroid_analytic::scalar::Scalar;
use nephroid_analytic::vector::vec3;

use super::inputs::Inputs;

/// Irradiance by the kind's first caustic class (by direct light for `diffuse`) in the precision of `S`; `None` if the
/// numbers are outside what the form holds for.
pub fn irradiance<S: Scalar>(kind: &str, i: &Inputs) -> Option<Estimate<S>> {
    let n = |key: &str| i.scalar::<S>(key);
    let [x, y] = i.x.map(S::from_f64);
    let floor = vec3(x, y, S::ZERO);
    Some(match kind {
        "diffuse" => diffuse::direct(i.vector("light"), n("I"), floor),
        "planar-mirror" => PlanarMirror::new(
            i.vector("light"),
            n("I"),
            n("R"),
            i.vector("mirror_point"),
            i.vector("mirror_normal"),
            None,
        )
        .caustic(floor),
        "planar-chains" => {
            let polar = i.vector::<S>("light_polar");
            let wedge = Wedge {
                m: n("m").to_f64() as u32,
                radius: polar.x,
                angle: polar.y,
                height: polar.z,
                intensity: n("I"),
                reflectance: n("R"),
            };
            wedge.caustic(x, y, 1)
        }
        "flat-interface" => FlatInterface {
            surface_z: n("surface_z"),
            index: n("n"),
            light: i.vector("light"),
            intensity: n("I"),
            receiver_z: S::ZERO,
        }
        .caustic(x, y),
        "glass-slab" => {
            let z = i.vector::<S>("slab_z");
            let slab = GlassSlab {
                bottom: z.x,
                top: z.y,
                index: n("n"),
                light: i.vector("light"),
                intensity: n("I"),
                receiver_z: S::ZERO,
            };
            slab.caustic(x, y, 0)
        }
        "concave-sphere" | "convex-sphere" => {
            let receiver_z = n("z_receiver");
            let mirror = SphereMirror {
                centre: i.vector("sphere_centre"),
                radius: n("a"),
                side: if kind == "convex-sphere" {
                    Side::Convex
                } else {
                    Side::Concave
                },
                cap_axis: vec3(S::ZERO, S::ZERO, S::ONE),
                cap_cos_min: n("cap_cos_min"),
                reflectance: n("R"),
                light: sphere_mirror::Light::Point {
                    position: i.vector("light"),
                    intensity: n("I"),
                },
                receiver_z,
            };
            mirror.caustic(vec3(x, y, receiver_z))
        }
        "cylinder-cup" => {
            let light = if i.has_number("light") {
                let lamp = i.vector::<S>("light");
                cylinder_cup::Light::Point(Lamp {
                    x: lamp.x,
                    y: lamp.y,
                    height: lamp.z,
                    intensity: n("I"),
                })
            } else {
                cylinder_cup::Light::Beam(Beam {
                    irradiance: n("E0"),
                    sin_elevation: n("sin_elevation"),
                    cos_elevation: n("cos_elevation"),
                })
            };
            let cup = CylinderCup {
                wall: Wall {
                    radius: n("a"),
                    height: i.has_number("wall_height").then(|| n("wall_height")),
                    cos_half_arc: (i.word("wall") == Some("half")).then_some(S::ZERO),
                },
                reflectance: n("R"),
                light,
            };
            cup.caustic(x, y, 1)
        }
        "paraboloid" => Paraboloid {
            focal_length: n("f"),
            reflectance: n("R"),
            light: paraboloid::Light::Beam(n("E0")),
            receiver_z: n("c"),
            inner_radius: n("r0"),
            outer_radius: n("r1"),
        }
        .caustic(x, y),
        "conic-mirrors" if i.has_number("a") => Ellipsoid {
            semi_axis: n("a"),
            eccentricity: n("e"),
            defocus: n("delta"),
            intensity: n("I"),
            reflectance: n("R"),
        }
        .caustic(x, y),
        "conic-mirrors" => Hyperboloid {
            semi_axis: n("A"),
            eccentricity: n("e"),
            receiver_z: n("zr"),
            intensity: n("I"),
            reflectance: n("R"),
        }
        .caustic(x, y),
        "stigmatic-refractors" => StigmaticRefractor {
            index: n("n"),
            front: Front::Oval {
                light_z: n("D"),
                optical_length: n("C"),
                intensity: n("I"),
            },
            defocus: n("delta"),
        }
        .caustic(x, y),
        "glass-sphere" => GlassSphere {
            index: n("n"),
            radius: n("a"),
            irradiance: n("E0"),
            receiver_z: n("receiver_z"),
            max_incidence: S::HALF * S::PI,
        }
        .caustic(x.hypot(y), 2),
        "water-waves" => {
            let waves = i.rows::<S>("waves_A_k_phase").into_iter();
            let waves = waves.map(|[amplitude, wave_number, phase]| Wave {
                amplitude,
                wave_number,
                phase,
            });
            WaterWaves::new(n("n"), n("mean_depth_H"), n("E0"), waves.collect())
                .ok()?
                .caustic(x)
        }
        "pillar" => pillar::<S>(i).caustic(x, y),
        "conic-wall" => conic_wall::<S>(i).caustic(x, y),
        "glass-pillar" => glass_pillar::<S>(i).caustic(x, y, interactions(i)),
        _ => return None,
    })
}

fn pillar<S: Scalar>(i: &Inputs) -> Pillar<S> {
    let centre = i.vector::<S>("centre");
    Pillar {
        x: centre.x,
        y: centre.y,
        radius: i.scalar("a"),
        height: i.scalar("height"),
        reflectance: i.scalar("R"),
        light: i.vector("light"),
        intensity: i.scalar("I"),
    }
}

/// A closed ellipse.
fn conic_wall<S: Scalar>(i: &Inputs) -> ConicWall<S> {
    let (focus, axis) = (i.vector::<S>("focus"), i.vector::<S>("axis"));
    ConicWall {
        x: focus.x,
        y: focus.y,
        axis: (axis.x, axis.y),
        parameter: i.scalar("p"),
        eccentricity: i.scalar("e"),
        half_arc: None,
        height: i.scalar("height"),
        reflectance: i.scalar("R"),
        light: i.vector("light"),
        intensity: i.scalar("I"),
    }
}

fn glass_pillar<S: Scalar>(i: &Inputs) -> GlassPillar<S> {
    let centre = i.vector::<S>("centre");
    GlassPillar {
        x: centre.x,
        y: centre.y,
        radius: i.scalar("a"),
        height: i.scalar("height"),
        index: i.scalar("n"),
        irradiance: i.scalar("E0"),
        sin_elevation: i.scalar("sin_elevation"),
        cos_elevation: i.scalar("cos_elevation"),
    }
}

/// Interactions with the side of a glass pillar.
fn interactions(i: &Inputs) -> u32 {
    i.scalar::<f64>("interactions") as u32
}

/// The enclosure of the same quantity for exactly the same numbers.
pub fn enclosed(kind: &str, i: &Inputs) -> Option<Certified> {
    let point = vec3(
        Enclosure::point(i.x[0]),
        Enclosure::point(i.x[1]),
        Enclosure::ZERO,
    );
    if kind == "diffuse" {
        let floor = nephroid_analytic::certificate::diffuse::Floor::read(i)?;
        return Some(floor.direct_enclosed(point));
    }
    let bundle = match kind {
        "pillar" => certificate::pillar::caustic_enclosed(&pillar(i), point.x, point.y),
        "conic-wall" => certificate::conic_wall::caustic_enclosed(&conic_wall(i), point.x, point.y),
        "glass-pillar" => certificate::glass_pillar::caustic_enclosed(
            &glass_pillar(i),
            point.x,
            point.y,
            interactions(i),
        ),
        _ => return scene_enclosed(kind, i, point),
    };
    Some(bundle.total)
}

/// Of the kinds that have a reference table.
fn scene_enclosed(kind: &str, i: &Inputs, point: Point) -> Option<Certified> {
    let light = Scene::read(kind, i)?.light_enclosed(point)?;
    light.classes.first().map(|(_, bundle)| bundle.total)
}
