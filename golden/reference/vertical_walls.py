#!/usr/bin/env python3
"""Reference tables of the vertical walls: pillar, conic-wall, glass-pillar.

    python3 golden/reference/vertical_walls.py pillar > golden/reference/pillar.json

and the same for `conic-wall` and `glass-pillar`. Needs mpmath; the same bytes on every run.

Nothing here is a formula of the closed forms. Rays are traced in space against implicit surfaces: intersection, mirror
law with the gradient as the normal, Snell's law on vectors, Fresnel's amplitudes from the cosines of the true angles.

* Roots: the plan ray that leaves in the direction of parameter u (point light: its azimuth; beam: the angle at which it
  meets the side) passes the floor point at the signed distance g(u). The whole range of u is scanned in double
  precision, with a finer scan wherever |g| has a minimum without a change of sign; every change of sign is solved
  by mpmath.findroot (60 digits).
* Irradiance: flux density. The landing point X(u, w) of the traced ray (w: the slope, or the height at which it comes in)
  is differentiated by central differences of order 8 in 60 digits; E = flux per (du dw) over |dX/du x dX/dw|. Done
  with two steps; their largest relative difference stands in the file.
* Visibility: every ray is followed to the floor through all walls that stand; direct light is a segment against solids.

Points next to a fold are found by bisection on the number of roots, then rounded to a short decimal.
"""

import json
import math
import sys

import mpmath
from mpmath import mp, mpf

mp.dps = 60

SCAN = 6000
FINE = 200


def number(text):
    return mpf(text)


def written(value):
    """34 significant digits."""
    return mpmath.nstr(value, 34, strip_zeros=False) if value != 0 else "0"


class Double:
    """What a trace needs, in double precision: for the scan."""

    sqrt, cos, sin, atan2, pi = math.sqrt, math.cos, math.sin, math.atan2, math.pi

    @staticmethod
    def of(value):
        return float(value)


class Long:
    """The same in 60 digits."""

    sqrt, cos, sin, atan2, pi = mp.sqrt, mp.cos, mp.sin, mp.atan2, mp.pi

    @staticmethod
    def of(value):
        return mpf(value)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def along(a, t, d):
    return tuple(x + t * y for x, y in zip(a, d))


def unit(m, a):
    length = m.sqrt(dot(a, a))
    return tuple(x / length for x in a)


def mirrored(d, n):
    """The mirror law; n a unit normal on either side."""
    k = 2 * dot(d, n)
    return along(d, -k, n)


def to_floor(p, d):
    """Where a descending ray lands."""
    return along(p, p[2] / -d[2], d)


def quadratic(m, a, b, c):
    """The real zeros of a t^2 + 2 b t + c, ascending; a may be 0."""
    if a == 0:
        return [-c / (2 * b)] if b != 0 else []
    disc = b * b - a * c
    if disc < 0:
        return []
    q = -(b + m.sqrt(disc)) if b >= 0 else -b + m.sqrt(disc)
    return sorted([q / a, c / q] if q != 0 else [q / a])


class Scene:
    """Parameters by name, as decimals; tracing in either precision."""

    def __init__(self, parameters):
        self.p = parameters
        self.values = {}

    def get(self, m, key):
        if (m, key) not in self.values:
            v = self.p[key]
            if isinstance(v, list):
                self.values[m, key] = tuple(m.of(mpf(x)) for x in v)
            elif v == "closed":
                self.values[m, key] = None
            else:
                self.values[m, key] = m.of(mpf(v))
        return self.values[m, key]


