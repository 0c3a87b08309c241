//! pbrt-v4: a scene file, and a small file per integrator that is given before it. Rectangles, disks, spheres and arcs of cylinders
//! are its own shapes.
//!
//! Its smooth conductor reflects from both sides: a mirror has a black surface close behind it. Its conductor with a given
//! reflectance obeys Fresnel's law about that, so that a mirror is a mixture of a full one and of black in the proportion R. Its
//! dielectric always reflects as well; the path depth leaves out what that brings.

use std::fmt::Write as _;

use glam::DVec3;

use super::model::{Geometry, Light, Material, Model, Shape, is_closed};
use super::{Plan, number};

/// The name of the scene file.
pub const FILE: &str = "scene.pbrt";
/// How one image is made.
pub const COMMAND: &str = "pbrt --seed {seed} --spp {spp} --outfile {out} {dir}/integrator-{integrator}.pbrt {dir}/scene.pbrt";

/// Distance of a mirror's black back, relative to the mirror's size.
const BACK: f64 = 1e-4;

/// Whether the renderer has the shape itself.
pub fn is_native(geometry: &Geometry) -> bool {
    !matches!(geometry, Geometry::Patch(_))
}

/// The file of an integrator. The depth counts interactions: edges less one.
pub fn integrator(name: &str, plan: &Plan) -> String {
    let depth = plan.edges.saturating_sub(1);
    let extra = match name {
        "bdpt" => " \"bool regularize\" false",
        _ => "",
    };
    format!("Integrator \"{name}\" \"integer maxdepth\" [ {depth} ]{extra}\n")
}

/// The scene file.
pub fn scene(model: &Model, plan: &Plan) -> String {
    let mut out = String::new();
    let camera = &model.camera;
    let [from, to, up] =
        [camera.position, camera.look_at, camera.up].map(|p| triple(DVec3::from_array(p)));
    // The angle is that of the shorter side of the frame.
    let (w, h) = (f64::from(camera.width), f64::from(camera.height));
    let half = libm::tan(0.5 * camera.field_of_view_degrees.to_radians());
    let fov = number(2.0 * libm::atan(half * (w / h).min(1.0)).to_degrees());
    let (width, height) = (camera.width, camera.height);
    let _ = write!(
        out,
        "# {}. Metres, watts, z up.
# The renderer's own frame is left-handed.
Scale -1 1 1
LookAt {from}  {to}  {up}
Camera \"perspective\" \"float fov\" [ {fov} ]
Sampler \"independent\" \"integer pixelsamples\" [ 64 ]
PixelFilter \"box\" \"float xradius\" [ 0.5 ] \"float yradius\" [ 0.5 ]
Film \"rgb\" \"integer xresolution\" [ {width} ] \"integer yresolution\" [ {height} ]
    \"string filename\" \"image.exr\" \"bool savefp16\" false
WorldBegin
",
        plan.title
    );
    match model.light {
        Light::Point {
            position,
            intensity,
        } => {
            let _ = writeln!(
                out,
                "LightSource \"point\" \"point3 from\" [ {} ] \"rgb I\" [ {} ]",
                triple(position),
                grey(intensity)
            );
        }
        Light::Directional { travel, irradiance } => {
            let _ = writeln!(
                out,
                "LightSource \"distant\" \"point3 from\" [ 0 0 0 ] \"point3 to\" [ {} ] \"rgb L\" [ {} ]",
                triple(travel),
                grey(irradiance)
            );
        }
    }
    out.push_str(
        "MakeNamedMaterial \"black\" \"string type\" \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\n\
         MakeNamedMaterial \"full_mirror\" \"string type\" \"conductor\" \"rgb reflectance\" [ 1 1 1 ]\n",
    );
    for shape in &model.shapes {
        surface(&mut out, shape);
    }
    out
}

/// Whether a mirror needs a black back: not if it is the outside of a body.
pub fn needs_back(shape: &Shape) -> bool {
    let body = match shape.geometry {
        Geometry::Sphere { inward, .. } => !inward,
        Geometry::Cylinder {
            inward, half_arc, ..
        } => !inward && is_closed(half_arc),
        _ => false,
    };
    matches!(shape.material, Material::Mirror { .. }) && !body
}

