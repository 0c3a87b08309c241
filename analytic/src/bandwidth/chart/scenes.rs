//! The mollified vertices of every kind whose light is connected through one specular interaction.

use std::sync::Arc;

use libm::{acos, atan2, cos, hypot, sin, tan};

use super::connection::{Caustic, Interaction, Source};
use super::surfaces::{FocalConic, HeightField, Level, Rectangle, SphereCap, Surface, frame_of};
use super::walls::{ConicWall, Cylinder};
use crate::bandwidth::light::photons as flux_of;
use crate::class::PathClass;
use crate::kinds::flat_interface::FlatInterface;
use crate::kinds::sphere_mirror::{Light, Side, SphereMirror};
use crate::scene::{ArcWall, DirectionalLight, Floor, FocalLight, Kind, PointLight, VerticalLight};
use crate::vector::{Vec3, vec3};

fn point(light: &PointLight) -> Source {
    Source::Point(Vec3::from_f64(light.position), light.intensity)
}

fn focal(light: &FocalLight, [x, y]: [f64; 2], z: f64) -> Source {
    Source::Point(vec3(x, y, z), light.intensity)
}

fn beam(light: &DirectionalLight) -> Source {
    let elevation = light.elevation_degrees.to_radians();
    Source::Beam(vec3(cos(elevation), 0.0, -sin(elevation)), light.irradiance)
}

fn vertical(light: &VerticalLight) -> Source {
    Source::Beam(vec3(0.0, 0.0, -1.0), light.irradiance)
}

/// The light of a kind with specular surfaces.
pub(super) fn source(kind: &Kind) -> Option<Source> {
    Some(match kind {
        Kind::Diffuse(_) | Kind::Furnace(_) => return None,
        Kind::PlanarMirror(s) => point(&s.light),
        Kind::CylinderCup(s) => beam(&s.light),
        Kind::FlatInterface(s) => point(&s.light),
        Kind::GlassSlab(s) => point(&s.light),
        Kind::Pillar(s) => point(&s.light),
        Kind::ConicWall(s) => point(&s.light),
        Kind::GlassPillar(s) => beam(&s.light),
        Kind::PlanarChains(s) => point(&s.light),
        Kind::ConcaveSphere(s) => point(&s.light),
        Kind::ConvexSphere(s) => point(&s.light),
        Kind::Paraboloid(s) => focal(&s.light, s.dish.center, s.dish.focus_z()),
        Kind::ConicMirrors(s) => focal(&s.light, s.conic.center, s.conic.light_z()),
        Kind::Underwater(s) => point(&s.light),
        Kind::GlassSphere(s) => vertical(&s.light),
        Kind::WaterWaves(s) => vertical(&s.light),
        Kind::StigmaticRefractors(s) => vertical(&s.light),
        Kind::CylinderLamp(s) => Source::Point(
            Vec3::from_f64(s.light.position(s.wall.radius)),
            s.light.intensity,
        ),
        Kind::ClosedCup(s) => beam(&s.light),
    })
}

/// Whether the light is parallel.
pub(in crate::bandwidth) fn is_beam(kind: &Kind) -> bool {
    matches!(source(kind), Some(Source::Beam(..)))
}

/// Flux of all photons [W]: 4πI of a point light, or what a beam carries through `beam_area` [m²].
pub(in crate::bandwidth) fn photons(kind: &Kind, beam_area: f64) -> Option<f64> {
    source(kind).map(|s| flux_of(&s, beam_area))
}

/// The light of a class `L S D` by its mollified vertex; `None` where there is no such form.
pub(in crate::bandwidth) fn caustics(
    kind: &Kind,
    class: PathClass,
    beam_area: f64,
) -> Option<Vec<Caustic>> {
    if class.light.len() != 1 {
        return None;
    }
    let source = source(kind)?;
    let caustic = |(surface, interaction)| Caustic {
        photons: flux_of(&source, beam_area),
        source,
        surface,
        interaction,
    };
    if let Kind::ConcaveSphere(s) = kind {
        let up = vec3(0.0, 0.0, 1.0);
        let angle = s.cap.half_angle_degrees.to_radians();
        let parts = SphereCap::inside(Vec3::from_f64(s.cap.center), s.cap.radius, up, angle);
        let mirror = |part| (shared(part), Interaction::Mirror(s.cap.reflectance));
        return Some(parts.into_iter().map(mirror).map(caustic).collect());
    }
    Some(vec![caustic(single(kind)?)])
}

fn shared(surface: impl Surface + 'static) -> Arc<dyn Surface> {
    Arc::new(surface)
}