class PointLit(Scene):
    """A mirror under a point light: rays by azimuth u and slope w = descent per plan length."""

    def classes(self):
        return [("LSDE", 1)]

    def start(self, m, u, w):
        return self.get(m, "light"), (m.cos(u), m.sin(u), -w)

    def range(self, m, order):
        # The seam is at no direction that symmetry singles out.
        return (m.of(mpf("0.1234")) - m.pi, m.of(mpf("0.1234")) + m.pi)

    def flux(self, u, w):
        """I R times the solid angle per (du dw): D = (cos u, sin u, -w) turns by |D . (D_u x D_w)|/|D|^3."""
        return self.get(Long, "I") * self.get(Long, "R") / mp.sqrt(1 + w * w) ** 3

    def slope(self, m, length):
        """The slope that lands after this plan length."""
        return self.get(m, "light")[2] / length

    def emitted(self, x):
        """I cos/r^2 without anything between."""
        light = self.get(Long, "light")
        d = tuple(a - b for a, b in zip(light, x))
        r = mp.sqrt(dot(d, d))
        return self.get(Long, "I") * d[2] / r**3

    def sunward(self, x):
        """The segment to the light, and where it ends."""
        return tuple(a - b for a, b in zip(self.get(Long, "light"), x)), mpf(1)


class Cylinder:
    """A solid circular cylinder on the floor."""

    def cylinder_hits(self, m, p, d):
        c, a = self.get(m, "center"), self.get(m, "a")
        o = (p[0] - c[0], p[1] - c[1])
        return quadratic(m, d[0] ** 2 + d[1] ** 2, o[0] * d[0] + o[1] * d[1], o[0] ** 2 + o[1] ** 2 - a * a)

    def gradient(self, m, q):
        c = self.get(m, "center")
        return unit(m, (q[0] - c[0], q[1] - c[1], 0 * q[0]))

    def excluded(self, x):
        c, a = self.get(Long, "center"), self.get(Long, "a")
        return (x[0] - c[0]) ** 2 + (x[1] - c[1]) ** 2 <= a * a

    def direct(self, x):
        if self.excluded(x):
            return mpf(0)
        d, end = self.sunward(x)
        hits = self.cylinder_hits(Long, x, d)
        if len(hits) == 2:
            # The part of the segment over the disc, against the part below the top.
            low, high = max(hits[0], 0), min(hits[1], end)
            if low < high and low * d[2] < self.get(Long, "H"):
                return mpf(0)
        return self.emitted(x)


class Pillar(Cylinder, PointLit):
    def trace(self, m, u, w, order):
        """Reflection point and direction afterwards; None for a ray that misses the side."""
        p, d = self.start(m, u, w)
        hits = [t for t in self.cylinder_hits(m, p, d) if t > 0]
        if len(hits) < 2:
            return None
        q = along(p, hits[0], d)
        return q, mirrored(d, self.gradient(m, q)), m.of(1)

    def range(self, m, order):
        """Azimuths around that of the axis, as far as the cylinder is seen."""
        light, c = self.get(m, "light"), self.get(m, "center")
        middle = m.atan2(c[1] - light[1], c[0] - light[0])
        return (middle - m.pi / 2, middle + m.pi / 2)

    def arrives(self, u, w, q, d, x):
        return not self.excluded(x) and 0 <= q[2] <= self.get(Long, "H")


