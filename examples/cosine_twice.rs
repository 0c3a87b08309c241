//! What a wrong integrator looks like: a path tracer that applies the receiver's cosine twice, on `mirror-wall`.
//!
//! Run with `cargo run --release --example cosine_twice`.

use nephroid::entry;
use nephroid::integrators::{Fault, Settings, by_name};
use nephroid::judge::hypotheses::LEVEL;
use nephroid::report::text;
use nephroid::verify::effort::Effort;
use nephroid::verify::expected::Truths;
use nephroid::verify::run::{Request, run};
use nephroid::verify::suite::{Coverage, Subject};

fn main() -> Result<(), nephroid::error::Error> {
    let settings = Settings {
        kernel: None,
        fault: Some(Fault::CosineTwice),
        ..Settings::default()
    };
    let margin = Effort::Quick.margin();
    let request = Request {
        scenes: vec![Subject {
            argument: "mirror-wall".to_owned(),
            entry: entry::load("mirror-wall")?,
        }],
        integrators: vec![by_name("pt", &settings)?],
        left_out: Vec::new(),
        effort: Effort::Quick,
        coverage: Coverage::Everything,
        margin,
        level: LEVEL,
        checks: None,
        most_paths: Effort::Quick.most_paths(),
        variations: false,
        seed: 1,
        bandwidth: 0.2,
        kernel: None,
        mask: None,
    };
    let outcome = run(&request, &mut Truths::for_margin(margin), &|_, _, _, _| {})?;
    println!("{}", text::outcome(&outcome));
    Ok(())
}
