//! Mitsuba 3: one XML file. Rectangle, disk, sphere and closed cylinder are its own shapes; its smooth conductor reflects on the
//! front only, as mirrors do here.

use std::fmt::Write as _;

use glam::DVec3;

use super::model::{Geometry, Light, Material, Model, Shape, is_closed};
use super::{Plan, number};

/// The name of the scene file.
pub const FILE: &str = "scene.xml";
/// How one image is made.
pub const COMMAND: &str = "mitsuba -m scalar_rgb -Dseed={seed} -Dspp={spp} -Dintegrator={integrator} -o {out} {dir}/scene.xml";

/// Whether the renderer has the shape itself.
pub fn is_native(geometry: &Geometry) -> bool {
    match geometry {
        Geometry::Rectangle { .. } | Geometry::Sphere { .. } => true,
        Geometry::Disk { inner, .. } => *inner == 0.0,
        Geometry::Cylinder { half_arc, .. } => is_closed(*half_arc),
        Geometry::Patch(_) => false,
    }
}

/// How far apart seeds must be. Pixels of `path`, and blocks of particles of `ptracer`, take the seed plus their number as their
/// own: the images of two seeds that differ by less than the number of pixels share random numbers.
pub fn seed_spacing(width: u32, height: u32) -> u64 {
    // Blocks at the border are whole ones.
    let padded = |side: u32| u64::from(side.div_ceil(64)) * 64;
    padded(width) * padded(height)
}

/// The scene file.
pub fn scene(model: &Model, plan: &Plan) -> String {
    let mut out = String::new();
    let camera = &model.camera;
    let [from, to, up] = [camera.position, camera.look_at, camera.up].map(|p| triple(p, ", "));
    let distance =
        (DVec3::from_array(camera.look_at) - DVec3::from_array(camera.position)).length();
    let (near, far) = (number(1e-3 * distance), number(1e3 * distance));
    let (fov, width, height) = (
        number(camera.field_of_view_degrees),
        camera.width,
        camera.height,
    );
    let (title, depth) = (&plan.title, plan.edges);
    let spacing = seed_spacing(width, height);
    let _ = write!(
        out,
        r#"<?xml version="1.0" encoding="utf-8"?>
<!-- {title}. Metres, watts, z up; radiance in W/(m² sr), the same in every colour channel. -->
<scene version="3.0.0">
    <default name="seed" value="0"/>
    <default name="spp" value="64"/>
    <default name="integrator" value="path"/>
    <!-- Edges from the light to the eye. -->
    <default name="max_depth" value="{depth}"/>

    <integrator type="$integrator">
        <integer name="max_depth" value="$max_depth"/>
    </integrator>

    <sensor type="perspective">
        <string name="fov_axis" value="y"/>
        <float name="fov" value="{fov}"/>
        <float name="near_clip" value="{near}"/>
        <float name="far_clip" value="{far}"/>
        <transform name="to_world">
            <lookat origin="{from}" target="{to}" up="{up}"/>
        </transform>
        <sampler type="independent">
            <integer name="sample_count" value="$spp"/>
            <!-- Pixels, or blocks of particles, take the seeds that follow: seeds closer than {spacing} share random numbers. -->
            <integer name="seed" value="$seed"/>
        </sampler>
        <film type="hdrfilm">
            <integer name="width" value="{width}"/>
            <integer name="height" value="{height}"/>
            <string name="file_format" value="openexr"/>
            <string name="pixel_format" value="rgb"/>
            <string name="component_format" value="float32"/>
            <rfilter type="box"/>
        </film>
    </sensor>

"#
    );
    light(&mut out, &model.light);
    for shape in &model.shapes {
        surface(&mut out, shape);
    }
    out.push_str("</scene>\n");
    out
}

fn light(out: &mut String, light: &Light) {
    let _ = match *light {
        Light::Point {
            position,
            intensity,
        } => write!(
            out,
            "    <emitter type=\"point\">\n        <point name=\"position\" value=\"{}\"/>\n        \
             <rgb name=\"intensity\" value=\"{}\"/>\n    </emitter>\n",
            triple(position.to_array(), ", "),
            number(intensity)
        ),
        Light::Directional { travel, irradiance } => write!(
            out,
            "    <emitter type=\"directional\">\n        <vector name=\"direction\" value=\"{}\"/>\n        \
             <rgb name=\"irradiance\" value=\"{}\"/>\n    </emitter>\n",
            triple(travel.to_array(), ", "),
            number(irradiance)
        ),
    };
}

