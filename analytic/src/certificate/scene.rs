//! From a configuration of a reference table to the proof of every value at a point or of a view.
//!
//! Values are named as in `nephroid evaluate`: `E_direct`, `E_caustic`, `L_total`, `paths.LSDE.E`,
//! `paths.LSDE.roots.0.E` and so on; a value that the scene does not have is not there. Should any formula on the way ever
//! compare enclosures that overlap, nothing is claimed at all: see [`decided`].

use crate::certificate::claims::{Claim, Claims, Light};
use crate::certificate::conic_mirrors::ConicMirror;
use crate::certificate::cylinder_cup::{CylinderCup, Flatland};
use crate::certificate::diffuse::{Floor, Sphere, furnace_enclosed};
use crate::certificate::flat_interface::FlatInterface;
use crate::certificate::glass_slab::GlassSlab;
use crate::certificate::glass_sphere::GlassSphere;
use crate::certificate::paraboloid::Paraboloid;
use crate::certificate::planar_chains::{Corridor, Wedge};
use crate::certificate::planar_mirror::PlanarMirror;
use crate::certificate::radiometry::{Bundle, Point};
use crate::certificate::source::Source;
use crate::certificate::sphere_mirror::SphereMirror;
use crate::certificate::stigmatic_refractors::StigmaticRefractor;
use crate::certificate::vertical_walls::{self, GlassColumn};
use crate::certificate::water_waves::WaterWaves;
use crate::certificate::{Certified, Lit, conic_wall, glass_pillar, pillar};
use crate::enclosure::{Enclosure, decided};
use crate::kinds::conic_wall::ConicWall;
use crate::kinds::pillar::Pillar;
use crate::scalar::Scalar;
use crate::vector::vec3;

/// Parts of a view's receiver point along either axis.
const PIECES: u32 = 4;

/// A receiver point that a camera sees by way of a specular surface.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// What its radiance is multiplied by.
    pub weight: Enclosure,
    /// Fresnel transmittance on the way, where there is an interface.
    pub transmittance: Option<Enclosure>,
    /// The receiver point.
    pub at: Point,
    /// Whether the camera sees a point at all.
    pub arrives: Lit,
}

/// A configuration of a reference table.
#[derive(Clone, Debug)]
pub struct Scene {
    kind: Kind,
    albedo: Enclosure,
}

#[derive(Clone, Debug)]
enum Kind {
    Floor(Floor),
    Sphere(Sphere),
    Furnace(Enclosure, Enclosure),
    PlanarMirror(PlanarMirror),
    Wedge(Wedge),
    Corridor(Corridor),
    Paraboloid(Paraboloid),
    ConicMirror(ConicMirror),
    StigmaticRefractor(StigmaticRefractor),
    FlatInterface(FlatInterface),
    GlassSlab(GlassSlab),
    CylinderCup(CylinderCup),
    Flatland(Flatland),
    SphereMirror(SphereMirror),
    GlassSphere(GlassSphere, Vec<u32>),
    WaterWaves(WaterWaves),
    Pillar(Pillar<Enclosure>),
    ConicWall(ConicWall<Enclosure>),
    GlassPillar(GlassColumn),
}

