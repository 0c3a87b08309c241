//! Translation and rotation: a scene that is moved has the irradiance that it had, at the place that moves with it.
//!
//! The floor is the plane z = 0, so that motions are those of the plane. What of them a kind's parameters can say is in
//! [`SYMMETRIES`].

use libm::sincos;
use nephroid::entry;
use nephroid_analytic::entries::WallTruth;
use nephroid_analytic::vector::{Vec3, vec3};
use toml::{Table, Value};

use crate::varied::{
    assert_complete, assert_same, catalogue, free_variations, get_vector, look_down_at, random,
    set, truth,
};

/// The motions of a scene that its parameters can express.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Group {
    /// All motions of space: no floor.
    Space,
    /// All motions of the plane.
    Plane,
    /// Translations only.
    Translations,
    /// Rotations about the z axis, where the wall is closed.
    Axis,
    /// The reflection that exchanges two mirrors; with one mirror, translations along it.
    Exchange,
    /// None but y → -y, which is tested for all kinds.
    None,
}

/// What each kind's parameters can express, and what stands in the way of the rest.
const SYMMETRIES: [(&str, Group, &str); 20] = [
    ("diffuse", Group::Plane, ""),
    ("planar-mirror", Group::Plane, ""),
    ("flat-interface", Group::Plane, ""),
    ("underwater", Group::Plane, ""),
    ("glass-slab", Group::Plane, ""),
    ("concave-sphere", Group::Plane, ""),
    ("convex-sphere", Group::Plane, ""),
    ("paraboloid", Group::Plane, ""),
    ("conic-mirrors", Group::Plane, ""),
    ("stigmatic-refractors", Group::Plane, ""),
    ("glass-sphere", Group::Plane, ""),
    ("water-waves", Group::Plane, ""),
    ("pillar", Group::Plane, ""),
    ("conic-wall", Group::Plane, ""),
    ("furnace", Group::Space, ""),
    ("glass-pillar", Group::Translations, "the beam is along +x"),
    (
        "cylinder-lamp",
        Group::Axis,
        "the wall is about the z axis, its arc about +x",
    ),
    (
        "planar-chains",
        Group::Exchange,
        "the edge is the z axis, one mirror at the polar angle 0",
    ),
    (
        "cylinder-cup",
        Group::None,
        "the beam is along +x, the wall about the z axis, its arc about +x",
    ),
    (
        "closed-cup",
        Group::None,
        "the beam is along +x, the wall about the z axis",
    ),
];

#[test]
fn every_kind_says_which_motions_it_can_express() {
    assert_complete(SYMMETRIES.iter().map(|s| s.0));
    for (kind, group, reason) in SYMMETRIES {
        let all = matches!(group, Group::Plane | Group::Space);
        assert_eq!(reason.is_empty(), all, "{kind}");
    }
}

/// A motion of the plane, (x, y) → linear (x, y) + shift.
#[derive(Clone, Copy, Debug)]
struct Motion {
    /// Columns: where the unit vectors along x and y go.
    linear: [[f64; 2]; 2],
    angle: f64,
    shift: [f64; 2],
}

impl Motion {
    fn new(angle: f64, shift: [f64; 2]) -> Self {
        let (s, c) = sincos(angle);
        Motion {
            linear: [[c, s], [-s, c]],
            angle,
            shift,
        }
    }

    fn turn(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [ex, ey] = self.linear;
        [ex[0] * x + ey[0] * y, ex[1] * x + ey[1] * y]
    }

    fn place(&self, point: [f64; 2]) -> [f64; 2] {
        let [x, y] = self.turn(point);
        [x + self.shift[0], y + self.shift[1]]
    }

    /// The entry moved: every key that is a place, a direction, an angle or a phase.
    fn apply(&self, entry: &Table) -> Table {
        let mut entry = entry.clone();
        let floor = entry["floor"].as_table_mut().unwrap();
        floor.entry("center").or_insert(Value::from(vec![0.0, 0.0]));
        for (_, value) in &mut entry {
            match value {
                Value::Table(table) => self.apply_to(table),
                Value::Array(list) => {
                    let tables = list.iter_mut().filter_map(Value::as_table_mut);
                    tables.for_each(|table| self.apply_to(table));
                }
                _ => {}
            }
        }
        entry
    }

    fn apply_to(&self, table: &mut Table) {
        for (key, value) in table.iter_mut() {
            let moved = match key.as_str() {
                "position" | "center" | "focus" | "look_at" => Motion::place,
                "normal" | "edge" | "up" | "direction" | "wave_vector" => Motion::turn,
                _ => continue,
            };
            let list = value.as_array_mut().unwrap();
            let plan = [0, 1].map(|i| list[i].as_float().unwrap());
            for (v, new) in list.iter_mut().zip(moved(self, plan)) {
                *v = Value::Float(new);
            }
        }
        if let Some(azimuth) = table.get_mut("azimuth_degrees") {
            let turned = azimuth.as_float().unwrap() + self.angle.to_degrees();
            *azimuth = Value::Float(turned - 360.0 * libm::round(turned / 360.0));
        }
        // A cos(k·(x - shift) + p).
        if let Some(k) = table.get("wave_vector").cloned() {
            let k = [0, 1].map(|i| k[i].as_float().unwrap());
            let phase = table["phase"].as_float().unwrap();
            let moved = phase - k[0] * self.shift[0] - k[1] * self.shift[1];
            table.insert("phase".to_owned(), Value::Float(moved));
        }
    }
}