fn surface(out: &mut String, shape: &Shape) {
    let name = shape.name;
    match shape.material {
        Material::Black => out.push_str("NamedMaterial \"black\"\n"),
        Material::Lambert { albedo } => {
            let _ = writeln!(
                out,
                "Material \"diffuse\" \"rgb reflectance\" [ {} ]",
                grey(albedo)
            );
        }
        Material::Dielectric { index, .. } => {
            let _ = writeln!(
                out,
                "Material \"dielectric\" \"float eta\" [ {} ]",
                number(index)
            );
        }
        Material::Mirror { reflectance } => {
            let _ = write!(
                out,
                "MakeNamedMaterial \"{name}\" \"string type\" \"mix\" \"string materials\" [ \"full_mirror\" \"black\" ] \
                 \"float amount\" [ {} ]\nNamedMaterial \"{name}\"\n",
                number(1.0 - reflectance)
            );
        }
    }
    write_geometry(out, name, &shape.geometry);
    if needs_back(shape) {
        out.push_str("NamedMaterial \"black\"\n");
        match behind(&shape.geometry) {
            Some(back) => write_geometry(out, name, &back),
            None => {
                let file = super::mesh_file(&format!("{name}_back"));
                let _ = writeln!(out, "Shape \"plymesh\" \"string filename\" \"{file}\"");
            }
        }
    }
}

/// The distance of a mesh's back [m].
pub fn back_distance(size: f64) -> f64 {
    BACK * size
}

/// The same geometry a little behind its front; `None` for a mesh.
fn behind(geometry: &Geometry) -> Option<Geometry> {
    match *geometry {
        Geometry::Rectangle { center, u, v } => {
            let n = u.cross(v).normalize();
            let distance = back_distance(u.length().min(v.length()));
            Some(Geometry::Rectangle {
                center: center - n * distance,
                u,
                v,
            })
        }
        Geometry::Cylinder {
            axis,
            radius,
            z,
            half_arc,
            inward,
        } => {
            let side = if inward { 1.0 } else { -1.0 };
            Some(Geometry::Cylinder {
                axis,
                radius: radius + side * back_distance(radius),
                z,
                half_arc,
                inward,
            })
        }
        Geometry::Sphere {
            center,
            radius,
            inward,
        } => {
            let side = if inward { 1.0 } else { -1.0 };
            Some(Geometry::Sphere {
                center,
                radius: radius + side * back_distance(radius),
                inward,
            })
        }
        _ => None,
    }
}

fn write_geometry(out: &mut String, name: &str, geometry: &Geometry) {
    let placed = |out: &mut String, at: DVec3, turn: f64, inward: bool, shape: String| {
        let _ = writeln!(out, "AttributeBegin\n  Translate {}", triple(at));
        if turn != 0.0 {
            let _ = writeln!(out, "  Rotate {} 0 0 1", number(turn.to_degrees()));
        }
        if inward {
            out.push_str("  ReverseOrientation\n");
        }
        let _ = writeln!(out, "  {shape}\nAttributeEnd");
    };
    match *geometry {
        Geometry::Rectangle { center, u, v } => {
            let corners = [-u - v, u - v, u + v, v - u]
                .map(|c| triple(center + c))
                .join("  ");
            let _ = writeln!(
                out,
                "Shape \"trianglemesh\" \"integer indices\" [ 0 1 2  0 2 3 ] \"point3 P\" [ {corners} ]"
            );
        }
        Geometry::Disk {
            center,
            inner,
            radius,
        } => {
            let shape = format!(
                "Shape \"disk\" \"float radius\" [ {} ] \"float innerradius\" [ {} ]",
                number(radius),
                number(inner)
            );
            placed(out, center, 0.0, false, shape);
        }
        Geometry::Sphere {
            center,
            radius,
            inward,
        } => {
            let shape = format!("Shape \"sphere\" \"float radius\" [ {} ]", number(radius));
            placed(out, center, 0.0, inward, shape);
        }
        Geometry::Cylinder {
            axis: [x, y],
            radius,
            z: [low, high],
            half_arc,
            inward,
        } => {
            let closed = is_closed(half_arc);
            let (turn, sweep) = if closed {
                (0.0, 360.0)
            } else {
                (-half_arc, 2.0 * half_arc.to_degrees())
            };
            let shape = format!(
                "Shape \"cylinder\" \"float radius\" [ {} ] \"float zmin\" [ {} ] \"float zmax\" [ {} ] \"float phimax\" [ {} ]",
                number(radius),
                number(low),
                number(high),
                number(sweep)
            );
            placed(out, DVec3::new(x, y, 0.0), turn, inward, shape);
        }
        Geometry::Patch(_) => {
            let file = super::mesh_file(name);
            let _ = writeln!(out, "Shape \"plymesh\" \"string filename\" \"{file}\"");
        }
    }
}

fn grey(value: f64) -> String {
    [value; 3].map(number).join(" ")
}

fn triple(p: DVec3) -> String {
    p.to_array().map(number).join(" ")
}
