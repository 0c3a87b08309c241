//! Every kind of scene as a [`Model`]. Surfaces that the closed form takes as unbounded are clipped to what light and
//! camera can meet on their way to the floor.

use glam::DVec3;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{
    ArcWall, DirectionalLight, Entry, Floor, Kind, MirrorWedge, PointLight, VerticalLight,
};

use super::Plan;
use super::model::{Geometry, Light, Material, Model, Shape, round};
use super::surfaces::{cap, conic, conic_wall, dish, lens, ripples};
use crate::geometry::scene::unit;

/// What an edge of a clipped surface stays away from the paths, relative to the scene's size.
const MARGIN: f64 = 0.02;

fn shape(name: &'static str, geometry: Geometry, material: Material) -> Shape {
    Shape {
        name,
        geometry,
        material,
    }
}

fn point(light: &PointLight) -> Light {
    Light::Point {
        position: DVec3::from_array(light.position),
        intensity: light.intensity,
    }
}

fn sun(light: &DirectionalLight) -> Light {
    let (sine, cosine) = libm::sincos(light.elevation_degrees.to_radians());
    Light::Directional {
        travel: DVec3::new(cosine, 0.0, -sine),
        irradiance: light.irradiance,
    }
}

fn zenith(light: &VerticalLight) -> Light {
    Light::Directional {
        travel: DVec3::NEG_Z,
        irradiance: light.irradiance,
    }
}

fn focal(center: [f64; 2], z: f64, intensity: f64) -> Light {
    Light::Point {
        position: DVec3::new(center[0], center[1], z),
        intensity,
    }
}

fn bounds(floor: &Floor) -> [[f64; 2]; 2] {
    [0, 1].map(|k| {
        [
            floor.center[k] - floor.half_width[k],
            floor.center[k] + floor.half_width[k],
        ]
    })
}

fn floor_shape(floor: &Floor) -> Shape {
    let [x, y] = floor.center;
    let geometry = Geometry::Rectangle {
        center: DVec3::new(x, y, 0.0),
        u: DVec3::X * floor.half_width[0],
        v: DVec3::Y * floor.half_width[1],
    };
    let albedo = floor.albedo;
    shape("floor", geometry, Material::Lambert { albedo })
}

/// A horizontal rectangle, normal up or down, over the floor and everything in `reach`, widened by `extra`.
fn cover(floor: &Floor, reach: &[[f64; 3]], z: f64, extra: f64, up: bool) -> Geometry {
    let mut range = bounds(floor);
    for p in reach {
        for k in 0..2 {
            range[k] = [range[k][0].min(p[k]), range[k][1].max(p[k])];
        }
    }
    let width = range.map(|[low, high]| high - low);
    let wider = MARGIN * width[0].max(width[1]) + extra;
    let half = width.map(|w| 0.5 * w + wider);
    let middle = range.map(|[low, high]| 0.5 * (low + high));
    Geometry::Rectangle {
        center: DVec3::new(middle[0], middle[1], z),
        u: DVec3::X * half[0],
        v: DVec3::Y * if up { half[1] } else { -half[1] },
    }
}

fn arc(wall: &ArcWall) -> Shape {
    let geometry = Geometry::Cylinder {
        axis: [0.0, 0.0],
        radius: wall.radius,
        z: [0.0, wall.height],
        half_arc: wall.half_arc_degrees.to_radians(),
        inward: true,
    };
    let reflectance = wall.reflectance;
    shape("wall", geometry, Material::Mirror { reflectance })
}

fn solid_cylinder(center: [f64; 2], radius: f64, height: f64) -> Geometry {
    Geometry::Cylinder {
        axis: center,
        radius,
        z: [0.0, height],
        half_arc: std::f64::consts::PI,
        inward: false,
    }
}

fn lid(name: &'static str, center: [f64; 2], radius: f64, z: f64) -> Shape {
    let geometry = Geometry::Disk {
        center: DVec3::new(center[0], center[1], z),
        inner: 0.0,
        radius,
    };
    shape(name, geometry, Material::Black)
}

