//! A vertical wall over an arc of a conic, under a point light: all reflections at its inner side, counted. Design §2.
//!
//! About focus and axis the wall is Q = p (c, s)/δ, δ = 1 + e c, with the tangent t = (-s, c + e) and the inner normal
//! n = (-c - e, -s), |n|² = m² = 1 + 2ec + e², and the radius of curvature ρ = p m³/δ³. Times δ, the condition
//! (u·t)(v·n) + (v·t)(u·n) = 0 for u = A - Q, v = P - Q has no denominator; it is searched on the whole arc. Of its zeros those
//! count where both u·n and v·n are above 0:
//!
//! ```text
//! E = I R h s/((s² + h²)^{3/2} |W|),     W = s - 2 s1 s2/(ρ cos i),     at the height h s2/s ≤ H.
//! ```
//!
//! The conic is |X| = p - e x: from Q along the unit vector w it is met again at τ = -2 (Q·w + e w_x |Q|)/(1 - e² w_x²), on the
//! same branch if p - e x > 0 there. A wall there ends the ray, if the floor point is not before it.

use crate::certificate::radiometry::{Bundle, Facing, plan_squared, point_light_enclosed};
use crate::certificate::roots::{Jet, Zeros, full_turn, isolate};
use crate::certificate::{Certified, Lit};
use crate::enclosure::Enclosure;
use crate::kinds::conic_wall::ConicWall;
use crate::scalar::Scalar;
use crate::vector::vec3;

type Plan = (Enclosure, Enclosure);

fn dot(a: Plan, b: Plan) -> Enclosure {
    a.0 * b.0 + a.1 * b.1
}

/// A floor position about focus and axis.
fn local(wall: &ConicWall<Enclosure>, x: Enclosure, y: Enclosure) -> Plan {
    let (dx, dy, (c, s)) = (x - wall.x, y - wall.y, wall.axis);
    (dx * c + dy * s, dy * c - dx * s)
}

/// Whether a point is on the inner side, |X| < p - e x, which is convex: nothing stands between two such points.
fn inside(wall: &ConicWall<Enclosure>, at: Plan) -> Lit {
    let (p, e) = (wall.parameter, wall.eccentricity);
    Lit::where_positive(p - e * at.0 - plan_squared(at.0, at.1).sqrt())
}

/// Whether the wall stands where the conic has the point `at`, whose distance from the focus is `r`.
fn covers(wall: &ConicWall<Enclosure>, at: Plan, r: Enclosure) -> Lit {
    match wall.half_arc {
        None => Lit::Yes,
        Some(half) => Lit::where_not_negative(at.0 - half.cos() * r),
    }
}

/// The zeros of the condition of reflection on the arc; `None` on a closed wall on which no start is found.
fn reflections(wall: &ConicWall<Enclosure>, a: Plan, b: Plan) -> Option<Zeros> {
    let jet = Jet::constant;
    let (p, e) = (wall.parameter, wall.eccentricity);
    let condition = |theta: Jet| {
        let (c, s) = (theta.cos(), theta.sin());
        let delta = Jet::ONE + jet(e) * c;
        // (û·t, û·n) for a point: both times δ.
        let seen = |(x, y): Plan| {
            let (ux, uy) = (jet(x) * delta - jet(p) * c, jet(y) * delta - jet(p) * s);
            let lean = c + jet(e);
            (uy * lean - ux * s, -(ux * lean + uy * s))
        };
        let ((ut, un), (vt, vn)) = (seen(a), seen(b));
        ut * vn + vt * un
    };
    match wall.half_arc {
        None => full_turn(condition),
        Some(half) => {
            // A little farther: a reflection at the very edge is decided by the arc.
            let end = half.high() + 1e-9;
            Some(isolate(-end, end, condition))
        }
    }
}

/// Light by one reflection at the floor point (x, y).
pub fn caustic_enclosed(wall: &ConicWall<Enclosure>, x: Enclosure, y: Enclosure) -> Bundle {
    let mut bundle = Bundle::default();
    let (a, b) = (local(wall, wall.light.x, wall.light.y), local(wall, x, y));
    let Some(zeros) = reflections(wall, a, b) else {
        bundle.total.add_unresolved();
        return bundle;
    };
    for theta in zeros.simple {
        let (irradiance, lit) = ray(wall, a, b, theta);
        bundle.add(irradiance, lit);
    }
    for theta in zeros.undecided {
        if ray(wall, a, b, theta).1 != Lit::No {
            bundle.total.add_unresolved();
        }
    }
    bundle
}