fn group_of(entry: &Table) -> Group {
    let kind = entry["kind"].as_str().unwrap();
    SYMMETRIES.iter().find(|s| s.0 == kind).unwrap().1
}

/// Compares an entry's variations with themselves after a motion that is made of three random numbers.
fn check(name: &str, entry: &Table, least: u32, motion: impl Fn(&Table, [f64; 4]) -> Motion) {
    let mut compared = 0;
    free_variations(name, entry, 12, |varied, truth, [x, y], r| {
        let motion = motion(varied, r);
        let mut moved = motion.apply(varied);
        // The floor's rectangle does not turn; where it must be between walls, a small one is.
        set(&mut moved, "floor", "half_width", vec![0.01, 0.01]);
        let moved = self::truth(&moved).unwrap_or_else(|| panic!("{name} {motion:?}"));
        let [u, v] = motion.place([x, y]);
        compared += assert_same(name, "motion", &truth.at(x, y), &moved.at(u, v), 1.0);
    });
    assert!(compared >= least, "{name}: {compared}");
}

#[test]
fn irradiance_moves_with_the_scene() {
    const PI: f64 = core::f64::consts::PI;
    for (name, entry) in catalogue() {
        match group_of(&entry) {
            Group::Plane => check(&name, &entry, 20, |_, r| {
                Motion::new(PI * r[0], [2.0 * r[1], 2.0 * r[2]])
            }),
            Group::Translations => check(&name, &entry, 20, |_, r| {
                Motion::new(0.0, [2.0 * r[1], 2.0 * r[2]])
            }),
            _ => {}
        }
    }
}

#[test]
fn irradiance_turns_with_the_lamp_in_a_closed_wall() {
    let (name, mut entry) = named("cup-rim");
    assert_eq!(group_of(&entry), Group::Axis);
    look_down_at(&mut entry, [0.01, 0.012]);
    for inset in [0.0, 0.31] {
        set(&mut entry, "light", "inset", inset);
        set(&mut entry, "wall", "half_arc_degrees", 180.0);
        let mut compared = 0;
        free_variations(&name, &entry, 40, |varied, _, _, r| {
            // The variation took a few degrees off.
            let mut varied = varied.clone();
            set(&mut varied, "wall", "half_arc_degrees", 180.0);
            let motion = Motion::new(core::f64::consts::PI * r[0], [0.0, 0.0]);
            let (here, there) = (
                truth(&varied).unwrap(),
                truth(&motion.apply(&varied)).unwrap(),
            );
            let (x, y) = (0.7 * r[1], 0.7 * r[2]);
            let [u, v] = motion.place([x, y]);
            compared += assert_same(&name, "rotation", &here.at(x, y), &there.at(u, v), 1.0);
        });
        assert!(compared >= 40, "{name}: {compared}");
    }
}

#[test]
fn a_wedge_is_the_same_with_its_mirrors_exchanged() {
    let (name, entry) = named("corner");
    assert_eq!(group_of(&entry), Group::Exchange);
    check(&name, &entry, 20, |varied, _| {
        let divisor = varied["wedge"]["divisor"].as_integer().unwrap();
        let (s, c) = sincos(core::f64::consts::PI / divisor as f64);
        Motion {
            linear: [[c, s], [s, -c]],
            angle: 0.0,
            shift: [0.0, 0.0],
        }
    });
    let mut single = entry;
    set(&mut single, "wedge", "divisor", 1);
    check(&name, &single, 20, |_, r| {
        Motion::new(0.0, [3.0 * r[0], 0.0])
    });
}

#[test]
fn a_furnace_may_stand_anywhere_and_be_turned_in_space() {
    let entry = read("furnace");
    assert_eq!(group_of(&entry), Group::Space);
    let vector = |table: &str, key: &str| Vec3::from_f64(get_vector::<3>(&entry, table, key));
    random(24, |r: [f64; 8]| {
        let turn = |v: Vec3<f64>| {
            let (s, c) = sincos(3.0 * r[0]);
            let v = vec3(c * v.x - s * v.y, s * v.x + c * v.y, v.z);
            let (s, c) = sincos(3.0 * r[1]);
            vec3(v.x, c * v.y - s * v.z, s * v.y + c * v.z)
        };
        // Cameras are above z = 0.
        let shift = vec3(2.0 * r[2], 2.0 * r[3], 9.0 + r[4]);
        let mut moved = entry.clone();
        for (table, key) in [
            ("light", "position"),
            ("wall", "center"),
            ("camera", "position"),
            ("camera", "look_at"),
        ] {
            let v = turn(vector(table, key)) + shift;
            set(&mut moved, table, key, v.to_f64().to_vec());
        }
        let up = turn(vec3(0.0, 0.0, 1.0));
        set(&mut moved, "camera", "up", up.to_f64().to_vec());
        let wall = |entry: &Table| {
            let entry = entry::from_toml("moved.toml", &entry.to_string()).unwrap();
            WallTruth::new(&entry).unwrap()
        };
        let direction = vec3(r[5], r[6], r[7]);
        let (here, there) = (wall(&entry).at(direction), wall(&moved).at(turn(direction)));
        assert_eq!(
            assert_same("furnace", "motion", &here, &there, 1.0) as usize,
            here.len()
        );
    });
}

fn read(name: &str) -> Table {
    let text = std::fs::read_to_string(format!("scenes/{name}.toml")).unwrap();
    text.parse().unwrap()
}

fn named(name: &str) -> (String, Table) {
    (name.to_owned(), read(name))
}