impl Scene {
    /// The scene called `name` with the parameters `p`; `None` if it is not one that can be certified.
    pub fn read(name: &str, p: &dyn Source) -> Option<Self> {
        let kind = match name {
            "diffuse" if p.has("Le") => Kind::Furnace(p.number("Le")?, p.number("albedo2")?),
            "diffuse" if p.has("a") => Kind::Sphere(Sphere::read(p)?),
            "diffuse" => Kind::Floor(Floor::read(p)?),
            "planar-mirror" => Kind::PlanarMirror(PlanarMirror::read(p)?),
            "planar-chains" if p.has("m") => Kind::Wedge(Wedge::read(p)?),
            "planar-chains" => Kind::Corridor(Corridor::read(p)?),
            "paraboloid" => Kind::Paraboloid(Paraboloid::read(p)?),
            "conic-mirrors" => Kind::ConicMirror(ConicMirror::read(p)?),
            "stigmatic-refractors" => Kind::StigmaticRefractor(StigmaticRefractor::read(p)?),
            "cylinder-cup" if p.has("x_line") => Kind::Flatland(Flatland::read(p)?),
            "cylinder-cup" => Kind::CylinderCup(CylinderCup::read(p)?),
            "concave-sphere" => Kind::SphereMirror(SphereMirror::read(p, true)?),
            "convex-sphere" => Kind::SphereMirror(SphereMirror::read(p, false)?),
            "glass-sphere" => {
                let sphere = GlassSphere::read(p)?;
                Kind::GlassSphere(sphere, vec![sphere.usual_interactions()])
            }
            "pillar" => Kind::Pillar(vertical_walls::pillar(p)?),
            "conic-wall" => Kind::ConicWall(vertical_walls::conic_wall(p)?),
            "glass-pillar" => Kind::GlassPillar(GlassColumn::read(p)?),
            "water-waves" => Kind::WaterWaves(WaterWaves::read(p)?),
            "flat-interface" => Kind::FlatInterface(FlatInterface::read(p)?),
            "glass-slab" => Kind::GlassSlab(GlassSlab::read(p)?),
            _ => return None,
        };
        let albedo = p.number("albedo").unwrap_or(Enclosure::ZERO);
        Some(Scene { kind, albedo })
    }

    /// The same scene with these numbers of interactions in the listed sum, where classes are chosen so: glass spheres.
    pub fn listing(mut self, numbers: Vec<u32>) -> Self {
        if let Kind::GlassSphere(_, interactions) = &mut self.kind {
            *interactions = numbers;
        }
        self
    }

    /// All light at a receiver point; its height is that of the receiver, whatever `x` says.
    pub fn light_enclosed(&self, x: Point) -> Option<Light> {
        let floor = vec3(x.x, x.y, Enclosure::ZERO);
        let one = |direct, caustic| Light {
            direct,
            classes: vec![("LSDE".into(), caustic)],
            further: vec![],
        };
        Some(match &self.kind {
            Kind::Sphere(_) | Kind::Furnace(..) | Kind::Flatland(_) => return None,
            Kind::Floor(f) => Light {
                direct: Some(f.direct_enclosed(floor)),
                ..Light::default()
            },
            Kind::CylinderCup(cup) => Light {
                direct: Some(cup.direct_enclosed(floor)),
                classes: bounces(cup.orders(), |k| cup.caustic_enclosed(floor, k)),
                further: vec![],
            },
            Kind::PlanarMirror(mirror) => one(
                Some(mirror.direct_enclosed(floor)),
                mirror.caustic_enclosed(floor),
            ),
            Kind::Wedge(wedge) => Light {
                direct: Some(wedge.direct_enclosed(floor)),
                classes: bounces(wedge.orders(), |k| wedge.caustic_enclosed(floor, k)),
                further: vec![],
            },
            Kind::Corridor(corridor) => Light {
                direct: Some(corridor.direct_enclosed(floor)),
                classes: bounces(corridor.orders(), |k| corridor.caustic_enclosed(floor, k)),
                further: vec![(
                    "E_caustic_all_orders".into(),
                    corridor.all_orders_enclosed(floor),
                )],
            },
            Kind::Paraboloid(dish) => one(Some(dish.direct_enclosed(x)), dish.caustic_enclosed(x)),
            Kind::ConicMirror(conic) => {
                one(Some(conic.direct_enclosed(x)), conic.caustic_enclosed(x))
            }
            Kind::StigmaticRefractor(glass) => one(None, glass.caustic_enclosed(x)),
            Kind::FlatInterface(water) => {
                one(Some(water.direct_enclosed(x)), water.caustic_enclosed(x))
            }
            Kind::GlassSlab(slab) => slab_light(slab, x),
            Kind::GlassSphere(sphere, interactions) => Light {
                direct: None,
                classes: interactions
                    .iter()
                    .map(|&m| {
                        let class = format!("L{}DE", "S".repeat(m as usize));
                        (class, sphere.caustic_enclosed(x, m))
                    })
                    .collect(),
                further: vec![],
            },
            Kind::WaterWaves(water) => one(None, water.caustic_enclosed(x)),
            Kind::Pillar(p) => one(
                Some(pillar::direct_enclosed(p, x.x, x.y)),
                pillar::caustic_enclosed(p, x.x, x.y),
            ),
            Kind::ConicWall(wall) => one(
                Some(conic_wall::direct_enclosed(wall, x.x, x.y)),
                conic_wall::caustic_enclosed(wall, x.x, x.y),
            ),
            Kind::GlassPillar(column) => Light {
                direct: Some(glass_pillar::direct_enclosed(&column.pillar, x.x, x.y)),
                classes: bounces(column.orders, |m| {
                    glass_pillar::caustic_enclosed(&column.pillar, x.x, x.y, m)
                }),
                further: vec![],
            },
            Kind::SphereMirror(mirror) => {
                one(Some(mirror.direct_enclosed(x)), mirror.caustic_enclosed(x))
            }
        })
    }