class ConicWall(PointLit):
    """The conic by centre and half axes (or the vertex form of the parabola), in its own axes.

    The focus is the origin, +x points to the nearest vertex, p is the semi-latus rectum: with A = p/|1 - e^2|,
    B^2 = p A the ellipse is ((x + e A)/A)^2 + (y/B)^2 = 1, the hyperbola's branch ((x - e A)/A)^2 - (y/B)^2 = 1 with
    x < e A, and the parabola y^2 = 2 p (p/2 - x).
    """

    def form(self, m):
        """Coefficients of fxx x^2 + fyy y^2 + 2 fx x + f0 = 0."""
        p, e = self.get(m, "p"), self.get(m, "e")
        if e == 1:
            return m.of(0), m.of(1), p, -p * p
        a = p / abs(1 - e * e)
        b2 = p * a
        sign = 1 if e < 1 else -1
        middle = -e * a if e < 1 else e * a
        return 1 / a**2, sign / b2, -middle / a**2, (middle / a) ** 2 - 1

    def turned(self, m, v):
        c, s = self.get(m, "axis")
        return (v[0] * c + v[1] * s, v[1] * c - v[0] * s, v[2])

    def back(self, m, v):
        c, s = self.get(m, "axis")
        return (v[0] * c - v[1] * s, v[0] * s + v[1] * c, v[2])

    def local(self, m, v):
        f = self.get(m, "focus")
        return self.turned(m, (v[0] - f[0], v[1] - f[1], v[2]))

    def hits(self, m, p, d):
        """Meetings of a ray (own axes) with the curve's branch."""
        fxx, fyy, fx, f0 = self.form(m)
        found = quadratic(
            m,
            fxx * d[0] ** 2 + fyy * d[1] ** 2,
            fxx * p[0] * d[0] + fyy * p[1] * d[1] + fx * d[0],
            fxx * p[0] ** 2 + fyy * p[1] ** 2 + 2 * fx * p[0] + f0,
        )
        return [t for t in found if self.on_branch(m, along(p, t, d))]

    def on_branch(self, m, q):
        p, e = self.get(m, "p"), self.get(m, "e")
        return e <= 1 or q[0] < e * p / (e * e - 1)

    def stands(self, m, q):
        half = self.get(m, "half_arc")
        return half is None or abs(m.atan2(q[1], q[0])) <= half

    def reflect(self, m, u, w):
        """As `trace`, in the conic's own axes."""
        p, d = self.start(m, u, w)
        p, d = self.local(m, p), self.turned(m, d)
        hits = [t for t in self.hits(m, p, d) if t > 0]
        if not hits:
            return None
        q = along(p, min(hits), d)
        if not self.stands(m, q):
            return None
        fxx, fyy, fx, _ = self.form(m)
        n = unit(m, (fxx * q[0] + fx, fyy * q[1], 0 * q[0]))
        return q, mirrored(d, n)

    def trace(self, m, u, w, order):
        found = self.reflect(m, u, w)
        if found is None:
            return None
        q, d = found
        f = self.get(m, "focus")
        q, d = self.back(m, q), self.back(m, d)
        return (q[0] + f[0], q[1] + f[1], q[2]), d, m.of(1)

    def blocked(self, p, d, end, near):
        """Whether the standing wall cuts the open part of a ray (own axes) from `near` to `end`."""
        for t in self.hits(Long, p, d):
            q = along(p, t, d)
            if near < t < end and self.stands(Long, q) and q[2] <= self.get(Long, "H"):
                return True
        return False

    def arrives(self, u, w, q, d, x):
        if not 0 <= q[2] <= self.get(Long, "H"):
            return False
        q, d = self.reflect(Long, u, w)
        end = q[2] / -d[2]
        return not self.blocked(q, d, end, end * mpf(10) ** -30)

    def direct(self, x):
        d, end = self.sunward(x)
        p = self.local(Long, x)
        return mpf(0) if self.blocked(p, self.turned(Long, d), end, 0) else self.emitted(x)