fn wedge(wedge: &MirrorWedge, reach: f64, height: f64) -> Vec<Shape> {
    let angle = std::f64::consts::PI / f64::from(wedge.divisor);
    let reflectance = wedge.reflectance;
    let wall = |name, azimuth: f64, side: f64| {
        let out = round(azimuth);
        // u × v is to the left of `out` for side = 1.
        let geometry = Geometry::Rectangle {
            center: out * (0.5 * reach) + DVec3::Z * (0.5 * height),
            u: DVec3::Z * (0.5 * height),
            v: out * (0.5 * reach * side),
        };
        shape(name, geometry, Material::Mirror { reflectance })
    };
    vec![wall("wall_a", 0.0, 1.0), wall("wall_b", angle, -1.0)]
}

/// The steepest turn of vertical light at slopes up to `slope`, as the tangent of an angle from the vertical.
fn largest_drift(slope: f64, index: f64) -> f64 {
    let incidence = libm::atan(slope);
    let refracted = libm::asin(libm::sin(incidence) / index);
    libm::tan(incidence - refracted)
}

/// The model of an entry that has passed [`Entry::validate`].
pub fn model(entry: &Entry) -> Model {
    let camera = entry.camera.clone();
    let mut camera_index = 1.0;
    let water = |index| Material::Dielectric {
        index,
        transmit_only: true,
    };
    let glass = |index| Material::Dielectric {
        index,
        transmit_only: false,
    };
    let (light, mut shapes) = match &entry.kind {
        Kind::Diffuse(s) => (point(&s.light), vec![]),
        Kind::PlanarMirror(s) => {
            let m = &s.mirror;
            let (n, e) = (
                unit(DVec3::from_array(m.normal)),
                unit(DVec3::from_array(m.edge)),
            );
            let geometry = Geometry::Rectangle {
                center: DVec3::from_array(m.center),
                u: e * m.half_width,
                v: n.cross(e) * m.half_height,
            };
            let reflectance = m.reflectance;
            (
                point(&s.light),
                vec![shape("mirror", geometry, Material::Mirror { reflectance })],
            )
        }
        Kind::CylinderCup(s) => (sun(&s.light), vec![arc(&s.wall)]),
        Kind::CylinderLamp(s) => {
            let light = Light::Point {
                position: DVec3::from_array(s.light.position(s.wall.radius)),
                intensity: s.light.intensity,
            };
            (light, vec![arc(&s.wall)])
        }
        Kind::ClosedCup(s) => {
            let wall = arc(&ArcWall {
                radius: s.wall.radius,
                height: s.wall.height,
                half_arc_degrees: 180.0,
                reflectance: s.wall.reflectance,
            });
            (sun(&s.light), vec![wall])
        }
        Kind::FlatInterface(s) => {
            let reach = [s.light.position, camera.position];
            let surface = cover(&s.floor, &reach, s.water.surface_z, 0.0, true);
            (
                point(&s.light),
                vec![shape("water", surface, water(s.water.index))],
            )
        }
        Kind::Underwater(s) => {
            camera_index = s.water.index;
            let surface = cover(&s.floor, &[s.light.position], s.water.surface_z, 0.0, true);
            (
                point(&s.light),
                vec![shape("water", surface, water(s.water.index))],
            )
        }
        Kind::WaterWaves(s) => {
            camera_index = s.water.index;
            let steepest = s.waves.iter().fold(0.0, |sum, w| {
                sum + w.amplitude.abs() * libm::hypot(w.wave_vector[0], w.wave_vector[1])
            });
            let highest = s
                .waves
                .iter()
                .fold(s.water.surface_z, |sum, w| sum + w.amplitude.abs());
            let extra = highest * largest_drift(steepest, s.water.index);
            let flat = cover(&s.floor, &[], s.water.surface_z, extra, true);
            let surface = ripples(flat, s.water.surface_z, &s.waves);
            (
                zenith(&s.light),
                vec![shape("water", surface, water(s.water.index))],
            )
        }
        Kind::GlassSlab(s) => {
            let reach = [s.light.position];
            let top = cover(&s.floor, &reach, s.slab.top, 0.0, true);
            let bottom = cover(&s.floor, &reach, s.slab.bottom, 0.0, false);
            let material = glass(s.slab.index);
            (
                point(&s.light),
                vec![
                    shape("slab_top", top, material),
                    shape("slab_bottom", bottom, material),
                ],
            )
        }
        Kind::GlassSphere(s) => {
            let ball = Geometry::Sphere {
                center: DVec3::from_array(s.glass.center),
                radius: s.glass.radius,
                inward: false,
            };
            (
                zenith(&s.light),
                vec![shape("ball", ball, glass(s.glass.index))],
            )
        }
        Kind::GlassPillar(s) => {
            let p = &s.pillar;
            let side = shape(
                "pillar",
                solid_cylinder(p.center, p.radius, p.height),
                glass(p.index),
            );
            // The floor under the glass absorbs: a disk so little above it that single precision still tells the two apart.
            let bottom = lid("pillar_bottom", p.center, p.radius, 2e-5 * p.height);
            (
                sun(&s.light),
                vec![
                    side,
                    lid("pillar_top", p.center, p.radius, p.height),
                    bottom,
                ],
            )
        }
        Kind::StigmaticRefractors(s) => {
            camera_index = s.lens.index;
            let (front, rim) = lens(&s.lens);
            let [x, y] = s.lens.center;
            let screen = Geometry::Disk {
                center: DVec3::new(x, y, s.lens.rim_z()),
                inner: rim,
                radius: (1.0 + MARGIN) * (rim + s.floor.farthest([x, y])),
            };
            (
                zenith(&s.light),
                vec![
                    shape("lens", front, water(s.lens.index)),
                    shape("screen", screen, Material::Black),
                ],
            )
        }
        Kind::Pillar(s) => {
            let p = &s.pillar;
            let reflectance = p.reflectance;
            let side = shape(
                "pillar",
                solid_cylinder(p.center, p.radius, p.height),
                Material::Mirror { reflectance },
            );
            (
                point(&s.light),
                vec![side, lid("pillar_top", p.center, p.radius, p.height)],
            )
        }
        Kind::ConicWall(s) => {
            let reflectance = s.wall.reflectance;
            (
                point(&s.light),
                vec![shape(
                    "wall",
                    conic_wall(&s.wall),
                    Material::Mirror { reflectance },
                )],
            )
        }
        Kind::PlanarChains(s) => {
            let [x, y, z] = s.light.position;
            let reach = libm::hypot(x, y).max(s.floor.farthest([0.0, 0.0]));
            (
                point(&s.light),
                wedge(&s.wedge, (1.0 + MARGIN) * reach, (1.0 + MARGIN) * z),
            )
        }
        Kind::ConcaveSphere(s) => {
            let reflectance = s.cap.reflectance;
            (
                point(&s.light),
                vec![shape("cap", cap(&s.cap), Material::Mirror { reflectance })],
            )
        }
        Kind::ConvexSphere(s) => {
            let ball = Geometry::Sphere {
                center: DVec3::from_array(s.ball.center),
                radius: s.ball.radius,
                inward: false,
            };
            let reflectance = s.ball.reflectance;
            (
                point(&s.light),
                vec![shape("ball", ball, Material::Mirror { reflectance })],
            )
        }
        Kind::Paraboloid(s) => {
            let reflectance = s.dish.reflectance;
            let light = focal(s.dish.center, s.dish.focus_z(), s.light.intensity);
            (
                light,
                vec![shape(
                    "dish",
                    dish(&s.dish),
                    Material::Mirror { reflectance },
                )],
            )
        }
        Kind::ConicMirrors(s) => {
            let reflectance = s.conic.reflectance;
            let light = focal(s.conic.center, s.conic.light_z(), s.light.intensity);
            (
                light,
                vec![shape(
                    "conic",
                    conic(&s.conic),
                    Material::Mirror { reflectance },
                )],
            )
        }
        Kind::Furnace(s) => {
            let wall = Geometry::Sphere {
                center: DVec3::from_array(s.wall.center),
                radius: s.wall.radius,
                inward: true,
            };
            let albedo = s.wall.albedo;
            (
                point(&s.light),
                vec![shape("wall", wall, Material::Lambert { albedo })],
            )
        }
    };
    let floor = entry.kind.floor();
    shapes.splice(0..0, floor.map(floor_shape));
    let compared = Plan::new(entry).comparable;
    let chain = |c: &PathClass| c.light.len().max(c.eye.len());
    Model {
        light,
        shapes,
        camera,
        camera_index,
        floor: floor.map(bounds),
        longest_chain: compared.iter().map(chain).max().unwrap_or(0),
    }
}