/// The one surface of a kind, and what it does.
fn single(kind: &Kind) -> Option<(Arc<dyn Surface>, Interaction)> {
    Some(match kind {
        Kind::PlanarMirror(s) => {
            let (m, normal) = (&s.mirror, Vec3::from_f64(s.mirror.normal).normalized());
            let along = Vec3::from_f64(m.edge).normalized();
            let mirror = Rectangle {
                center: Vec3::from_f64(m.center),
                half: [along * m.half_width, normal.cross(along) * m.half_height],
                normal,
            };
            (Arc::new(mirror), Interaction::Mirror(m.reflectance))
        }
        Kind::ConvexSphere(s) => {
            let center = Vec3::from_f64(s.ball.center);
            let ball = ball(center, s.ball.radius, &point(&s.light));
            (Arc::new(ball), Interaction::Mirror(s.ball.reflectance))
        }
        Kind::CylinderCup(s) => cup(&s.wall),
        Kind::CylinderLamp(s) => cup(&s.wall),
        Kind::Pillar(s) => {
            let [x, y, _] = s.light.position;
            let (dx, dy) = (x - s.pillar.center[0], y - s.pillar.center[1]);
            // Only what is in front of the tangents from the light is lit.
            let (at, half) = (atan2(dy, dx), acos(s.pillar.radius / hypot(dx, dy)));
            let wall = Cylinder {
                center: s.pillar.center,
                radius: s.pillar.radius,
                side: 1.0,
                azimuth: [at - half, at + half],
                height: s.pillar.height,
                half_arc: 0.0,
            };
            (Arc::new(wall), Interaction::Mirror(s.pillar.reflectance))
        }
        Kind::ConicWall(s) => {
            let (c, sn) = s.wall.axis();
            let half = s.wall.half_arc().unwrap_or(core::f64::consts::PI);
            let wall = ConicWall {
                focus: s.wall.focus,
                axis: [c, sn],
                parameter: s.wall.parameter,
                eccentricity: s.wall.eccentricity,
                half_arc: half,
                height: s.wall.height,
            };
            (Arc::new(wall), Interaction::Mirror(s.wall.reflectance))
        }
        Kind::FlatInterface(s) => (
            Arc::new(level(s.water.surface_z, &s.light, &s.floor)),
            Interaction::Interface(s.water.index),
        ),
        Kind::Underwater(s) => (
            Arc::new(level(s.water.surface_z, &s.light, &s.floor)),
            Interaction::Interface(s.water.index),
        ),
        Kind::WaterWaves(s) => {
            let (mean, waves) = (s.water.surface_z, s.waves.clone());
            let form = s.ripples().ok()?;
            // Refracted light stays within the reach; what a wide kernel connects from farther away goes up to the horizon.
            let reach = form.reach() + WIDEST * mean;
            let domain = [0, 1].map(|k| {
                let (center, half) = (s.floor.center[k], s.floor.half_width[k]);
                [center - half - reach, center + half + reach]
            });
            let height = move |u: [f64; 2]| {
                let (mut z, mut g) = (mean, [0.0; 2]);
                for w in &waves {
                    let phase = w.wave_vector[0] * u[0] + w.wave_vector[1] * u[1] + w.phase;
                    z += w.amplitude * cos(phase);
                    for (g, k) in g.iter_mut().zip(w.wave_vector) {
                        *g -= w.amplitude * k * sin(phase);
                    }
                }
                (z, g, [1.0; 2])
            };
            let surface = HeightField {
                domain,
                side: 1.0,
                height,
                dish: None,
            };
            (Arc::new(surface), Interaction::Interface(s.water.index))
        }
        Kind::Paraboloid(s) => {
            let dish = s.dish.clone();
            let ([cx, cy], reach) = (dish.center, dish.outer_radius);
            let height = move |u: [f64; 2]| {
                let (x, y) = (u[0] - dish.center[0], u[1] - dish.center[1]);
                let (square, f) = (x * x + y * y, dish.focal_length);
                let rim = dish.outer_radius * dish.outer_radius;
                let hole = dish.inner_radius * dish.inner_radius;
                (
                    dish.vertex_z - square / (4.0 * f),
                    [-x / (2.0 * f), -y / (2.0 * f)],
                    [rim - square, if hole > 0.0 { square - hole } else { 1.0 }],
                )
            };
            let surface = HeightField {
                domain: [[cx - reach, cx + reach], [cy - reach, cy + reach]],
                side: -1.0,
                height,
                dish: Some(([cx, cy], s.dish.focal_length, [s.dish.inner_radius, reach])),
            };
            (Arc::new(surface), Interaction::Mirror(s.dish.reflectance))
        }
        Kind::ConicMirrors(s) => {
            let (conic, e) = (&s.conic, s.conic.eccentricity);
            let rim = [conic.rim_z, conic.rim_radius()];
            let focus = vec3(conic.center[0], conic.center[1], conic.light_z());
            let surface = FocalConic {
                focus,
                parameter: conic.semi_axis * f64::abs(1.0 - e * e),
                alpha: if conic.is_ellipsoid() { 1.0 } else { -1.0 },
                beta: e,
                side: -1.0,
                rim: tan(0.5 * atan2(rim[1], rim[0] - focus.z)),
                rim_at: rim,
                screen: false,
            };
            (Arc::new(surface), Interaction::Mirror(conic.reflectance))
        }
        Kind::StigmaticRefractors(s) => {
            let (lens, n) = (&s.lens, s.lens.index);
            let angle = lens.half_angle_degrees.to_radians();
            let surface = FocalConic {
                focus: vec3(lens.center[0], lens.center[1], lens.defocus),
                parameter: lens.semi_axis * (1.0 - 1.0 / n) * (1.0 + 1.0 / n),
                alpha: 1.0,
                beta: -1.0 / n,
                side: 1.0,
                rim: tan(0.5 * angle),
                rim_at: [lens.rim_z(), (lens.rim_z() - lens.defocus) * tan(angle)],
                screen: true,
            };
            (Arc::new(surface), Interaction::Interface(n))
        }
        _ => return None,
    })
}