class GlassPillar(Cylinder, Scene):
    """Rays of the beam by the angle u on the side where they come in, about the axis from -x, and the height w there."""

    def classes(self):
        return [("LRDE", 1), ("LTTDE", 2)] + [("LT" + "R" * (m - 2) + "TDE", m) for m in range(3, int(self.p["max_interactions"]) + 1)]

    def range(self, m, order):
        return (-m.pi / 2, m.pi / 2)

    def beam(self, m):
        return (self.get(m, "cos_elevation"), m.of(0), -self.get(m, "sin_elevation"))

    def side(self, m, u, w):
        c, a = self.get(m, "center"), self.get(m, "a")
        return (c[0] - a * m.cos(u), c[1] + a * m.sin(u), w)

    def refracted(self, m, d, n, ratio):
        """Snell's law on unit vectors; n towards where the light comes from, ratio = index before/after."""
        ci = -dot(d, n)
        ct = m.sqrt(1 - ratio * ratio * (1 - ci * ci))
        return along(tuple(ratio * x for x in d), ratio * ci - ct, n), ci, ct

    def shares(self, ci, ct, ratio):
        """Unpolarised reflectance and transmittance from Fresnel's amplitudes; ratio = index before/after."""
        rs = (ratio * ci - ct) / (ratio * ci + ct)
        rp = (ci - ratio * ct) / (ci + ratio * ct)
        f = (rs * rs + rp * rp) / 2
        return f, 1 - f

    def trace(self, m, u, w, order):
        q, d, n = self.side(m, u, w), self.beam(m), self.get(m, "n")
        normal = self.gradient(m, q)
        inner, ci, ct = self.refracted(m, d, normal, 1 / n)
        f, t = self.shares(ci, ct, 1 / n)
        if order == 1:
            return q, mirrored(d, normal), f
        weight, d = t, inner
        for k in range(2, order + 1):
            q = along(q, max(self.cylinder_hits(m, q, d)), d)
            normal = self.gradient(m, q)
            inward = tuple(-x for x in normal)
            out, ci, ct = self.refracted(m, d, inward, n)
            f, t = self.shares(ci, ct, n)
            if k == order:
                return q, out, weight * t
            weight, d = weight * f, mirrored(d, normal)

    def start(self, m, u, w):
        return self.side(m, u, w), None

    def flux(self, u, w):
        """E0 times the cross section of the beam per (du dw): d . (S_u x S_w) with S = (-a cos u, a sin u, w)."""
        a, d = self.get(Long, "a"), self.beam(Long)
        return self.get(Long, "E0") * abs(d[0] * a * mp.cos(u) - d[1] * a * mp.sin(u))

    def emitted(self, x):
        return self.get(Long, "E0") * self.get(Long, "sin_elevation")

    def sunward(self, x):
        return tuple(-v for v in self.beam(Long)), mp.inf

    def arrives(self, u, w, q, d, x):
        return not self.excluded(x) and q[2] > 0 and 0 < w <= self.get(Long, "H")


def miss(scene, m, u, x, order):
    """Signed distance at which the traced ray passes the point in plan, and how far ahead; None for no ray."""
    # The plan view of a mirror does not depend on w; nor does that of a vertical glass side, the slope being the beam's.
    traced = scene.trace(m, u, m.of(1), order)
    if traced is None:
        return None
    q, d, _ = traced
    v = (x[0] - q[0], x[1] - q[1])
    length = m.sqrt(d[0] ** 2 + d[1] ** 2)
    return (v[0] * d[1] - v[1] * d[0]) / length, (v[0] * d[0] + v[1] * d[1]) / length


def brackets(scene, x, order):
    """Intervals of u on which g changes its sign with the point ahead."""
    low, high = scene.range(Double, order)
    x = tuple(float(v) for v in x)

    def samples(low, high, n):
        at = [low + (high - low) * (k + 0.37) / (n + 1) for k in range(-1, n + 1)]
        at = [min(max(u, low), high) for u in at]
        return [(u, miss(scene, Double, u, x, order)) for u in at]

    def changes(row):
        return [
            (a, b)
            for (a, ga), (b, gb) in zip(row, row[1:])
            if ga and gb and ga[0] * gb[0] <= 0 and ga[1] > 0 and gb[1] > 0
        ]

    row = samples(low, high, SCAN)
    found = changes(row)
    for (a, ga), (_, gb), (c, gc) in zip(row, row[1:], row[2:]):
        if ga and gb and gc and ga[0] * gb[0] > 0 and gb[0] * gc[0] > 0:
            if abs(gb[0]) <= abs(ga[0]) and abs(gb[0]) <= abs(gc[0]):
                found += changes(samples(a, c, FINE))
    # Where rays begin to exist there is no neighbour to bracket with: the border is looked at more finely.
    for (a, ga), (b, gb) in zip(row, row[1:]):
        if (ga is None) != (gb is None):
            found += changes(samples(a, b, FINE))
    return sorted(set(found))


