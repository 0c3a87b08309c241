//! Compare.
use nephroid_analytic::pixel::PixelTruth;
use nephroid_analytic::scene::Entry;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let text = std::fs::read_to_string(&a[1]).unwrap();
    let mut e: Entry = serde_json::from_str(&text).unwrap();
    let n: usize = a[2].parse().unwrap();
    let m: usize = a[3].parse().unwrap();
    let tol: f64 = a[4].parse().unwrap();
    let mut im = |n: usize| {
        e.camera.width = n as u32;
        e.camera.height = n as u32;
        let t = PixelTruth::new(&e).unwrap();
        (0..n as u32).map(|j| t.row(j, tol)).collect::<Vec<_>>()
    };
    let c = im(n);
    let f = im(n * m);
    for k in 0..c[0].len() {
        let mut list = vec![];
        let mut tot = 0.0;
        for j in 0..n {
            for i in 0..n {
                let mut s = 0.0;
                let mut er = 0.0;
                for y in 0..m {
                    for x in 0..m {
                        let b = f[j * m + y][k][i * m + x];
                        s += b.value;
                        er += b.error;
                    }
                }
                let w = (m * m) as f64;
                let d = c[j][k][i].value - s / w;
                tot += d;
                list.push((d.abs(), d, i, j, c[j][k][i], er / w, s / w));
            }
        }
        list.sort_by(|a, b| b.0.total_cmp(&a.0));
        println!("class {k} total difference {:e}", tot / (n * n) as f64);
        for l in &list[..6] {
            println!("  {:?}", l);
        }
    }
}