/// The inner side of a wall about the z axis.
fn cup(wall: &ArcWall) -> (Arc<dyn Surface>, Interaction) {
    let half_arc = wall.half_arc_degrees.to_radians();
    let side = Cylinder {
        center: [0.0; 2],
        radius: wall.radius,
        side: -1.0,
        azimuth: [-half_arc, half_arc],
        height: wall.height,
        half_arc,
    };
    (Arc::new(side), Interaction::Mirror(wall.reflectance))
}

/// How far a connection under water may go sideways, in depths: kernels that reach farther are cut there.
const WIDEST: f64 = 4.0;

fn level(height: f64, light: &PointLight, floor: &Floor) -> Level {
    let half = floor.half_width;
    Level {
        height,
        center: floor.center,
        distance: half[0].max(half[1]).max(height + light.position[2]),
        side: 1.0,
    }
}

/// The part of a ball that the light sees.
fn ball(center: Vec3<f64>, radius: f64, source: &Source) -> SphereCap {
    let (axis, rim) = match source {
        Source::Point(y, _) => {
            let d = *y - center;
            let length = d.length();
            (d * (1.0 / length), tan(0.5 * acos(radius / length)))
        }
        Source::Beam(d, _) => (-*d, 1.0),
    };
    SphereCap {
        center,
        radius,
        frame: frame_of(axis),
        side: 1.0,
        rim,
        hole: 0.0,
        whole: (axis, 1.0),
    }
}

/// A spherical mirror of the theory's tables. The photons of parallel light are uniform over the sphere's cross-section.
pub(in crate::bandwidth) fn sphere(mirror: &SphereMirror<f64>) -> Vec<Caustic> {
    let source = match mirror.light {
        Light::Point {
            position,
            intensity,
        } => Source::Point(position, intensity),
        Light::Beam {
            direction,
            irradiance,
        } => Source::Beam(direction, irradiance),
    };
    let (center, radius) = (mirror.centre, mirror.radius);
    let surfaces = match mirror.side {
        Side::Convex => vec![ball(center, radius, &source)],
        Side::Concave => {
            SphereCap::inside(center, radius, mirror.cap_axis, acos(mirror.cap_cos_min))
        }
    };
    let cross_section = core::f64::consts::PI * radius * radius;
    let caustic = |surface| Caustic {
        photons: flux_of(&source, cross_section),
        source,
        surface: shared(surface),
        interaction: Interaction::Mirror(mirror.reflectance),
    };
    surfaces.into_iter().map(caustic).collect()
}

/// A flat interface of the theory's tables; `None` where the light is reflected.
pub(in crate::bandwidth) fn interface(form: &FlatInterface<f64>) -> Option<Caustic> {
    if !form.is_refracted() {
        return None;
    }
    let source = Source::Point(form.light, form.intensity);
    let above = form.light.z > form.surface_z;
    let scale =
        f64::abs(form.light.z - form.surface_z) + f64::abs(form.receiver_z - form.surface_z);
    Some(Caustic {
        photons: flux_of(&source, 0.0),
        source,
        surface: Arc::new(Level {
            height: form.surface_z,
            center: [form.light.x, form.light.y],
            distance: scale,
            side: if above { 1.0 } else { -1.0 },
        }),
        interaction: Interaction::Interface(if above { form.index } else { 1.0 / form.index }),
    })
}

