//! From a validated entry to a scene whose light and surface are known at compile time.

use glam::DVec3;
use nephroid_analytic::scene::{
    ArcWall, Camera, ClosedCupScene, ConcaveSphereScene, ConicMirrorsScene, ConicWallScene,
    ConvexSphereScene, CylinderCupScene, CylinderLampScene, DiffuseScene, DirectionalLight, Entry,
    Family, FlatInterfaceScene, FocalLight, GlassPillarScene, GlassSlabScene, GlassSphereScene,
    Kind, ParaboloidScene, PillarScene, PlanarChainsScene, PlanarMirrorScene, PointLight,
    StigmaticRefractorsScene, UnderwaterScene, VerticalLight, WaterWavesScene,
};

use super::arc::Arc;
use super::ball::Ball;
use super::chains::Chains;
use super::conic::Conic;
use super::conic_wall::ConicWall;
use super::cup_wall::CupWall;
use super::dish::Dish;
use super::floor::Floor;
use super::furnace::Furnace;
use super::glass_ball::GlassBall;
use super::glass_pillar::GlassPillar;
use super::lens::Lens;
use super::light::{Directional, Light, Point};
use super::pillar::Pillar;
use super::pinhole::Pinhole;
use super::rectangle::Rectangle;
use super::ripples::Ripples;
use super::scene::{Overrides, Scene, taken_for};
use super::slab::Slab;
use super::specular::{Nothing, Specular};
use super::sphere_cap::SphereCap;
use super::underwater::Underwater;
use super::water::Water;
use super::wedge::Wedge;

/// Whether light takes chains of specular interactions to a floor that is seen directly; otherwise there is at most one
/// interaction on either side of the floor, or no floor.
pub fn takes_chains(entry: &Entry) -> bool {
    !matches!(
        entry.kind,
        Kind::Diffuse(_)
            | Kind::PlanarMirror(_)
            | Kind::CylinderCup(_)
            | Kind::FlatInterface(_)
            | Kind::Furnace(_)
    )
}

/// What is done with a scene once its light and surface are known.
pub trait Visitor {
    /// What comes out.
    type Output;

    /// At most one specular interaction on either side of the floor.
    fn scene<L: Light, S: Specular>(self, scene: Scene<L, S>) -> Self::Output;

    /// Chains of specular interactions between light and floor, the floor seen directly.
    fn chains<L: Light, S: Chains>(self, scene: Scene<L, S>) -> Self::Output;

    /// A closed diffuse sphere.
    fn furnace(self, scene: Furnace) -> Self::Output;
}

/// Compiles a validated entry of any kind.
pub fn visit<V: Visitor>(entry: &Entry, overrides: Overrides, visitor: V) -> V::Output {
    let build = Build::new(&entry.camera, overrides);
    match &entry.kind {
        Kind::Diffuse(s) => visitor.scene(build.diffuse(s)),
        Kind::PlanarMirror(s) => visitor.scene(build.planar_mirror(s)),
        Kind::CylinderCup(s) => visitor.scene(build.cylinder_cup(s)),
        Kind::FlatInterface(s) => visitor.scene(build.flat_interface(s)),
        Kind::GlassSlab(s) => visitor.chains(build.glass_slab(s)),
        Kind::Pillar(s) => visitor.chains(build.pillar(s)),
        Kind::ConicWall(s) => visitor.chains(build.conic_wall(s)),
        Kind::GlassPillar(s) => visitor.chains(build.glass_pillar(s)),
        Kind::PlanarChains(s) => visitor.chains(build.planar_chains(s)),
        Kind::ConcaveSphere(s) => visitor.chains(build.concave_sphere(s)),
        Kind::ConvexSphere(s) => visitor.chains(build.convex_sphere(s)),
        Kind::Paraboloid(s) => visitor.chains(build.paraboloid(s)),
        Kind::ConicMirrors(s) => visitor.chains(build.conic_mirrors(s)),
        Kind::Furnace(s) => {
            let mut wall = s.wall.clone();
            wall.albedo = taken_for(wall.albedo, overrides.albedo);
            visitor.furnace(Furnace::new(build.point(&s.light), build.camera, &wall))
        }
        Kind::Underwater(s) => visitor.chains(build.underwater(s)),
        Kind::GlassSphere(s) => visitor.chains(build.glass_sphere(s)),
        Kind::WaterWaves(s) => visitor.chains(build.water_waves(s)),
        Kind::StigmaticRefractors(s) => visitor.chains(build.stigmatic_refractors(s)),
        Kind::CylinderLamp(s) => visitor.chains(build.cylinder_lamp(s)),
        Kind::ClosedCup(s) => visitor.chains(build.closed_cup(s)),
    }
}

