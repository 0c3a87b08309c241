//! From a scene entry to the proof of the light of each class at a floor point.
//!
//! An entry's decimals come from its text, under the keys of the TOML file; what follows from them (sines of degrees, the
//! place of a focus) is enclosed. The scene is then that of a reference table: [`Values`] stands for its parameters. What
//! the tables do not have is decided here: rims that clip a mirror's light and shade direct light, a sphere's shadow.

use crate::certificate::radiometry::{Facing, Point, plan_squared, point_light_enclosed};
use crate::certificate::ripples::Ripples;
use crate::certificate::scene::Scene;
use crate::certificate::source::{Source, Values};
use crate::certificate::{Certified, Lit};
use crate::class::PathClass;
use crate::enclosure::{Enclosure, decided};
use crate::scalar::Scalar;
use crate::scene::{Entry, Kind};
use crate::vector::vec3;

/// Direct light of a scene whose table defines another one, or none.
#[derive(Clone, Copy, Debug)]
enum Direct {
    /// That of the table's scene.
    OfScene,
    /// A light on the axis at this height, and the radius of the disc that the rim leaves lit.
    Axial {
        light_z: Enclosure,
        intensity: Enclosure,
        lit: Option<Enclosure>,
    },
    /// Light from above everywhere but in a disc.
    Around {
        irradiance: Enclosure,
        radius: Enclosure,
    },
}

#[derive(Clone, Debug)]
enum Light {
    Table(Box<Scene>),
    Ripples(Ripples),
}

/// An entry of which the light at floor points can be proven.
#[derive(Clone, Debug)]
pub struct CertifiedEntry {
    light: Light,
    direct: Direct,
    /// Where the scene's axis meets the floor.
    axis: (Enclosure, Enclosure),
    /// Largest distance from the axis that an aperture leaves lit.
    aperture: Option<Enclosure>,
}

/// An angle in degrees, in radians.
fn radians(degrees: Enclosure) -> Enclosure {
    degrees * Enclosure::PI / Enclosure::point(180.0)
}