    /// The receiver point that a view shows.
    fn look_enclosed(&self, camera: Point, aim: Point) -> Option<Seen> {
        match &self.kind {
            Kind::PlanarMirror(mirror) => Some(mirror.look_enclosed(camera, aim)),
            Kind::FlatInterface(water) => water.look_enclosed(camera, aim),
            Kind::GlassSlab(slab) => Some(slab.look_enclosed(camera, aim)),
            Kind::CylinderCup(cup) => Some(cup.look_enclosed(camera, aim)),
            Kind::SphereMirror(mirror) => Some(mirror.look_enclosed(camera, aim)),
            Kind::WaterWaves(water) => water.look_enclosed(camera, aim),
            _ => None,
        }
    }

    /// Every value at the point of a table; empty if it cannot be read.
    pub fn point_enclosed(&self, point: &dyn Source) -> Vec<Claim> {
        decided(|| self.point_claims(point))
            .flatten()
            .unwrap_or_default()
    }

    fn point_claims(&self, point: &dyn Source) -> Option<Vec<Claim>> {
        let mut claims = Claims(vec![]);
        match &self.kind {
            Kind::Floor(floor) => {
                let e = floor.direct_enclosed(point.point("x")?);
                claims.add("E_direct", e);
                claims.add("E_caustic", e);
                claims.add("L_caustic", self.radiance(e));
                claims.add("L_total", self.radiance(e));
                claims.add("paths.LDE.E", e);
                claims.add("paths.LDE.roots.0.E", e);
            }
            Kind::Sphere(sphere) => {
                let (direct, indirect) = (
                    sphere.direct_enclosed(point.number("c")?),
                    sphere.indirect_enclosed(),
                );
                let mut total = direct;
                total.join(indirect);
                claims.add("E_direct", direct);
                claims.add("E_bounce1", sphere.bounce_enclosed(1));
                claims.add("E_indirect_total", indirect);
                claims.add("E_total", total);
                claims.add("L_total", sphere.radiance_enclosed(total));
            }
            Kind::Furnace(emission, albedo) => {
                let bounces = match point.text("bounces", &[])?.as_str() {
                    "inf" => None,
                    whole => Some(whole.parse().ok()?),
                };
                claims.add("L", furnace_enclosed(*emission, *albedo, bounces));
            }
            Kind::Flatland(flatland) => {
                let [fluence, line] = flatland.caustic_enclosed(point.entry("x", &[1])?);
                claims.add("fluence_caustic", fluence.total);
                claims.add("E_caustic", line.total);
                claims.add_rays("roots", "fluence", &fluence);
                claims.add_rays("roots", "E", &line);
            }
            _ => {
                let x = vec3(
                    point.entry("x", &[0])?,
                    point.entry("x", &[1])?,
                    Enclosure::ZERO,
                );
                claims.add_light(&self.light_enclosed(x)?, |e| self.radiance(e));
            }
        }
        Some(claims.0)
    }

    /// Every value of the view of a table; empty if it cannot be read or the scene has none.
    pub fn view_enclosed(&self, view: &dyn Source) -> Vec<Claim> {
        decided(|| self.view_claims(view))
            .flatten()
            .unwrap_or_default()
    }