fn surface(out: &mut String, shape: &Shape) {
    let (kind, lines) = geometry(shape);
    let _ = write!(out, "\n    <shape type=\"{kind}\" id=\"{}\">\n", shape.name);
    for line in lines.into_iter().chain(material(shape.material)) {
        let _ = writeln!(out, "        {line}");
    }
    out.push_str("    </shape>\n");
}

fn geometry(shape: &Shape) -> (&'static str, Vec<String>) {
    let flipped =
        |yes: bool| yes.then(|| r#"<boolean name="flip_normals" value="true"/>"#.to_owned());
    let point = |name: &str, [x, y, z]: [f64; 3]| {
        let [x, y, z] = [x, y, z].map(number);
        format!(r#"<point name="{name}" x="{x}" y="{y}" z="{z}"/>"#)
    };
    let radius = |r: f64| format!(r#"<float name="radius" value="{}"/>"#, number(r));
    match shape.geometry {
        Geometry::Rectangle { center, u, v } => ("rectangle", frame(center, u, v)),
        Geometry::Disk {
            center,
            radius,
            inner: 0.0,
        } => ("disk", frame(center, DVec3::X * radius, DVec3::Y * radius)),
        Geometry::Sphere {
            center,
            radius: r,
            inward,
        } => {
            let mut lines = vec![point("center", center.to_array()), radius(r)];
            lines.extend(flipped(inward));
            ("sphere", lines)
        }
        Geometry::Cylinder {
            axis: [x, y],
            radius: r,
            z: [low, high],
            half_arc,
            inward,
        } if is_closed(half_arc) => {
            let mut lines = vec![
                point("p0", [x, y, low]),
                point("p1", [x, y, high]),
                radius(r),
            ];
            lines.extend(flipped(inward));
            ("cylinder", lines)
        }
        _ => {
            let file = super::mesh_file(shape.name);
            (
                "ply",
                vec![format!(r#"<string name="filename" value="{file}"/>"#)],
            )
        }
    }
}

/// The transform that takes the unit square or disk in z = 0 to u, v and the normal between them.
fn frame(center: DVec3, u: DVec3, v: DVec3) -> Vec<String> {
    let n = u.cross(v).normalize();
    let rows = (0..3).flat_map(|k| [u[k], v[k], n[k], center[k]]);
    let values: Vec<_> = rows.chain([0.0, 0.0, 0.0, 1.0]).map(number).collect();
    vec![format!(
        r#"<transform name="to_world"><matrix value="{}"/></transform>"#,
        values.join(" ")
    )]
}

fn material(material: Material) -> Vec<String> {
    let rgb =
        |name: &str, value: f64| format!(r#"    <rgb name="{name}" value="{}"/>"#, number(value));
    let (kind, inner) = match material {
        Material::Lambert { albedo } => ("diffuse", vec![rgb("reflectance", albedo)]),
        Material::Black => ("diffuse", vec![rgb("reflectance", 0.0)]),
        Material::Mirror { reflectance } => (
            "conductor",
            vec![
                r#"    <string name="material" value="none"/>"#.to_owned(),
                rgb("specular_reflectance", reflectance),
            ],
        ),
        Material::Dielectric {
            index,
            transmit_only,
        } => {
            let mut inner = vec![
                format!(r#"    <float name="int_ior" value="{}"/>"#, number(index)),
                r#"    <float name="ext_ior" value="1"/>"#.to_owned(),
            ];
            inner.extend(transmit_only.then(|| rgb("specular_reflectance", 0.0)));
            ("dielectric", inner)
        }
    };
    let mut lines = vec![format!(r#"<bsdf type="{kind}">"#)];
    lines.extend(inner);
    lines.push("</bsdf>".to_owned());
    lines
}

fn triple(p: [f64; 3], between: &str) -> String {
    p.map(number).join(between)
}