/// The diagonal of the box of all clipped surfaces and point lights [m]; `None` with an unbounded surface.
pub(in crate::bandwidth) fn diagonal(kind: &Kind) -> Option<f64> {
    let floor = kind.floor()?;
    let (c, h) = (floor.center, floor.half_width);
    let mut low = vec3(c[0] - h[0], c[1] - h[1], 0.0);
    let mut high = vec3(c[0] + h[0], c[1] + h[1], 0.0);
    let mut add = |p: Vec3<f64>| {
        low = vec3(low.x.min(p.x), low.y.min(p.y), low.z.min(p.z));
        high = vec3(high.x.max(p.x), high.y.max(p.y), high.z.max(p.z));
    };
    if let Source::Point(y, _) = source(kind)? {
        add(y);
    }
    match kind {
        Kind::PlanarMirror(s) => {
            let (m, normal) = (&s.mirror, Vec3::from_f64(s.mirror.normal).normalized());
            let along = Vec3::from_f64(m.edge).normalized();
            let (u, v) = (along * m.half_width, normal.cross(along) * m.half_height);
            for corner in [u + v, u - v, v - u, -u - v] {
                add(Vec3::from_f64(m.center) + corner);
            }
            return Some((high - low).length());
        }
        Kind::ConicWall(s) => {
            for p in s.wall.corners() {
                add(Vec3::from_f64(p));
            }
            return Some((high - low).length());
        }
        _ => {}
    }
    // A horizontal disc, or a vertical arc of a circle between two azimuths, with its height range.
    let mut disc = |[x, y]: [f64; 2], r: f64, z: [f64; 2]| {
        add(vec3(x - r, y - r, z[0]));
        add(vec3(x + r, y + r, z[1]));
    };
    match kind {
        Kind::ConcaveSphere(s) => {
            let [x, y, z] = s.cap.center;
            let angle = s.cap.half_angle_degrees.to_radians();
            let widest = if angle < core::f64::consts::FRAC_PI_2 {
                s.cap.radius * sin(angle)
            } else {
                s.cap.radius
            };
            disc([x, y], widest, [s.cap.rim_z(), z + s.cap.radius]);
        }
        Kind::ConvexSphere(s) => {
            let ([x, y, z], r) = (s.ball.center, s.ball.radius);
            disc([x, y], r, [z - r, z + r]);
        }
        Kind::Pillar(s) => disc(s.pillar.center, s.pillar.radius, [0.0, s.pillar.height]),
        Kind::CylinderCup(s) => {
            let (a, half) = (s.wall.radius, s.wall.half_arc_degrees.to_radians());
            arc(a, half, s.wall.height).into_iter().for_each(&mut add);
        }
        Kind::CylinderLamp(s) => {
            let (a, half) = (s.wall.radius, s.wall.half_arc_degrees.to_radians());
            arc(a, half, s.wall.height).into_iter().for_each(&mut add);
        }
        Kind::ClosedCup(s) => disc([0.0; 2], s.wall.radius, [0.0, s.wall.height]),
        Kind::GlassPillar(s) => disc(s.pillar.center, s.pillar.radius, [0.0, s.pillar.height]),
        Kind::GlassSphere(s) => {
            let ([x, y, z], r) = (s.glass.center, s.glass.radius);
            disc([x, y], r, [z - r, z + r]);
        }
        Kind::Paraboloid(s) => disc(
            s.dish.center,
            s.dish.outer_radius,
            [s.dish.rim_z(), s.dish.vertex_z],
        ),
        Kind::ConicMirrors(s) => {
            let c = &s.conic;
            let ends = if c.is_ellipsoid() {
                [c.rim_z, c.vertex_z()]
            } else {
                [c.vertex_z(), c.rim_z]
            };
            disc(c.center, c.widest(), ends);
        }
        _ => return None,
    }
    Some((high - low).length())
}

/// Corners of the box of a wall over |φ| ≤ `half` of a circle about the z axis.
fn arc(radius: f64, half: f64, height: f64) -> [Vec3<f64>; 2] {
    let wide = if half < core::f64::consts::FRAC_PI_2 {
        radius * sin(half)
    } else {
        radius
    };
    [
        vec3(radius * cos(half), -wide, 0.0),
        vec3(radius, wide, height),
    ]
}