/// What all kinds need.
struct Build {
    camera: Pinhole,
    overrides: Overrides,
}

impl Build {
    fn new(camera: &Camera, overrides: Overrides) -> Self {
        Build {
            camera: Pinhole::new(camera),
            overrides,
        }
    }

    fn scene<L, S>(
        &self,
        light: L,
        surface: S,
        floor: &nephroid_analytic::scene::Floor,
    ) -> Scene<L, S> {
        Scene {
            light,
            surface,
            floor: Floor::new(&nephroid_analytic::scene::Floor {
                albedo: taken_for(floor.albedo, self.overrides.albedo),
                ..floor.clone()
            }),
            camera: self.camera,
        }
    }

    fn point(&self, light: &PointLight) -> Point {
        Point {
            position: DVec3::from_array(light.position),
            intensity: self.strength(light.intensity),
        }
    }

    fn directional(&self, light: &DirectionalLight) -> Directional {
        let elevation = light.elevation_degrees.to_radians();
        Directional {
            travel: DVec3::new(libm::cos(elevation), 0.0, -libm::sin(elevation)),
            irradiance: self.strength(light.irradiance),
        }
    }

    fn vertical(&self, light: &VerticalLight) -> Directional {
        Directional {
            travel: DVec3::NEG_Z,
            irradiance: self.strength(light.irradiance),
        }
    }

    fn strength(&self, own: f64) -> f64 {
        taken_for(own, self.overrides.light)
    }

    fn reflectance(&self, own: f64) -> f64 {
        taken_for(own, self.overrides.reflectance)
    }

    fn water(&self, own: &nephroid_analytic::scene::Water) -> Water {
        let mut water = own.clone();
        water.index = taken_for(own.index, self.overrides.index);
        let weight = self.overrides.transmittance.map(|f| f(own.index));
        Water::new(&water).with_weight(weight.unwrap_or([0.0, 1.0]))
    }

    fn diffuse(&self, s: &DiffuseScene) -> Scene<Point, Nothing> {
        self.scene(self.point(&s.light), Nothing, &s.floor)
    }

    fn planar_mirror(&self, s: &PlanarMirrorScene) -> Scene<Point, Rectangle> {
        let mirror = Rectangle::new(&s.mirror, self.reflectance(s.mirror.reflectance));
        self.scene(self.point(&s.light), mirror, &s.floor)
    }

    fn cylinder_cup(&self, s: &CylinderCupScene) -> Scene<Directional, Arc> {
        let wall = Arc::new(&s.wall, self.reflectance(s.wall.reflectance));
        self.scene(self.directional(&s.light), wall, &s.floor)
    }

    fn flat_interface(&self, s: &FlatInterfaceScene) -> Scene<Point, Water> {
        self.scene(self.point(&s.light), self.water(&s.water), &s.floor)
    }

    fn concave_sphere(&self, s: &ConcaveSphereScene) -> Scene<Point, SphereCap> {
        let cap = SphereCap::new(s, self.reflectance(s.cap.reflectance));
        self.scene(self.point(&s.light), cap, &s.floor)
    }

    fn convex_sphere(&self, s: &ConvexSphereScene) -> Scene<Point, Ball> {
        let ball = Ball::new(s, self.reflectance(s.ball.reflectance));
        self.scene(self.point(&s.light), ball, &s.floor)
    }

