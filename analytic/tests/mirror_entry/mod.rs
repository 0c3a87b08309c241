//! Entries of the kind `planar-mirror`.

use nephroid_analytic::scene::{
    Camera, Entry, Floor, Kind, PlanarMirrorScene, PointLight, RectangleMirror,
};

/// An entry with a square picture of `size` pixels; the camera is (position, looked at, field of view [degrees]).
pub fn mirror_entry(
    position: [f64; 3],
    intensity: f64,
    floor: Floor,
    mirror: RectangleMirror,
    (from, look_at, field_of_view_degrees): ([f64; 3], [f64; 3], f64),
    size: u32,
) -> Entry {
    Entry {
        name: "test".to_owned(),
        title: "test".to_owned(),
        kind: Kind::PlanarMirror(PlanarMirrorScene {
            light: PointLight {
                position,
                intensity,
            },
            floor,
            mirror,
        }),
        camera: Camera {
            position: from,
            look_at,
            up: [0.0, 0.0, 1.0],
            field_of_view_degrees,
            width: size,
            height: size,
        },
    }
}
