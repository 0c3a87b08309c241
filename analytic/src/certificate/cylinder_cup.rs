//! A cylindrical mirror wall in a beam: all rays to a floor point, counted. Theory block G.
//!
//! In plan the ray that first hits the circle at a e^{iφ} has the direction θ = 2kφ + kπ after k bounces. It passes
//! through (x, y) where y cos θ - x sin θ = a sin φ, for which |φ| < π/2 is searched completely, and
//!
//! ```text
//! τ = x cos θ + y sin θ + a cos φ,     E = sin ε E0 R^k a cos φ/|(2k - 1) a cos φ - 2kτ|.
//! ```
//!
//! The first hit is (τ + (k - 1) 2a cos φ) tan ε high. Point lights are in [`lamp`] and [`chains`], what a camera sees in [`eye`].

mod chains;
mod eye;
mod lamp;

use crate::certificate::radiometry::{Bundle, Point, plan_squared, power_enclosed, whole};
use crate::certificate::roots::{Jet, isolate};
use crate::certificate::{Certified, Lit, source::Source};
use crate::enclosure::Enclosure;
use crate::scalar::Scalar;

use lamp::Lamp;

/// The wall, over the floor z = 0, with its light.
#[derive(Clone, Copy, Debug)]
pub struct CylinderCup {
    radius: Enclosure,
    /// Height of the rim; `None` for a wall without end.
    height: Option<Enclosure>,
    /// The wall stands where cos φ is at least this; `None`: everywhere.
    cos_half_arc: Option<Enclosure>,
    reflectance: Enclosure,
    light: Light,
    max_bounces: u32,
}

#[derive(Clone, Copy, Debug)]
enum Light {
    Beam(Beam),
    Lamp(Lamp),
}

#[derive(Clone, Copy, Debug)]
struct Beam {
    irradiance: Enclosure,
    sin_elevation: Enclosure,
    slope: Enclosure,
}

impl CylinderCup {
    /// `a`, `R`, `wall` (`full`, `half`, or `arc` with `cos_half_arc`), `wall_height`, `max_bounces`, and `light`, `I`,
    /// `light_on_wall` where it is `yes`, or `E0`, `sin_elevation`, `cos_elevation`.
    pub fn read(p: &dyn Source) -> Option<Self> {
        let radius = p.number("a")?;
        let light = if p.has("light") {
            let on_wall = p.text("light_on_wall", &[]).is_some_and(|t| t == "yes");
            Light::Lamp(Lamp::new(
                radius,
                p.point("light")?,
                p.number("I")?,
                on_wall,
            )?)
        } else {
            let sin_elevation = p.number("sin_elevation")?;
            Light::Beam(Beam {
                irradiance: p.number("E0")?,
                sin_elevation,
                slope: sin_elevation / p.number("cos_elevation")?,
            })
        };
        Some(CylinderCup {
            radius,
            height: match p.text("wall_height", &[])?.as_str() {
                "unbounded" => None,
                _ => Some(p.number("wall_height")?),
            },
            cos_half_arc: match p.text("wall", &[])?.as_str() {
                "full" => None,
                "half" => Some(Enclosure::ZERO),
                "arc" => Some(p.number("cos_half_arc")?),
                _ => return None,
            },
            reflectance: p.number("R")?,
            light,
            max_bounces: p.whole("max_bounces").filter(|k| (1..=64).contains(k))?,
        })
    }

    /// The most bounces that are listed.
    pub fn orders(&self) -> u32 {
        self.max_bounces
    }

    /// Whether the wall stands at the angle with this cosine.
    fn covers(&self, cosine: Enclosure) -> Lit {
        self.cos_half_arc
            .map_or(Lit::Yes, |end| Lit::where_not_negative(cosine - end))
    }

    /// Whether the wall reaches up to a height.
    fn reaches(&self, z: Enclosure) -> Lit {
        self.height
            .map_or(Lit::Yes, |h| Lit::where_not_negative(h - z))
    }

    /// Whether (x, y) is inside the circle.
    fn holds(&self, x: Point) -> Lit {
        Lit::where_positive(self.radius.squared() - plan_squared(x.x, x.y))
    }

    /// Light with exactly `bounces` ≥ 1 reflections at a floor point.
    pub fn caustic_enclosed(&self, x: Point, bounces: u32) -> Bundle {
        match &self.light {
            Light::Beam(beam) => self.beam_rays(beam, x, bounces, |e, _| e),
            Light::Lamp(lamp) => self.lamp_rays(lamp, x, bounces),
        }
    }