impl CertifiedEntry {
    /// An entry that has passed [`Entry::validate`], with the text that it was read from; `None` for a scene without a
    /// floor, or if the decimals cannot be read.
    pub fn read(entry: &Entry, toml: &dyn Source) -> Option<Self> {
        let (zero, one) = (Enclosure::ZERO, Enclosure::ONE);
        let n = |key: &str| toml.number(key);
        let pair = |key: &str| -> Option<[Enclosure; 2]> {
            if toml.has(key) {
                Some([toml.entry(key, &[0])?, toml.entry(key, &[1])?])
            } else {
                Some([zero, zero])
            }
        };
        let point = |key: &str| toml.point(key).map(|p| [p.x, p.y, p.z]);
        let most = entry.kind.classes().iter().map(|c| c.light.len()).max()?;
        let (mut values, mut direct) = (Values::default(), Direct::OfScene);
        let (mut axis, mut aperture) = ([zero, zero], None);
        let v = &mut values;
        if let Kind::Furnace(_) = entry.kind {
            return None;
        }
        if toml.has("light.intensity") {
            v.set("I", &[n("light.intensity")?]);
        } else {
            v.set("E0", &[n("light.irradiance")?]);
        }
        if toml.has("light.position") {
            v.set("light", &point("light.position")?);
        }
        if toml.has("light.elevation_degrees") {
            let elevation = radians(n("light.elevation_degrees")?);
            v.set("sin_elevation", &[elevation.sin()]);
            v.set("cos_elevation", &[elevation.cos()]);
        }
        let name = match &entry.kind {
            Kind::Furnace(_) => return None,
            Kind::Diffuse(_) => "diffuse",
            Kind::PlanarMirror(_) => {
                v.set("R", &[n("mirror.reflectance")?])
                    .set("mirror_point", &point("mirror.center")?)
                    .set("mirror_normal", &point("mirror.normal")?)
                    .set("extent.edge", &point("mirror.edge")?)
                    .set("extent.half_width", &[n("mirror.half_width")?])
                    .set("extent.half_height", &[n("mirror.half_height")?]);
                "planar-mirror"
            }
            Kind::FlatInterface(_) | Kind::Underwater(_) => {
                v.set("surface_z", &[n("water.surface_z")?])
                    .set("n", &[n("water.index")?]);
                "flat-interface"
            }
            Kind::GlassSlab(_) => {
                v.set("slab_z", &[n("slab.bottom")?, n("slab.top")?])
                    .set("n", &[n("slab.index")?])
                    .word("orders_listed", most / 2);
                "glass-slab"
            }
            Kind::Pillar(_) | Kind::GlassPillar(_) => {
                v.set("center", &pair("pillar.center")?)
                    .set("a", &[n("pillar.radius")?])
                    .set("H", &[n("pillar.height")?])
                    .word("max_interactions", most);
                if let Kind::Pillar(_) = entry.kind {
                    v.set("R", &[n("pillar.reflectance")?]);
                    "pillar"
                } else {
                    v.set("n", &[n("pillar.index")?]);
                    "glass-pillar"
                }
            }
            Kind::ConicWall(scene) => {
                v.set("focus", &pair("wall.focus")?)
                    .set("axis", &pair("wall.direction")?)
                    .set("p", &[n("wall.parameter")?])
                    .set("e", &[n("wall.eccentricity")?])
                    .set("H", &[n("wall.height")?])
                    .set("R", &[n("wall.reflectance")?]);
                if scene.wall.half_arc().is_some() {
                    v.set("half_arc", &[radians(n("wall.half_arc_degrees")?)]);
                } else {
                    v.word("half_arc", "closed");
                }
                "conic-wall"
            }
            Kind::PlanarChains(scene) => {
                let [x, y, z] = point("light.position")?;
                let radius = plan_squared(x, y).sqrt();
                v.set("light_polar", &[radius, y.atan2(x), z])
                    .set("R", &[n("wedge.reflectance")?])
                    .word("m", scene.wedge.divisor);
                "planar-chains"
            }
            Kind::ConcaveSphere(_) => {
                v.set("sphere_centre", &point("cap.center")?)
                    .set("a", &[n("cap.radius")?])
                    .set("R", &[n("cap.reflectance")?])
                    .set("cap_axis", &[zero, zero, one])
                    .set(
                        "cap_cos_min",
                        &[radians(n("cap.half_angle_degrees")?).cos()],
                    );
                "concave-sphere"
            }
            Kind::ConvexSphere(_) => {
                v.set("sphere_centre", &point("ball.center")?)
                    .set("a", &[n("ball.radius")?])
                    .set("R", &[n("ball.reflectance")?]);
                "convex-sphere"
            }
            Kind::Paraboloid(_) => {
                axis = pair("dish.center")?;
                let (f, top, r1) = (
                    n("dish.focal_length")?,
                    n("dish.vertex_z")?,
                    n("dish.outer_radius")?,
                );
                let rim_z = top - r1.squared() / (Enclosure::point(4.0) * f);
                direct = axial(top - f, n("light.intensity")?, (r1, rim_z));
                v.set("f", &[f])
                    .set("R", &[n("dish.reflectance")?])
                    .set("zr", &[top])
                    .set("light", &[zero, zero, f])
                    .set("mirror_radius", &[r1])
                    .set("r0", &[n("dish.inner_radius")?]);
                "paraboloid"
            }
            Kind::ConicMirrors(scene) => {
                axis = pair("conic.center")?;
                let (a, e) = (n("conic.semi_axis")?, n("conic.eccentricity")?);
                let (image, rim_z) = (n("conic.image_z")?, n("conic.rim_z")?);
                let up = if scene.conic.is_ellipsoid() {
                    a * e
                } else {
                    -(a * e)
                };
                let z = rim_z - image - up;
                let rim = ((a - z) * (a + z) * (one - e) * (one + e)).sqrt();
                direct = axial(image + up + up, n("light.intensity")?, (rim, rim_z));
                v.set("e", &[e])
                    .set("R", &[n("conic.reflectance")?])
                    .set("rim_below_image", &[image - rim_z]);
                if scene.conic.is_ellipsoid() {
                    v.set("a", &[a]).set("delta", &[image]);
                } else {
                    v.set("A", &[a]).set("zr", &[image + up]);
                }
                "conic-mirrors"
            }
            Kind::GlassSphere(_) => {
                axis = pair("glass.center")?;
                let radius = n("glass.radius")?;
                direct = Direct::Around {
                    irradiance: n("light.irradiance")?,
                    radius,
                };
                v.set("n", &[n("glass.index")?])
                    .set("a", &[radius])
                    .set("receiver_z", &[toml.entry("glass.center", &[2])?]);
                "glass-sphere"
            }
            Kind::StigmaticRefractors(_) => {
                axis = pair("lens.center")?;
                let (defocus, half) = (n("lens.defocus")?, radians(n("lens.half_angle_degrees")?));
                aperture = Some(defocus.abs() * half.sin() / half.cos());
                v.set("n", &[n("lens.index")?])
                    .set("a", &[n("lens.semi_axis")?])
                    .set("delta", &[defocus]);
                "stigmatic-refractors"
            }
            Kind::CylinderCup(_) | Kind::ClosedCup(_) | Kind::CylinderLamp(_) => {
                let a = n("wall.radius")?;
                v.set("a", &[a])
                    .set("R", &[n("wall.reflectance")?])
                    .set("wall_height", &[n("wall.height")?])
                    .word("wall_height", "bounded")
                    .word("max_bounces", most.max(1));
                let arc = match &entry.kind {
                    Kind::CylinderCup(s) => s.wall.half_arc_degrees,
                    Kind::CylinderLamp(s) => s.wall.half_arc_degrees,
                    _ => 180.0,
                };
                if arc < 180.0 {
                    let end = radians(n("wall.half_arc_degrees")?);
                    v.word("wall", "arc").set("cos_half_arc", &[end.cos()]);
                } else {
                    v.word("wall", "full");
                }
                if let Kind::CylinderLamp(_) = entry.kind {
                    let inset = if toml.has("light.inset") {
                        n("light.inset")?
                    } else {
                        zero
                    };
                    let (azimuth, r) = (radians(n("light.azimuth_degrees")?), a - inset);
                    v.set(
                        "light",
                        &[r * azimuth.cos(), r * azimuth.sin(), n("light.height")?],
                    );
                    if inset == zero {
                        v.word("light_on_wall", "yes");
                    }
                }
                "cylinder-cup"
            }
            Kind::WaterWaves(_) => "water-waves",
        };
        let light = if let Kind::WaterWaves(_) = entry.kind {
            Light::Ripples(Ripples::read(toml)?)
        } else {
            let numbers = entry.kind.classes().iter().map(|c| c.light.len() as u32);
            let listed = numbers.filter(|m| *m > 0).collect();
            Light::Table(Box::new(Scene::read(name, &values)?.listing(listed)))
        };
        Some(CertifiedEntry {
            light,
            direct,
            axis: (axis[0], axis[1]),
            aperture,
        })
    }