    fn view_claims(&self, view: &dyn Source) -> Option<Vec<Claim>> {
        let aim = if view.has("aim") { "aim" } else { "first_hit" };
        let seen = self.look_enclosed(view.point("camera")?, view.point(aim)?)?;
        let (direct, caustic) = self.light_over(seen.at)?;
        let mut claims = Claims(vec![]);
        // A view that shows nothing has the weight 0.
        let shown = |value: Certified| match seen.arrives {
            Lit::Yes => value,
            Lit::No => Certified::NONE,
            Lit::Undecided => Certified {
                value: value.value.hull(Enclosure::ZERO),
                roots: 0,
                undecided: true,
            },
        };
        let mut total = direct;
        total.join(caustic);
        let weighted = |e: Certified| shown(self.radiance(e).times(seen.weight));
        claims.add("specular_weight", shown(Certified::of(seen.weight)));
        if let Some(t) = seen.transmittance {
            claims.add("T", shown(Certified::of(t)));
        }
        claims.add("E_direct", shown(direct));
        claims.add("E_caustic", shown(caustic));
        claims.add("L_direct_seen", weighted(direct));
        claims.add("L_caustic_seen", weighted(caustic));
        claims.add("L", weighted(total));
        Some(claims.0)
    }

    /// Direct and listed light over a small box: piece by piece, so that the place of a ray and what depends on it are not
    /// both taken from anywhere in the box.
    fn light_over(&self, at: Point) -> Option<(Certified, Certified)> {
        let mut sum: Option<(Certified, Certified)> = None;
        for x in pieces(at.x) {
            for y in pieces(at.y) {
                let mut light = self.light_enclosed(vec3(x, y, at.z))?;
                if let Kind::GlassSlab(_) = self.kind {
                    // Views through a slab hold light without internal reflection.
                    light.classes.truncate(1);
                }
                let here = (light.direct.unwrap_or(Certified::NONE), light.caustic());
                sum = Some(match sum {
                    None => here,
                    Some((direct, caustic)) => (direct.either(here.0), caustic.either(here.1)),
                });
            }
        }
        sum
    }

    /// ρE/π.
    fn radiance(&self, irradiance: Certified) -> Certified {
        irradiance.times(self.albedo / Enclosure::PI)
    }
}

/// An interval in [`PIECES`] parts.
fn pieces(whole: Enclosure) -> Vec<Enclosure> {
    let cut = |i: u32| match i {
        0 => whole.low(),
        PIECES => whole.high(),
        _ => {
            let share = f64::from(i) / f64::from(PIECES);
            (whole.low() + share * (whole.high() - whole.low())).clamp(whole.low(), whole.high())
        }
    };
    if !whole.is_finite() || whole.low() == whole.high() {
        return vec![whole];
    }
    (0..PIECES)
        .map(|i| Enclosure::new(cut(i), cut(i + 1)))
        .collect()
}

/// The slab covers the whole floor: there is no direct light.
fn slab_light(slab: &GlassSlab, x: Point) -> Light {
    let orders = slab.orders();
    let classes: Vec<_> = (0..orders)
        .map(|k| {
            let class = format!("L{}DE", "SS".repeat(k as usize + 1));
            (class, slab.caustic_enclosed(x, k))
        })
        .collect();
    let tail = slab.orders_from_enclosed(x, orders);
    let mut light = Light {
        direct: Some(Certified::NONE),
        classes,
        further: vec![],
    };
    let mut all = light.caustic();
    all.join(tail);
    light.further = vec![
        ("E_caustic_all_orders".into(), all),
        (format!("E_tail_orders_ge_{orders}"), tail),
    ];
    light
}

/// The classes of 1 to `orders` mirror bounces.
fn bounces(orders: u32, class: impl Fn(u32) -> Bundle) -> Vec<(String, Bundle)> {
    (1..=orders)
        .map(|k| (format!("L{}DE", "S".repeat(k as usize)), class(k)))
        .collect()
}
