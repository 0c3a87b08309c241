//! Every kind of scene as a [`Model`]. Surfaces that the closed form takes as unbounded are clipped to what light and
//! camera can meet on their way to the floor.

use std::sync::Arc;

use glam::DVec3;
use nephroid_analytic::scene::{
    ArcWall, Conic, ConicArc, DirectionalLight, Dish, Entry, Floor, Kind, LensFront, MirrorWedge,
    PointLight, Ripple, SphereCap, VerticalLight,
};

use super::model::{Geometry, Light, Material, Model, Patch, Shape, round};
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

fn conic_wall(wall: &ConicArc) -> Geometry {
    let (cx, cy) = wall.axis();
    let (along, across) = (DVec3::new(cx, cy, 0.0), DVec3::new(-cy, cx, 0.0));
    let [fx, fy] = wall.focus;
    let end = wall.half_arc().unwrap_or(std::f64::consts::PI);
    let (p, e, height) = (wall.parameter, wall.eccentricity, wall.height);
    Geometry::Patch(Patch {
        at: Arc::new(move |s, t| {
            let (sine, cosine) = libm::sincos(end * (2.0 * s - 1.0));
            let r = p / (1.0 + e * cosine);
            // The gradient of |q| + e x is the outer normal; the focus is on the inner side.
            let inner = -unit(along * (cosine + e) + across * sine);
            let q = (along * cosine + across * sine) * r;
            (DVec3::new(fx, fy, height * t) + q, inner)
        }),
        ruled: true,
    })
}

fn cap(cap: &SphereCap) -> Geometry {
    let (center, radius) = (DVec3::from_array(cap.center), cap.radius);
    let end = cap.half_angle_degrees.to_radians();
    revolved(
        move |t| {
            let (sine, cosine) = libm::sincos(end * t);
            (
                [radius * sine, center.z + radius * cosine],
                [-sine, -cosine],
            )
        },
        [center.x, center.y],
    )
}

/// A surface of revolution about a vertical axis: from a parameter to (r, z) and the normal's components there.
fn revolved(
    profile: impl Fn(f64) -> ([f64; 2], [f64; 2]) + Send + Sync + 'static,
    [x, y]: [f64; 2],
) -> Geometry {
    Geometry::Patch(Patch {
        at: Arc::new(move |s, t| {
            let ([r, z], [nr, nz]) = profile(t);
            let out = round(std::f64::consts::TAU * s);
            let normal = unit(out * nr + DVec3::Z * nz);
            (DVec3::new(x, y, z) + out * r, normal)
        }),
        ruled: false,
    })
}

fn dish(dish: &Dish) -> Geometry {
    let (inner, outer) = (dish.inner_radius, dish.outer_radius);
    let (four_f, vertex) = (4.0 * dish.focal_length, dish.vertex_z);
    revolved(
        move |t| {
            let r = inner + (outer - inner) * t;
            ([r, vertex - r * r / four_f], [-2.0 * r / four_f, -1.0])
        },
        dish.center,
    )
}

fn conic(conic: &Conic) -> Geometry {
    let (a, e, center_z) = (conic.semi_axis, conic.eccentricity, conic.center_z());
    let rim = (conic.rim_z - center_z) / a;
    let b = a * libm::sqrt(f64::abs(1.0 - e * e));
    let ellipsoid = conic.is_ellipsoid();
    // Eccentric anomaly of the rim: z = a cos τ, r = b sin τ, or the hyperbolic functions.
    let end = if ellipsoid {
        libm::acos(rim)
    } else {
        libm::acosh(rim)
    };
    revolved(
        move |t| {
            let tau = end * t;
            if ellipsoid {
                let (sine, cosine) = libm::sincos(tau);
                // Inwards.
                ([b * sine, center_z + a * cosine], [-a * sine, -b * cosine])
            } else {
                let (sine, cosine) = (libm::sinh(tau), libm::cosh(tau));
                // Downwards, the convex side.
                ([b * sine, center_z + a * cosine], [a * sine, -b * cosine])
            }
        },
        conic.center,
    )
}

/// The front of the lens, and the radius of its rim.
fn lens(lens: &LensFront) -> (Geometry, f64) {
    let n = lens.index;
    let a = lens.semi_axis;
    let (defocus, end) = (lens.defocus, lens.half_angle_degrees.to_radians());
    // The ellipse r = a (1 - 1/n²)/(1 - cos ψ/n) about its lower focus.
    let profile = move |t: f64| {
        let (sine, cosine) = libm::sincos(end * t);
        let distance = a * (n - 1.0) * (n + 1.0) / (n * (n - cosine));
        // The normal is along n (unit ray from the focus) - (the axis): refraction makes the one of the other.
        (
            [distance * sine, defocus + distance * cosine],
            [n * sine, n * cosine - 1.0],
        )
    };
    let ([rim, _], _) = profile(1.0);
    (revolved(profile, lens.center), rim)
}

fn ripples(base: Geometry, z: f64, waves: &[Ripple]) -> Geometry {
    let Geometry::Rectangle { center, u, v } = base else {
        return base;
    };
    let waves = waves.to_vec();
    Geometry::Patch(Patch {
        at: Arc::new(move |s, t| {
            let p = center + u * (2.0 * s - 1.0) + v * (2.0 * t - 1.0);
            let (mut height, mut slope) = (z, DVec3::ZERO);
            for wave in &waves {
                let [kx, ky] = wave.wave_vector;
                let (sine, cosine) = libm::sincos(kx * p.x + ky * p.y + wave.phase);
                height += wave.amplitude * cosine;
                slope -= DVec3::new(kx, ky, 0.0) * (wave.amplitude * sine);
            }
            (DVec3::new(p.x, p.y, height), unit(DVec3::Z - slope))
        }),
        ruled: false,
    })
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
    let chains = entry.kind.classes().iter();
    Model {
        light,
        shapes,
        camera,
        camera_index,
        floor: floor.map(bounds),
        longest_chain: chains
            .map(|c| c.light.len().max(c.eye.len()))
            .max()
            .unwrap_or(0),
    }
}
