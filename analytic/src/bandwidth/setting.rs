//! A plane mirror, a point light and a receiver plane, in any pose.

use crate::scene::{Entry, InvalidParameter, Kind, PlanarMirrorScene, RectangleMirror};
use crate::vector::{Vec3, vec3};

/// The points p with `normal`·p ≤ `offset`.
#[derive(Clone, Copy, Debug)]
pub struct HalfSpace {
    /// Outward normal, of any length.
    pub normal: Vec3<f64>,
    /// Offset along it.
    pub offset: f64,
}

/// Light, mirror and receiver of class L S D.
#[derive(Clone, Debug)]
pub struct PlanarSetting {
    /// Position y of the light [m].
    pub light: Vec3<f64>,
    /// R I: reflectance times radiant intensity [W/sr].
    pub strength: f64,
    /// A point of the mirror's plane [m].
    pub mirror_point: Vec3<f64>,
    /// Unit normal of the mirror's front.
    pub mirror_normal: Vec3<f64>,
    /// What of the plane is mirror: the part inside all of these (they contain no other points of the plane's normal
    /// direction, only their traces in the plane matter). Empty: unbounded.
    pub mirror_edges: Vec<HalfSpace>,
    /// Unit normal of the receiver.
    pub receiver_normal: Vec3<f64>,
    /// What of the receiver's plane exists. Empty: unbounded.
    pub receiver_edges: Vec<HalfSpace>,
    /// The linked distance of a ray that leaves the scene [m]; `None` in a scene with an unbounded surface, where such a
    /// ray contributes nothing.
    pub escape_distance: Option<f64>,
}

fn edge(normal: Vec3<f64>, center: Vec3<f64>, half: f64) -> [HalfSpace; 2] {
    let c = normal.dot(center);
    [
        HalfSpace {
            normal,
            offset: c + half,
        },
        HalfSpace {
            normal: -normal,
            offset: half - c,
        },
    ]
}

impl PlanarSetting {
    /// An unbounded mirror over an unbounded receiver. The receiver's plane goes through the point that is asked about.
    /// Normals may have any length.
    ///
    /// # Errors
    /// A light that is not in front of the mirror, a strength that is not positive, anything that is not finite.
    pub fn unbounded(
        light: [f64; 3],
        intensity: f64,
        mirror_point: [f64; 3],
        mirror_normal: [f64; 3],
        reflectance: f64,
        receiver_normal: [f64; 3],
    ) -> Result<Self, InvalidParameter> {
        let setting = PlanarSetting {
            light: Vec3::from_f64(light),
            strength: intensity * reflectance,
            mirror_point: Vec3::from_f64(mirror_point),
            mirror_normal: Vec3::from_f64(mirror_normal).normalized(),
            mirror_edges: Vec::new(),
            receiver_normal: Vec3::from_f64(receiver_normal).normalized(),
            receiver_edges: Vec::new(),
            escape_distance: None,
        };
        let invalid = |key: &str, found: String, allowed: &str| InvalidParameter {
            key: key.to_owned(),
            found,
            allowed: allowed.to_owned(),
        };
        let finite = |v: Vec3<f64>| v.to_f64().iter().all(|c| c.abs() <= 1e9);
        if !(setting.strength > 0.0 && setting.strength <= 1e18) {
            return Err(invalid(
                "I",
                setting.strength.to_string(),
                "intensity × reflectance greater than 0",
            ));
        }
        let normals = [setting.mirror_normal, setting.receiver_normal];
        if !(finite(setting.mirror_point) && normals.into_iter().all(finite)) {
            return Err(invalid(
                "mirror_normal",
                format!("{mirror_normal:?}"),
                "finite vectors of length other than 0",
            ));
        }
        if !(finite(setting.light) && setting.mirror_height(setting.light) > 0.0) {
            return Err(invalid(
                "light",
                format!("{light:?}"),
                "a point in front of the mirror",
            ));
        }
        Ok(setting)
    }

    /// Limits the mirror to a rectangle.
    pub fn with_mirror(mut self, mirror: &RectangleMirror) -> Self {
        let center = Vec3::from_f64(mirror.center);
        let along = Vec3::from_f64(mirror.edge).normalized();
        let across = self.mirror_normal.cross(along);
        self.mirror_edges = edge(along, center, mirror.half_width)
            .into_iter()
            .chain(edge(across, center, mirror.half_height))
            .collect();
        self
    }

    /// The setting of a catalogue or user entry; `None` for a kind without a plane mirror.
    ///
    /// # Errors
    /// What [`Entry::validate`] finds.
    pub fn of_entry(entry: &Entry) -> Result<Option<Self>, InvalidParameter> {
        entry.validate()?;
        let Kind::PlanarMirror(PlanarMirrorScene {
            light,
            floor,
            mirror,
        }) = &entry.kind
        else {
            return Ok(None);
        };
        let mut setting = PlanarSetting::unbounded(
            light.position,
            light.intensity,
            mirror.center,
            mirror.normal,
            mirror.reflectance,
            [0.0, 0.0, 1.0],
        )?
        .with_mirror(mirror);
        let center = vec3(floor.center[0], floor.center[1], 0.0);
        let [wx, wy] = floor.half_width;
        setting.receiver_edges = edge(vec3(1.0, 0.0, 0.0), center, wx)
            .into_iter()
            .chain(edge(vec3(0.0, 1.0, 0.0), center, wy))
            .collect();
        setting.escape_distance = Some(diagonal(&setting, mirror, center, [wx, wy]));
        Ok(Some(setting))
    }

    /// Height of a point above the mirror's plane [m], positive in front.
    pub fn mirror_height(&self, p: Vec3<f64>) -> f64 {
        (p - self.mirror_point).dot(self.mirror_normal)
    }

    /// The light's mirror image y'.
    pub fn image(&self) -> Vec3<f64> {
        self.light - self.mirror_normal * (2.0 * self.mirror_height(self.light))
    }
}

/// Diagonal of the axis-aligned box of floor, mirror and light: the linked distance of a ray that leaves the scene.
fn diagonal(
    setting: &PlanarSetting,
    mirror: &RectangleMirror,
    floor: Vec3<f64>,
    half: [f64; 2],
) -> f64 {
    let along = Vec3::from_f64(mirror.edge).normalized();
    let across = setting.mirror_normal.cross(along);
    let center = Vec3::from_f64(mirror.center);
    let signs = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
    let corners = signs.into_iter().flat_map(|(s, t)| {
        [
            center + along * (s * mirror.half_width) + across * (t * mirror.half_height),
            floor + vec3(s * half[0], t * half[1], 0.0),
        ]
    });
    let (mut low, mut high) = (setting.light, setting.light);
    for p in corners {
        low = vec3(low.x.min(p.x), low.y.min(p.y), low.z.min(p.z));
        high = vec3(high.x.max(p.x), high.y.max(p.y), high.z.max(p.z));
    }
    (high - low).length()
}
