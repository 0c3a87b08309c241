//! From a validated entry to the surface that its single specular interactions are on.

use glam::{DVec2, DVec3};
use nephroid_analytic::scene::{ArcWall, Entry, Kind, RectangleMirror, WaterWavesScene};

use super::Manifold;
use super::patch::Patch;
use super::quadric::Quadric;
use super::waves::Waves;
use crate::geometry::scene::unit;

/// A surface to walk on, and what happens there.
pub struct Surface {
    /// Its smooth parts: walks stay on the one that they start on.
    pub parts: Vec<Box<dyn Manifold>>,
    /// Index of the medium of the floor relative to the light's; 1 where light is reflected.
    pub index: f64,
}

impl Surface {
    fn of(manifold: impl Manifold + 'static, index: f64) -> Self {
        Surface {
            parts: vec![Box::new(manifold)],
            index,
        }
    }

    fn mirror(manifold: impl Manifold + 'static) -> Self {
        Surface::of(manifold, 1.0)
    }
}

/// The surface of an entry on which light is reflected or refracted once on its way to the floor; `None` without one.
pub fn surface(entry: &Entry) -> Option<Surface> {
    Some(match &entry.kind {
        Kind::Diffuse(_) | Kind::Furnace(_) | Kind::GlassSlab(_) => return None,
        Kind::PlanarMirror(s) => Surface::mirror(rectangle(&s.mirror)),
        Kind::CylinderCup(s) => Surface::mirror(arc(&s.wall)),
        Kind::CylinderLamp(s) => Surface::mirror(arc(&s.wall)),
        Kind::ClosedCup(s) => Surface::mirror(cylinder(DVec2::ZERO, s.wall.radius, s.wall.height)),
        Kind::Pillar(s) => {
            let p = &s.pillar;
            Surface::mirror(cylinder(DVec2::from_array(p.center), p.radius, p.height))
        }
        Kind::GlassPillar(s) => {
            let p = &s.pillar;
            Surface::mirror(cylinder(DVec2::from_array(p.center), p.radius, p.height))
        }
        Kind::ConicWall(s) => {
            let w = &s.wall;
            let (e, p) = (w.eccentricity, w.parameter);
            let axis = DVec2::from_array(w.direction);
            let axis = axis / f64::sqrt(axis.dot(axis));
            let focus = DVec2::from_array(w.focus);
            // |q|² = (p - e x)²: (1 - e²) x² + y² + 2 p e x - p² = 0 about the focus.
            Surface::mirror(Quadric {
                center: focus.extend(0.0),
                axes: [axis.extend(0.0), axis.perp().extend(0.0), DVec3::Z],
                square: DVec3::new(1.0 - e * e, 1.0, 0.0),
                linear: axis.extend(0.0) * (p * e),
                patch: Patch::Wall {
                    focus,
                    axis,
                    parameter: p,
                    eccentricity: e,
                    half_arc: w.half_arc_degrees.to_radians(),
                    height: w.height,
                },
            })
        }
        Kind::PlanarChains(s) => wedge(s.wedge.divisor, &s.floor, &s.light),
        Kind::ConcaveSphere(s) => {
            let c = &s.cap;
            let rim = c.radius * libm::cos(c.half_angle_degrees.to_radians());
            Surface::mirror(sphere(c.center, c.radius, rim))
        }
        Kind::ConvexSphere(s) => {
            Surface::mirror(sphere(s.ball.center, s.ball.radius, -s.ball.radius))
        }
        Kind::GlassSphere(s) => {
            Surface::mirror(sphere(s.glass.center, s.glass.radius, -s.glass.radius))
        }
        Kind::Paraboloid(s) => {
            let d = &s.dish;
            // r² + 4f (z - v) = 0 about the vertex.
            let latus = 4.0 * d.focal_length;
            let height = |r: f64| -r * r / latus;
            let center = DVec3::new(d.center[0], d.center[1], d.vertex_z);
            let heights = [height(d.outer_radius), height(d.inner_radius)];
            let square = DVec3::new(1.0, 1.0, 0.0);
            let linear = DVec3::new(0.0, 0.0, 0.5 * latus);
            Surface::mirror(revolution(
                center,
                square,
                linear,
                heights,
                [0.0, -latus, 0.0],
            ))
        }
        Kind::ConicMirrors(s) => {
            let c = &s.conic;
            let (a, e) = (c.semi_axis, c.eccentricity);
            // r²/(1 - e²) + z² = a² about the centre, which is ae from the image.
            let is_ellipsoid = e < 1.0;
            let center_z = c.image_z + if is_ellipsoid { a * e } else { -a * e };
            let rim = c.rim_z - center_z;
            let heights = if is_ellipsoid { [rim, a] } else { [a, rim] };
            let flat = 1.0 - e * e;
            let center = DVec3::new(c.center[0], c.center[1], center_z);
            let square = DVec3::new(1.0 / flat, 1.0 / flat, 1.0);
            let profile = [flat * a * a, 0.0, -flat];
            Surface::mirror(revolution(center, square, DVec3::ZERO, heights, profile))
        }
        Kind::FlatInterface(s) => water(s.water.surface_z, s.water.index, s.light.position),
        Kind::Underwater(s) => water(s.water.surface_z, s.water.index, s.light.position),
        Kind::WaterWaves(s) => Surface::of(waves(s), s.water.index),
        Kind::StigmaticRefractors(s) => {
            let l = &s.lens;
            // r²/b² + z²/a² = 1 about the centre, b² = a² (1 - 1/n²); the farther focus is at the height `defocus`.
            let (a, n) = (l.semi_axis, l.index);
            let flat = 1.0 - 1.0 / (n * n);
            let center = DVec3::new(l.center[0], l.center[1], l.defocus + a / n);
            let square = DVec3::new(1.0 / flat, 1.0 / flat, 1.0);
            let profile = [flat * a * a, 0.0, -flat];
            // |p| = a (1 - 1/n²)/(1 - cos θ/n) from that focus, as far down as the half angle.
            let cosine = libm::cos(l.half_angle_degrees.to_radians());
            let rim = a * flat / (1.0 - cosine / n) * cosine - a / n;
            Surface::of(
                revolution(center, square, DVec3::ZERO, [rim, a], profile),
                n,
            )
        }
    })
}