def root(scene, x, order, bracket):
    """u in 60 digits."""
    g = lambda u: miss(scene, Long, u, x, order)[0]
    a, b = (mpf(v) for v in bracket)
    for _ in range(24):
        middle = (a + b) / 2
        if g(a) * g(middle) <= 0:
            b = middle
        else:
            a = middle
    return mp.findroot(g, (a, b), solver="secant", tol=mpf(10) ** -45, maxsteps=60, verify=False)


def landing(scene, u, w, order):
    q, d, _ = scene.trace(Long, u, w, order)
    return to_floor(q, d)


def difference(f, at, step):
    """Central difference of order 8."""
    weights = [mpf(4) / 5, -mpf(1) / 5, mpf(4) / 105, -mpf(1) / 280]
    sums = [mpf(0)] * 2
    for k, c in enumerate(weights, 1):
        ahead, behind = f(at + k * step), f(at - k * step)
        sums = [s + c * (p - q) for s, p, q in zip(sums, ahead, behind)]
    return [s / step for s in sums]


def density(scene, u, w, order, step):
    """Irradiance of the floor by the ray (u, w)."""
    du = difference(lambda v: landing(scene, v, w, order)[:2], u, step)
    dw = difference(lambda v: landing(scene, u, v, order)[:2], w, step)
    area = abs(du[0] * dw[1] - du[1] * dw[0])
    return scene.flux(u, w) * scene.trace(Long, u, w, order)[2] / area


WORST = [mpf(0)]


def rays(scene, x, order):
    """All rays that arrive at x, brightest first."""
    found = []
    for bracket in brackets(scene, x, order):
        u = root(scene, x, order, bracket)
        _, ahead = miss(scene, Long, u, x, order)
        if ahead <= 0:
            continue
        if isinstance(scene, PointLit):
            q, _, _ = scene.trace(Long, u, mpf(1), order)
            light = scene.get(Long, "light")
            w = scene.slope(Long, mp.hypot(q[0] - light[0], q[1] - light[1]) + ahead)
        else:
            # The descent does not depend on the height of entry: one ray tells it.
            q, d, _ = scene.trace(Long, u, mpf(0), order)
            w = -(q[2] + d[2] / mp.hypot(d[0], d[1]) * ahead)
        q, d, weight = scene.trace(Long, u, w, order)
        end = to_floor(q, d)
        assert abs(end[0] - x[0]) + abs(end[1] - x[1]) < mpf(10) ** -45, (u, end)
        if not scene.arrives(u, w, q, d, x):
            continue
        e = density(scene, u, w, order, mpf(10) ** -7)
        second = density(scene, u, w, order, mpf(10) ** -7 / 2)
        WORST[0] = max(WORST[0], abs(e - second) / e)
        found.append((e, q, weight))
    return sorted(found, key=lambda r: -r[0])


def point(scene, name, x, note):
    x = [written_point(v) for v in x] + ["0"]
    at = tuple(mpf(v) for v in x)
    direct, total, paths = scene.direct(at), mpf(0), []
    for label, order in scene.classes():
        found = rays(scene, at, order)
        e = sum((r[0] for r in found), mpf(0))
        total += e
        listed = []
        for irradiance, q, weight in found:
            entry = {"s": [written(v) for v in q], "E": written(irradiance)}
            if isinstance(scene, GlassPillar):
                entry["fresnel_weight"] = written(weight)
            listed.append(entry)
        paths.append({"class": label, "count": len(found), "E": written(e), "roots": listed})
    albedo = scene.get(Long, "albedo")
    return {
        "id": name,
        "note": note,
        "x": x,
        "E_direct": written(direct),
        "E_caustic": written(total),
        "L_caustic": written(albedo * total / mp.pi),
        "L_total": written(albedo * (direct + total) / mp.pi),
        "paths": paths,
    }


def written_point(v):
    return v if isinstance(v, str) else repr(v)


