//! t
use nephroid_analytic::camera::Bounded;
use nephroid_analytic::flux::{Bundle, FluxImage, MARGINS, Ray};
use nephroid_analytic::scene::{Camera, Floor};
use std::sync::Arc;
#[derive(Debug)]
struct D(u32);
impl Bundle for D {
    fn domain(&self) -> [[f64; 2]; 2] {
        [[-1.0, 1.0]; 2]
    }
    fn ray(&self, [u, v]: [f64; 2]) -> Ray {
        let m = 1.0 - u * u - v * v;
        let w = m.sqrt();
        let mut margins = [1.0; MARGINS];
        (margins[0], margins[5]) = if self.0 == 0 {
            (w - 0.3, m)
        } else if self.0 == 1 {
            (m - 0.09, 1.0)
        } else {
            (m, w - 0.3)
        };
        Ray {
            floor: [0.5 * u, 0.5 * v + 0.1 * w],
            flux: w,
            margins,
        }
    }
}
#[test]
fn zz() {
    let camera = Camera {
        position: [0.03, -0.02, 3.0],
        look_at: [0.03, -0.02, 0.0],
        up: [0.0, 1.0, 0.0],
        field_of_view_degrees: 50.0,
        width: 32,
        height: 32,
    };
    let floor = Floor {
        center: [0.0, 0.0],
        half_width: [1.2, 1.1],
        albedo: 0.6,
    };
    let mut all = Vec::new();
    for k in 0..3 {
        let image = FluxImage::new(&camera, &floor, vec![vec![Arc::new(D(k))]]);
        println!("{image:?}");
        let mut v = Vec::new();
        for j in 0..32 {
            let mut row = vec![vec![Bounded::default(); 32]];
            image.row(j, 1e-8, &mut row);
            v.append(&mut row[0]);
        }
        let side = 6.0 * libm::tan(25.0_f64.to_radians()) / 32.0;
        println!(
            "{k} {:e} {:e}",
            v.iter().map(|p| p.value).sum::<f64>()
                / (std::f64::consts::TAU / 3.0 * (1.0 - 0.027) * 0.6
                    / std::f64::consts::PI
                    / side
                    / side)
                - 1.0,
            v.iter().map(|p| p.error).sum::<f64>()
        );
        all.push(v);
    }
    for k in 0..1024 {
        let d = all[0][k].value - all[1][k].value;
        if d.abs() > 1e-8 {
            println!("{k} {d:e} {:?} {:?}", all[0][k], all[1][k]);
        }
    }
}