    /// The light at a mirror's focus, over the point where its axis meets the floor.
    fn focal(&self, light: &FocalLight, [x, y]: [f64; 2], z: f64) -> Point {
        Point {
            position: DVec3::new(x, y, z),
            intensity: self.strength(light.intensity),
        }
    }

    fn paraboloid(&self, s: &ParaboloidScene) -> Scene<Point, Dish> {
        let dish = Dish::new(s, self.reflectance(s.dish.reflectance));
        let light = self.focal(&s.light, s.dish.center, s.dish.focus_z());
        self.scene(light, dish, &s.floor)
    }

    fn conic_mirrors(&self, s: &ConicMirrorsScene) -> Scene<Point, Conic> {
        let conic = Conic::new(s, self.reflectance(s.conic.reflectance));
        let light = self.focal(&s.light, s.conic.center, s.conic.light_z());
        self.scene(light, conic, &s.floor)
    }

    fn glass_slab(&self, s: &GlassSlabScene) -> Scene<Point, Slab> {
        self.scene(self.point(&s.light), Slab::new(s), &s.floor)
    }

    fn glass_sphere(&self, s: &GlassSphereScene) -> Scene<Directional, GlassBall> {
        self.scene(self.vertical(&s.light), GlassBall::new(s), &s.floor)
    }

    fn water_waves(&self, s: &WaterWavesScene) -> Scene<Directional, Ripples> {
        self.scene(self.vertical(&s.light), Ripples::new(s), &s.floor)
    }

    fn stigmatic_refractors(&self, s: &StigmaticRefractorsScene) -> Scene<Directional, Lens> {
        self.scene(self.vertical(&s.light), Lens::new(s), &s.floor)
    }

    fn underwater(&self, s: &UnderwaterScene) -> Scene<Point, Underwater> {
        self.scene(
            self.point(&s.light),
            Underwater::new(s, self.water(&s.water)),
            &s.floor,
        )
    }

    fn pillar(&self, s: &PillarScene) -> Scene<Point, Pillar> {
        let pillar = Pillar::new(s, self.reflectance(s.pillar.reflectance));
        self.scene(self.point(&s.light), pillar, &s.floor)
    }

    fn conic_wall(&self, s: &ConicWallScene) -> Scene<Point, ConicWall> {
        let wall = ConicWall::new(s, self.reflectance(s.wall.reflectance));
        self.scene(self.point(&s.light), wall, &s.floor)
    }

    fn glass_pillar(&self, s: &GlassPillarScene) -> Scene<Directional, GlassPillar> {
        self.scene(self.directional(&s.light), GlassPillar::new(s), &s.floor)
    }

    fn planar_chains(&self, s: &PlanarChainsScene) -> Scene<Point, Wedge> {
        let wedge = Wedge::new(s, self.reflectance(s.wedge.reflectance));
        self.scene(self.point(&s.light), wedge, &s.floor)
    }

    fn cylinder_lamp(&self, s: &CylinderLampScene) -> Scene<Point, CupWall> {
        let wall = CupWall::new(&s.wall, self.reflectance(s.wall.reflectance), s.classes());
        let (light, wall_radius) = (&s.light, s.wall.radius);
        let (sin, cos) = libm::sincos(light.azimuth_degrees.to_radians());
        let plan = DVec3::new(cos, sin, 0.0) * (wall_radius - light.inset);
        let light = Point {
            position: plan.with_z(light.height),
            intensity: self.strength(light.intensity),
        };
        self.scene(light, wall, &s.floor)
    }

    fn closed_cup(&self, s: &ClosedCupScene) -> Scene<Directional, CupWall> {
        let wall = ArcWall {
            radius: s.wall.radius,
            height: s.wall.height,
            half_arc_degrees: 180.0,
            reflectance: s.wall.reflectance,
        };
        let light = self.directional(&s.light);
        let wall = CupWall::new(&wall, self.reflectance(wall.reflectance), s.classes());
        self.scene(light, wall.in_beam(light.travel), &s.floor)
    }
}