def fold_between(scene, a, b, order):
    """Two points, 2e-4 on either side of where the number of roots changes between a and b, in six decimals."""
    place = lambda t: [a[k] + t * (b[k] - a[k]) for k in (0, 1)]
    count = lambda t: len(brackets(scene, place(t), order))
    low, high, first = 0.0, 1.0, count(0.0)
    assert count(1.0) != first, (a, b, first, count(1.0))
    for _ in range(36):
        middle = (low + high) / 2
        low, high = (middle, high) if count(middle) == first else (low, middle)
    length = math.hypot(b[0] - a[0], b[1] - a[1])
    return [[f"{v:.6f}" for v in place(low + s * 2e-4 / length)] for s in (-1, 1)]


def configuration(kind, name, description, parameters, points, folds=()):
    scene = kind(parameters)
    listed = [(x, note) for x, note in points]
    for a, b, order in folds:
        for x in fold_between(scene, a, b, order):
            listed.append((x, f"2e-4 from a fold of {dict((o, c) for c, o in scene.classes())[order]}"))
    rows = [point(scene, f"{name}-{k:02}", x, note) for k, (x, note) in enumerate(listed)]
    return {"id": name, "description": description, "parameters": parameters, "points": rows}


def pillar():
    low = dict(center=["0.125", "-0.25"], a="0.375", H="1.7", R="0.85", light=["-1.15", "0.65", "2.3"], I="31", albedo="0.6")
    high = dict(center=["-0.3", "0.2"], a="0.55", H="0.9", R="0.72", light=["1.4", "-0.35", "3.1"], I="17.5", albedo="0.45")
    near = dict(center=["0", "0"], a="1.3", H="2.6", R="0.93", light=["-1.32", "0.08", "0.7"], I="5.25", albedo="0.8")
    return [
        configuration(Pillar, "PI1", "light at the left, pillar lower than the light", low, [
            (["-0.9", "-0.7"], "in front"), (["-0.6", "0.4"], "near the light"), (["0.3", "0.9"], "grazing side"),
            (["-0.2", "-1.1"], "other side"), (["0.5", "-0.5"], "next to the pillar"), (["0.75", "-0.75"], "plan shadow"),
            (["1.9", "-1.6"], "full shadow"), (["-2.4", "1.7"], "far in front"), (["0.1", "-0.2"], "inside"),
        ]),
        configuration(Pillar, "PI2", "low pillar: the reflection leaves it at the top for far points", high, [
            (["0.6", "0.1"], "in front"), (["0.45", "0.75"], "side"), (["2.9", "0.4"], "beyond the reach of the side"),
            (["-0.4", "-0.9"], "grazing"), (["-1.1", "0.5"], "shadow"), (["-2.9", "0.9"], "over the top"), (["1.2", "-1.3"], "front"),
        ]),
        configuration(Pillar, "PI3", "light 0.0224 from a wide pillar", near, [
            (["-1.5", "0.3"], "at the light"), (["-1.6", "-0.9"], "front"), (["-1.31", "0.5"], "close to the side"),
            (["1.5", "0.2"], "shadow"), (["-3.2", "2.1"], "far"),
        ]),
    ]