    /// The rays of the beam, each with what `seen` makes of its irradiance and of the cosine of θ.
    fn beam_rays(
        &self,
        beam: &Beam,
        at: Point,
        bounces: u32,
        seen: impl Fn(Enclosure, Enclosure) -> Enclosure,
    ) -> Bundle {
        let (a, k) = (self.radius, whole(bounces));
        let two = Enclosure::TWO;
        // cos(2kφ + kπ) is ±cos 2kφ.
        let turned = if bounces.is_multiple_of(2) {
            Enclosure::ONE
        } else {
            -Enclosure::ONE
        };
        let (x, y) = (turned * at.x, turned * at.y);
        let quarter = (Enclosure::PI * Enclosure::HALF).high();
        let jet = Jet::constant;
        let zeros = isolate(-quarter, quarter, |phi| {
            let theta = jet(two * k) * phi;
            jet(y) * theta.cos() - jet(x) * theta.sin() - jet(a) * phi.sin()
        });
        let mut bundle = Bundle::default();
        for phi in zeros.simple {
            let theta = two * k * phi;
            let (cosine, sine) = (theta.cos(), theta.sin());
            let half_chord = a * phi.cos();
            let tau = x * cosine + y * sine + half_chord;
            let spread = (two * k - Enclosure::ONE) * half_chord - two * k * tau;
            let e = beam.sin_elevation
                * beam.irradiance
                * power_enclosed(self.reflectance, bounces)
                * half_chord
                / spread.abs();
            let first = (tau + (k - Enclosure::ONE) * two * half_chord) * beam.slope;
            let lit = self.beam_lit(beam, at, bounces, phi, tau, first);
            bundle.add(seen(e, turned * cosine), lit);
        }
        for _ in zeros.undecided {
            bundle.total.add_unresolved();
        }
        bundle
    }

    /// Whether the wall makes the reflections of a ray that first hits it at φ, `first` high.
    fn beam_lit(
        &self,
        beam: &Beam,
        x: Point,
        bounces: u32,
        phi: Enclosure,
        tau: Enclosure,
        first: Enclosure,
    ) -> Lit {
        let chord = Enclosure::TWO * self.radius * phi.cos();
        let cosine = phi.cos();
        // At the angle π - φ the ray comes in: through the opening, or over the rim.
        let over = match self.height {
            Some(h) => Lit::where_not_negative(first + chord * beam.slope - h),
            None => Lit::No,
        };
        let enters = self.covers(-cosine).inverted().or(over);
        let mut lit = enters
            .and(Lit::where_positive(cosine))
            .and(self.reaches(first))
            .and(self.covers(cosine));
        // The position angle of hit j is (2j - 1)φ + (j - 1)π.
        let on_wall = |j: u32| {
            let cosine = (whole(2 * j - 1) * phi).cos();
            self.covers(if j.is_multiple_of(2) { -cosine } else { cosine })
        };
        for j in 2..=bounces {
            lit = lit.and(on_wall(j));
        }
        // Inside the circle the point is on the last chord; outside only where the ray leaves through the opening.
        let outside = Lit::where_positive(tau)
            .and(Lit::where_not_negative(chord - tau).or(on_wall(bounces + 1).inverted()));
        match self.holds(x) {
            Lit::Yes => lit,
            Lit::No => lit.and(outside),
            Lit::Undecided => lit.and(Lit::Undecided),
        }
    }

    /// Light that meets no wall at a floor point.
    pub fn direct_enclosed(&self, x: Point) -> Certified {
        let mut sum = Certified::NONE;
        match &self.light {
            Light::Beam(beam) => {
                let e = beam.irradiance * beam.sin_elevation;
                sum.add(e, self.shaded(beam, x).inverted());
            }
            Light::Lamp(lamp) => {
                let (e, lit) = lamp.direct(x);
                // Nothing stands between two points inside the circle.
                let free = self.holds(x).or(self.hides_lamp(lamp, x).inverted());
                sum.add(e, lit.and(free));
            }
        }
        sum
    }

    /// Whether the wall stands between a floor point and the sun.
    fn shaded(&self, beam: &Beam, x: Point) -> Lit {
        let a = self.radius;
        let squared = (a - x.y) * (a + x.y);
        let half = squared.sqrt();
        let by = |wall_x: Enclosure| {
            Lit::where_positive(x.x - wall_x)
                .and(self.covers(wall_x / a))
                .and(self.reaches((x.x - wall_x) * beam.slope))
        };
        Lit::where_positive(squared).and(by(half).or(by(-half)))
    }
}

/// Flatland: the half circle in a beam, a receiver along x = const. Fluence, and irradiance of the line.
#[derive(Clone, Copy, Debug)]
pub struct Flatland {
    cup: CylinderCup,
    beam: Beam,
    line: Enclosure,
}

impl Flatland {
    /// `a`, `E0`, `R`, `x_line`.
    pub fn read(p: &dyn Source) -> Option<Self> {
        let beam = Beam {
            irradiance: p.number("E0")?,
            sin_elevation: Enclosure::ONE,
            slope: Enclosure::ONE,
        };
        Some(Flatland {
            cup: CylinderCup {
                radius: p.number("a")?,
                height: None,
                cos_half_arc: Some(Enclosure::ZERO),
                reflectance: p.number("R")?,
                light: Light::Beam(beam),
                max_bounces: 1,
            },
            beam,
            line: p.number("x_line")?,
        })
    }

    /// Fluence and irradiance of the line at the height y.
    pub fn caustic_enclosed(&self, y: Enclosure) -> [Bundle; 2] {
        let x = Point {
            x: self.line,
            y,
            z: Enclosure::ZERO,
        };
        [
            self.cup.beam_rays(&self.beam, x, 1, |e, _| e),
            self.cup
                .beam_rays(&self.beam, x, 1, |e, cosine| e * cosine.abs()),
        ]
    }
}
