//! Time per row.
use nephroid_analytic::pixel::PixelTruth;
use nephroid_analytic::scene::Entry;
fn main() {
    let text = std::fs::read_to_string(std::env::args().nth(1).unwrap()).unwrap();
    let mut e: Entry = serde_json::from_str(&text).unwrap();
    let n: u32 = std::env::args().nth(2).unwrap().parse().unwrap();
    let tol: f64 = std::env::args().nth(3).unwrap().parse().unwrap();
    e.camera.width = n;
    e.camera.height = n;
    let t = PixelTruth::new(&e).unwrap();
    let all = std::time::Instant::now();
    for j in 0..n {
        let s = std::time::Instant::now();
        let r = t.row(j, tol);
        let err: Vec<f64> = r
            .iter()
            .map(|c| c.iter().map(|b| b.error).fold(0.0, f64::max))
            .collect();
        println!("{j} {:.3} ms {err:?}", s.elapsed().as_secs_f64() * 1e3);
    }
    println!("total {:?}", all.elapsed());
}