def conic_wall():
    base = dict(R="0.9", albedo="0.65")
    parabola = dict(base, focus=["0.2", "-0.1"], axis=["0.6", "0.8"], p="0.8", e="1", half_arc="2.1", H="1.4")
    ellipse = dict(base, focus=["-0.35", "0.15"], axis=["-0.8", "0.6"], p="0.75", e="0.4", half_arc="closed", H="1.1")
    arc = dict(base, focus=["-0.15", "0.25"], axis=["1", "0"], p="0.9", e="0.6", half_arc="1.7", H="0.95")
    branch = dict(base, focus=["0.1", "0.2"], axis=["0.28", "-0.96"], p="0.7", e="1.5", half_arc="1.6", H="1.25")
    grid = [(["0.35", "0.1"], "inside"), (["-0.1", "-0.4"], "inside"), (["-0.5", "-0.6"], "towards the opening"),
            (["-1.3", "-1.1"], "far out of the opening"), (["0.9", "0.8"], "outside, behind the wall"), (["0.05", "0.3"], "inside")]
    return [
        configuration(ConicWall, "CW1", "parabola, light at the focus: parallel reflected light",
                      dict(parabola, light=["0.2", "-0.1", "1.9"], I="12"), grid),
        configuration(ConicWall, "CW2", "parabola, light elsewhere",
                      dict(parabola, light=["-0.15", "0.05", "2.2"], I="12.5"), grid, [((0.3, -1.1), (0.3, -0.2), 1)]),
        configuration(ConicWall, "CW3", "closed ellipse, light at a focus: point focus at the other",
                      dict(ellipse, H="2.2", light=["-0.35", "0.15", "2.6"], I="20"),
                      [(["-0.2", "0.3"], "inside"), (["0.3", "-0.6"], "beyond the other focus"), (["0.05", "0.2"], "inside"),
                       (["-0.7", "0.1"], "behind the light"), (["0.19", "-0.26"], "near the point focus"), (["0.9", "-0.7"], "outside")]),
        configuration(ConicWall, "CW4", "closed ellipse, light elsewhere",
                      dict(ellipse, H="2.1", light=["-0.1", "0.4", "2.75"], I="21"),
                      [(["0.25", "-0.15"], "inside"), (["0.05", "-0.4"], "inside"), (["-0.6", "0.3"], "inside"), (["0.4", "-0.3"], "inside"),
                       (["-0.2", "-0.2"], "inside"), (["0.6", "0.7"], "outside")],
                      [((-0.2, -0.1), (-0.2, -0.5), 1)]),
        configuration(ConicWall, "CW5", "arc of an ellipse, light elsewhere, wall higher than the light",
                      dict(arc, H="2.4", light=["-0.5", "0.35", "1.3"], I="9.5"),
                      [(["-0.2", "0.1"], "inside"), (["0.2", "0.5"], "inside"), (["-0.8", "-0.2"], "inside"), (["0.7", "0.25"], "behind the wall"),
                       (["-1.9", "0.9"], "out of the opening"), (["-0.4", "-0.5"], "inside")],
                      [((-0.7, 0.15), (-0.2, 0.15), 1)]),
        configuration(ConicWall, "CW6", "branch of a hyperbola, light at its focus: virtual focus",
                      dict(branch, H="1.7", light=["0.1", "0.2", "2.1"], I="14"),
                      [(["0.3", "0.1"], "inside"), (["-0.4", "0.6"], "inside"), (["0.6", "1.3"], "out of the opening"),
                       (["0.2", "-0.5"], "behind the wall"), (["-0.1", "0.05"], "inside"), (["-1.6", "2.2"], "far")]),
        configuration(ConicWall, "CW7", "branch of a hyperbola, light elsewhere",
                      dict(branch, H="2.6", light=["0.05", "0.75", "2.35"], I="15"),
                      [(["0.3", "0.1"], "inside"), (["-0.4", "0.6"], "inside"), (["0.25", "0.45"], "inside"),
                       (["0.2", "-0.5"], "behind the wall"), (["0.15", "0.95"], "inside"), (["-1.1", "2.2"], "far")],
                      [((-0.3, 1.2), (-0.3, 0.4), 1)]),
        configuration(ConicWall, "CW8", "circle, e = 0, light off the centre",
                      dict(base, focus=["0.05", "0.1"], axis=["0", "1"], p="1.2", e="0", half_arc="closed", H="2",
                           light=["0.65", "0.1", "2.4"], I="18"),
                      [(["-0.3", "0.2"], "inside"), (["-0.5", "-0.3"], "inside"), (["0.7", "0.4"], "inside"), (["-0.9", "0.1"], "inside")],
                      [((-0.6, 0.2), (0.1, 0.2), 1)]),
    ]


