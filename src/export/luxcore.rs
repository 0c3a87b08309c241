//! LuxCore: a scene and a configuration, both lists of properties. All surfaces are meshes; a `twosided` material gives mirrors
//! their black back.

use std::fmt::Write as _;

use glam::DVec3;

use super::model::{Geometry, Light, Material, Model};
use super::{Plan, number};

/// The name of the configuration, which names the scene file.
pub const FILE: &str = "render.cfg";
/// The name of the scene file.
pub const SCENE_FILE: &str = "scene.scn";
/// How one image is made.
pub const COMMAND: &str =
    "python {dir}/render.py --seed {seed} --spp {spp} --integrator {integrator} -o {out}";
/// The name of the program that renders, and its text.
pub const RENDER: (&str, &str) = ("render.py", include_str!("luxcore_render.py"));

/// The renderer has no shapes of its own; a rectangle is exactly two triangles.
pub fn is_native(_: &Geometry) -> bool {
    false
}

/// Power of a point light per radiant intensity, as the renderer counts it.
const POINT_GAIN: f64 = 4.0 * std::f64::consts::PI;

/// The scene file.
pub fn scene(model: &Model, plan: &Plan) -> String {
    let mut out = String::new();
    let _ = writeln!(out, "# {}. Metres, watts, z up.", plan.title);
    camera(&mut out, model);
    match model.light {
        Light::Point {
            position,
            intensity,
        } => {
            let _ = writeln!(out, "scene.lights.light.type = point");
            let _ = writeln!(out, "scene.lights.light.position = {}", triple(position));
            grey(&mut out, "scene.lights.light.color", 1.0);
            // The gain of a point light is its power over all directions.
            grey(&mut out, "scene.lights.light.gain", POINT_GAIN * intensity);
        }
        Light::Directional { travel, irradiance } => {
            let _ = writeln!(out, "scene.lights.light.type = sharpdistant");
            let _ = writeln!(out, "scene.lights.light.direction = {}", triple(travel));
            grey(&mut out, "scene.lights.light.color", 1.0);
            grey(&mut out, "scene.lights.light.gain", irradiance);
        }
    }
    out.push_str("scene.materials.black.type = matte\nscene.materials.black.kd = 0 0 0\n");
    for shape in &model.shapes {
        let name = shape.name;
        let file = super::mesh_file(name);
        let used = material(&mut out, name, shape.material);
        let _ = write!(
            out,
            "scene.shapes.{name}.type = mesh\nscene.shapes.{name}.ply = \"{file}\"\nscene.objects.{name}.shape = {name}\n\
             scene.objects.{name}.material = {used}\n"
        );
    }
    out
}

/// The configuration.
pub fn configuration(model: &Model, plan: &Plan) -> String {
    let (width, height) = (model.camera.width, model.camera.height);
    // Vertices from the eye or from the light, the last one included: one less than edges on one side alone.
    let depth = plan.edges;
    format!(
        "# {}. Rendered by render.py; see README.md.
scene.file = \"{SCENE_FILE}\"
renderengine.type = BIDIRCPU
renderengine.seed = 1
sampler.type = RANDOM
batch.haltspp = 64
path.pathdepth.total = {depth}
path.pathdepth.diffuse = {depth}
path.pathdepth.glossy = {depth}
path.pathdepth.specular = {depth}
path.hybridbackforward.enable = 0
path.clamping.variance.maxvalue = 0
path.maxdepth = {depth}
light.maxdepth = {depth}
film.width = {width}
film.height = {height}
film.filter.type = NONE
film.imagepipeline.0.type = NOP
film.outputs.0.type = RGB
film.outputs.0.filename = \"image.exr\"
",
        plan.title
    )
}

fn camera(out: &mut String, model: &Model) {
    let camera = &model.camera;
    let [from, to, up] =
        [camera.position, camera.look_at, camera.up].map(|p| triple(DVec3::from_array(p)));
    // The angle is that of the shorter side of the frame.
    let (w, h) = (f64::from(camera.width), f64::from(camera.height));
    let half = libm::tan(0.5 * camera.field_of_view_degrees.to_radians());
    let fov = 2.0 * libm::atan(half * (w / h).min(1.0)).to_degrees();
    // Film positions with the shorter side from -1 to 1, moved by the row by which the renderer draws lower.
    let (x, y) = ((w / h).max(1.0), (h / w).max(1.0));
    let row = 2.0 * y / h;
    let window = [-x, x, -y - row, y - row].map(number).join(" ");
    let _ = write!(
        out,
        "scene.camera.type = perspective\nscene.camera.lookat.orig = {from}\nscene.camera.lookat.target = {to}\n\
         scene.camera.up = {up}\nscene.camera.fieldofview = {}\nscene.camera.screenwindow = {window}\n\
         scene.camera.lensradius = 0\nscene.camera.autofocus.enable = 0\nscene.camera.cliphither = {}\n",
        number(fov),
        number(
            1e-3 * (DVec3::from_array(camera.look_at) - DVec3::from_array(camera.position))
                .length()
        ),
    );
}

/// Writes a material and returns the name under which a shape uses it.
fn material(out: &mut String, shape: &str, material: Material) -> String {
    let name = format!("{shape}_material");
    let key = format!("scene.materials.{name}");
    match material {
        Material::Black => return "black".to_owned(),
        Material::Lambert { albedo } => {
            let _ = writeln!(out, "{key}.type = matte");
            grey(out, &format!("{key}.kd"), albedo);
        }
        Material::Mirror { reflectance } => {
            let _ = writeln!(out, "scene.materials.{shape}_front.type = mirror");
            grey(
                out,
                &format!("scene.materials.{shape}_front.kr"),
                reflectance,
            );
            let _ = write!(
                out,
                "{key}.type = twosided\n{key}.frontmaterial = {shape}_front\n{key}.backmaterial = black\n"
            );
        }
        Material::Dielectric {
            index,
            transmit_only,
        } => {
            let _ = writeln!(out, "{key}.type = glass");
            grey(
                out,
                &format!("{key}.kr"),
                if transmit_only { 0.0 } else { 1.0 },
            );
            grey(out, &format!("{key}.kt"), 1.0);
            let _ = write!(
                out,
                "{key}.interiorior = {}\n{key}.exteriorior = 1\n",
                number(index)
            );
        }
    }
    name
}

fn grey(out: &mut String, key: &str, value: f64) {
    let value = number(value);
    let _ = writeln!(out, "{key} = {value} {value} {value}");
}

fn triple(p: DVec3) -> String {
    p.to_array().map(number).join(" ")
}