/// The irradiance by the ray that is reflected at θ, with the sign of W; with a slope for the mean value form.
fn irradiance<S: Scalar>(
    lift: impl Fn(Enclosure) -> S,
    wall: &ConicWall<Enclosure>,
    [a, b]: [Plan; 2],
    theta: S,
) -> S {
    let (one, two) = (S::ONE, S::TWO);
    let (p, e, h) = (
        lift(wall.parameter),
        lift(wall.eccentricity),
        lift(wall.light.z),
    );
    let (c, s) = (theta.cos(), theta.sin());
    let delta = one + e * c;
    let r = p / delta;
    let to = |(x, y): Plan| (lift(x) - r * c, lift(y) - r * s);
    let (u, v) = (to(a), to(b));
    let length = |(x, y): (S, S)| (x.squared() + y.squared()).sqrt();
    let (s1, s2) = (length(u), length(v));
    let squared_norm = one + two * e * c + e.squared();
    // m cos i.
    let front = -(u.0 * (c + e) + u.1 * s) / s1;
    let curvature = delta.squared() * delta / (p * squared_norm);
    let sum = s1 + s2;
    let spread = sum - two * s1 * s2 * curvature / front;
    let squared = sum.squared() + h.squared();
    lift(wall.intensity * wall.reflectance) * h * sum / (squared * squared.sqrt() * spread)
}

fn ray(wall: &ConicWall<Enclosure>, a: Plan, b: Plan, theta: Enclosure) -> (Enclosure, Lit) {
    let (one, two) = (Enclosure::ONE, Enclosure::TWO);
    let (p, e, h) = (wall.parameter, wall.eccentricity, wall.light.z);
    let middle = Enclosure::point(theta.middle());
    let over = irradiance(Jet::constant, wall, [a, b], Jet::input(theta, 0, one));
    let there = irradiance(|x| x, wall, [a, b], middle);
    let mean = there + over.slopes[0] * (theta - middle);
    let irradiance = mean.intersection(over.value).unwrap_or(over.value).abs();
    let (c, s) = (theta.cos(), theta.sin());
    let delta = one + e * c;
    let r = p / delta;
    let q = (r * c, r * s);
    let normal = (-(c + e), -s);
    let (u, v) = ((a.0 - q.0, a.1 - q.1), (b.0 - q.0, b.1 - q.1));
    let (s1, s2) = (plan_squared(u.0, u.1).sqrt(), plan_squared(v.0, v.1).sqrt());
    let (front, back) = (dot(u, normal), dot(v, normal));
    let sum = s1 + s2;
    // The second meeting.
    let w = (v.0 / s2, v.1 / s2);
    let tau = -two * (dot(q, w) + e * w.0 * r) / (one - (e * w.0).squared());
    let meeting = (q.0 + tau * w.0, q.1 + tau * w.1);
    let distance = p - e * meeting.0;
    let stopped = Lit::where_positive(tau)
        .and(Lit::where_positive(s2 - tau))
        .and(Lit::where_positive(distance))
        .and(covers(wall, meeting, distance));
    let on_arc = match wall.half_arc {
        None => Lit::Yes,
        Some(half) => Lit::where_not_negative(half - theta.abs()),
    };
    let lit = Lit::where_positive(front)
        .and(Lit::where_positive(back))
        .and(on_arc)
        .and(Lit::where_not_negative(wall.height - h * s2 / sum))
        .and(inside(wall, b).or(stopped.inverted()));
    (irradiance, lit)
}

/// Direct light at the floor point (x, y), behind the wall or not.
pub fn direct_enclosed(wall: &ConicWall<Enclosure>, x: Enclosure, y: Enclosure) -> Certified {
    let (p, e) = (wall.parameter, wall.eccentricity);
    let floor = vec3(x, y, Enclosure::ZERO);
    let (irradiance, above) = point_light_enclosed(wall.light, wall.intensity, floor, Facing::Up);
    let (a, b) = (local(wall, wall.light.x, wall.light.y), local(wall, x, y));
    // Where the segment leaves the inner side: the zero σ > 0 of |A + σ D|² = (p - e x)².
    let d = (b.0 - a.0, b.1 - a.1);
    let r = p - e * a.0;
    let quadratic = plan_squared(d.0, d.1) - (e * d.0).squared();
    let linear = dot(a, d) + e * d.0 * r;
    let constant = plan_squared(a.0, a.1) - r.squared();
    let root = (linear.squared() - quadratic * constant).sqrt();
    let sigma = -constant / (linear + root);
    let exit = (a.0 + sigma * d.0, a.1 + sigma * d.1);
    let blocked = inside(wall, b)
        .inverted()
        .and(covers(wall, exit, p - e * exit.0))
        .and(Lit::where_not_negative(
            wall.height - wall.light.z * (Enclosure::ONE - sigma),
        ));
    let mut sum = Certified::NONE;
    sum.add(irradiance, above.and(blocked.inverted()));
    sum
}