def glass_pillar():
    column = dict(center=["0.125", "-0.25"], a="0.375", H="1.5", n="1.5", E0="2", sin_elevation="0.6", cos_elevation="0.8",
                  albedo="0.7", max_interactions=5)
    steep = dict(center=["-0.2", "0.3"], a="0.5", H="2.2", n="1.33", E0="3.5", sin_elevation="0.8", cos_elevation="0.6",
                 albedo="0.55", max_interactions=4)
    low = dict(center=["0", "0"], a="0.6", H="0.9", n="1.33", E0="1.25", sin_elevation="0.28", cos_elevation="0.96",
               albedo="0.5", max_interactions=3)
    return [
        configuration(GlassPillar, "GP1", "index 1.5, plan index 1.7185", column, [
            (["0.9", "-0.2"], "behind, in the caustic"), (["1.4", "-0.6"], "behind, aside"), (["0.6", "0.4"], "aside"),
            (["-0.6", "0.1"], "in front: outside reflection"), (["0.3", "0.5"], "aside"), (["-0.5", "-0.9"], "front, aside"),
            (["2.6", "-0.25"], "beyond the height"), (["0.1", "-0.3"], "inside"),
        ], [((-1.3, -0.2), (-1.3, 0.3), 3), ((0.0, 0.5), (0.35, 0.5), 4), ((0.85, 0.5), (1.3, 0.5), 5)]),
        configuration(GlassPillar, "GP2", "water column in a steep sun", steep, [
            (["0.9", "0.35"], "behind"), (["0.7", "0.75"], "aside"), (["-0.9", "0.5"], "front"), (["-1.3", "-0.4"], "front, aside"),
            (["0.35", "0.3"], "at the side"), (["1.6", "0.2"], "behind"),
        ]),
        configuration(GlassPillar, "GP3", "water column in a low sun, plan index 1.354", low, [
            (["1.0", "0.1"], "behind"), (["0.95", "0.5"], "behind, aside"), (["-1.1", "0.2"], "front"), (["0.2", "1.0"], "aside"),
            (["3.9", "0.1"], "beyond the shadow"), (["-0.9", "-0.3"], "front"), (["0.75", "0"], "on the axis, three rays"),
        ], [((0.8, 0.01), (0.8, 0.3), 2), ((-0.3, 0.83), (0.1, 0.83), 3)]),
    ]


TABLES = {
    "pillar": (pillar, "convex vertical mirror under a point light: one reflection", ["LSDE"], {
        "pillar": "center (x, y), radius a, side from z = 0 to H with reflectance R, absorbing top; occludes direct light"}),
    "conic-wall": (conic_wall, "vertical wall over an arc of a conic, under a point light", ["LSDE"], {
        "wall": "r = p/(1 + e cos t) about `focus`, t from the unit vector `axis`, |t| <= half_arc (\"closed\": all round); from z = 0 "
                "to H; reflects with R inside, absorbs outside, occludes from both"}),
    "glass-pillar": (glass_pillar, "vertical glass cylinder in a beam along +x",
                     ["LRDE", "LTTDE", "LTRTDE", "LTRRTDE", "LTRRRTDE"], {
        "pillar": "center (x, y), radius a, side from z = 0 to H, index n; its top and the floor under it absorb",
        "beam": "direction (cos_elevation, 0, -sin_elevation), irradiance E0 across it",
        "E_caustic": "the sum of 1 to max_interactions interactions with the side"}),
}


def main():
    name = sys.argv[1]
    make, title, classes, conventions = TABLES[name]
    configurations = make()
    table = {
        "schema": "nephroid-theory-reference/1",
        "scene": name,
        "title": title,
        "units": {"length": "m", "intensity": "W/sr", "irradiance": "W/m^2", "radiance": "W/(m^2 sr)", "angle": "rad"},
        "conventions": dict({
            "light": "point light: intensity I [W/sr], isotropic",
            "receiver": "plane z=0 with normal +z",
            "decimals": "every parameter and coordinate is the exact decimal printed",
            "method": "vector ray trace of implicit surfaces, all roots by scan and findroot, flux density by 8th-order central "
                      "differences of the landing point, 60-digit arithmetic (vertical_walls.py)",
        }, **conventions),
        "path_classes": classes,
        "two_step_rel_diff": mpmath.nstr(WORST[0], 3),
        "configurations": configurations,
    }
    print(json.dumps(table, indent=1))


if __name__ == "__main__":
    main()