fn rectangle(mirror: &RectangleMirror) -> Quadric {
    let normal = unit(DVec3::from_array(mirror.normal));
    let across = unit(DVec3::from_array(mirror.edge));
    let along = normal.cross(across);
    let center = DVec3::from_array(mirror.center);
    let edges = [across * mirror.half_width, along * mirror.half_height];
    Quadric::plane(center, normal, Patch::Flat(center, edges))
}

fn cylinder(center: DVec2, radius: f64, height: f64) -> Quadric {
    Quadric {
        center: center.extend(0.0),
        axes: DVec3::AXES,
        square: DVec3::new(1.0, 1.0, 0.0),
        linear: DVec3::ZERO,
        patch: Patch::cylinder(center, radius, height),
    }
}

fn arc(wall: &ArcWall) -> Quadric {
    let mut arc = cylinder(DVec2::ZERO, wall.radius, wall.height);
    if let Patch::Wall { half_arc, .. } = &mut arc.patch {
        *half_arc = wall.half_arc_degrees.to_radians();
    }
    arc
}

/// A sphere, of which the part above a height over its centre is the surface.
fn sphere(center: [f64; 3], radius: f64, lowest: f64) -> Quadric {
    revolution(
        DVec3::from_array(center),
        DVec3::ONE,
        DVec3::ZERO,
        [lowest, radius],
        [radius * radius, 0.0, -1.0],
    )
}

fn revolution(
    center: DVec3,
    square: DVec3,
    linear: DVec3,
    heights: [f64; 2],
    profile: [f64; 3],
) -> Quadric {
    Quadric {
        center,
        axes: DVec3::AXES,
        square,
        linear,
        patch: Patch::Revolution {
            center,
            heights,
            profile,
        },
    }
}

/// Refraction at a flat interface is in the vertical plane of floor point and light, between the two.
fn water(surface_z: f64, index: f64, light: [f64; 3]) -> Surface {
    let center = DVec3::new(0.0, 0.0, surface_z);
    let patch = Patch::Between(surface_z, DVec2::new(light[0], light[1]));
    Surface::of(Quadric::plane(center, DVec3::Z, patch), index)
}

fn waves(scene: &WaterWavesScene) -> Waves {
    let waves: Vec<_> = scene
        .waves
        .iter()
        .map(|w| (w.amplitude, DVec2::from_array(w.wave_vector), w.phase))
        .collect();
    let sum = |of: fn(&(f64, DVec2, f64)) -> f64| -> f64 { waves.iter().map(of).sum() };
    let top = scene.water.surface_z + sum(|w| f64::abs(w.0));
    let steepest = libm::atan(sum(|w| f64::abs(w.0) * f64::sqrt(w.1.dot(w.1))));
    // Vertical light turns by no more than the steepest slope makes it.
    let lean = steepest - libm::asin(libm::sin(steepest) / scene.water.index);
    Waves {
        surface_z: scene.water.surface_z,
        reach: top * libm::tan(lean),
        waves,
    }
}

/// Two vertical mirrors that meet in the z axis, as far from it and as high as light between the lamp and the floor can
/// come.
fn wedge(
    divisor: u32,
    floor: &nephroid_analytic::scene::Floor,
    light: &nephroid_analytic::scene::PointLight,
) -> Surface {
    let [x, y, height] = light.position;
    let far = |k: usize| f64::abs(floor.center[k]) + floor.half_width[k];
    let corner = libm::hypot(far(0), far(1));
    let reach = corner.max(libm::hypot(x, y));
    let (sine, cosine) = libm::sincos(core::f64::consts::PI / f64::from(divisor));
    let part = |along: DVec3, normal: DVec3| -> Box<dyn Manifold> {
        let half = [along * (0.5 * reach), DVec3::Z * (0.5 * height)];
        Box::new(Quadric::plane(
            DVec3::ZERO,
            normal,
            Patch::Flat(half[0] + half[1], half),
        ))
    };
    Surface {
        parts: vec![
            part(DVec3::X, DVec3::Y),
            part(
                DVec3::new(cosine, sine, 0.0),
                DVec3::new(sine, -cosine, 0.0),
            ),
        ],
        index: 1.0,
    }
}