    /// The irradiance of each of `classes` at the floor point (x, y), 0 or more light interactions each. An empty list, or
    /// `None` for a class, claims nothing.
    pub fn classes_enclosed(
        &self,
        x: Enclosure,
        y: Enclosure,
        classes: &[PathClass],
    ) -> Vec<Option<Certified>> {
        decided(|| self.claims(x, y, classes)).unwrap_or_else(|| vec![None; classes.len()])
    }

    fn claims(&self, x: Enclosure, y: Enclosure, classes: &[PathClass]) -> Vec<Option<Certified>> {
        let at = vec3(x - self.axis.0, y - self.axis.1, Enclosure::ZERO);
        let scene = match &self.light {
            Light::Ripples(water) => {
                let sum = water.caustic_enclosed(at.x, at.y).total;
                return classes
                    .iter()
                    .map(|c| (c.light.len() == 1).then_some(sum))
                    .collect();
            }
            Light::Table(scene) => scene,
        };
        let Some(light) = scene.light_enclosed(at) else {
            return vec![None; classes.len()];
        };
        let within = self.aperture.map_or(Lit::Yes, |limit| {
            Lit::where_not_negative(limit.squared() - plan_squared(at.x, at.y))
        });
        let of = |class: &PathClass| {
            let m = class.light.len();
            if m == 0 {
                return match self.direct {
                    Direct::OfScene => light.direct,
                    other => Some(other.enclosed(at)),
                };
            }
            let name = format!("L{}DE", "S".repeat(m));
            let (_, bundle) = light.classes.iter().find(|(n, _)| *n == name)?;
            let mut sum = bundle.total;
            match within {
                Lit::Yes => {}
                Lit::No => sum = Certified::NONE,
                Lit::Undecided => sum = sum.either(Certified::NONE),
            }
            Some(sum)
        };
        classes.iter().map(of).collect()
    }
}

/// Direct light of a lamp on the axis of a mirror with this rim (radius, height).
fn axial(light_z: Enclosure, intensity: Enclosure, rim: (Enclosure, Enclosure)) -> Direct {
    let below = light_z - rim.1;
    Direct::Axial {
        light_z,
        intensity,
        // A rim at the height of the light, to within rounding, shades from infinity.
        lit: (below.high() > 0.0).then(|| rim.0 * light_z / below),
    }
}

impl Direct {
    fn enclosed(self, at: Point) -> Certified {
        let mut sum = Certified::NONE;
        let plan = plan_squared(at.x, at.y);
        match self {
            Direct::OfScene => {}
            Direct::Axial {
                light_z,
                intensity,
                lit,
            } => {
                let zero = Enclosure::ZERO;
                let (e, above) =
                    point_light_enclosed(vec3(zero, zero, light_z), intensity, at, Facing::Up);
                let inside = lit.map_or(Lit::Yes, |r| Lit::where_not_negative(r - plan.sqrt()));
                sum.add(e, above.and(inside));
            }
            Direct::Around { irradiance, radius } => {
                sum.add(irradiance, Lit::where_positive(plan - radius.squared()));
            }
        }
        sum
    }
}
