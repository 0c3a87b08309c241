//! The stability study: no formula loses more than its conditioning explains, every bound holds, and the study can tell.

use std::process::Command;
use std::sync::LazyLock;

use nephroid::stability::bandwidth::{AZIMUTHS, LEFT_OUT, RADII, moments, relative_bias};
use nephroid::stability::quantity::{Against, Moment, Quantity};
use nephroid::stability::{ALLOWED_EXCESS, Outcome, Precision, Row, Step, forms, study, sweeps};
use nephroid_analytic::scalar::Scalar;

/// All sweeps, once for all tests.
static ROWS: LazyLock<Vec<Row>> = LazyLock::new(|| study(None));

#[test]
fn no_formula_loses_more_than_four_digits_beyond_its_conditioning() {
    let rows = &*ROWS;
    let mut kinds: Vec<_> = rows.iter().map(|r| r.kind).collect();
    kinds.sort_unstable();
    kinds.dedup();
    assert_eq!(kinds.len(), 16, "{kinds:?}");
    for row in rows {
        let name = format!("{} {} {}", row.kind, row.danger, row.precision.name());
        // In single precision few points of a grazing ray can be told from the wall.
        assert!(row.compared() >= 1, "{name}");
        assert!(
            row.worst_excess() <= ALLOWED_EXCESS,
            "{name}: {}",
            row.worst_excess()
        );
        assert_eq!(row.unbounded(), 0, "{name}: {:?}", row.steps);
        if row.precision == Precision::Double {
            // Less than this would mean that the sweep never gets near its danger with numbers that can be compared.
            assert!(
                2 * row.compared() >= row.steps.len(),
                "{name}: {}",
                row.compared()
            );
        }
    }
    // Towards a fold the conditioning grows like the inverse distance: the sweeps do get there.
    let folds = rows
        .iter()
        .filter(|r| r.danger == "fold" && r.precision == Precision::Double);
    assert!(folds.into_iter().all(|r| r.worst_conditioning() >= 1e8));
}

/// Every sweep of a bandwidth with what it computes.
fn bandwidth_sweeps() -> Vec<(sweeps::Sweep, Moment)> {
    let with_moment = |sweep: sweeps::Sweep| match sweep.quantity {
        Quantity::Bandwidth(moment) => Some((sweep, moment)),
        Quantity::Caustic => None,
    };
    sweeps::all().into_iter().filter_map(with_moment).collect()
}

/// Down to 1e-9 no digit is lost: means and second moments to 1e-13, whatever their conditioning.
#[test]
fn expectations_keep_their_digits_down_to_a_bandwidth_of_1e_9() {
    let rows = &*ROWS;
    for (sweep, _) in bandwidth_sweeps() {
        assert_eq!(*sweep.values.last().unwrap(), 1e-9);
        let is_it = |r: &&Row| r.kind == sweep.kind && r.danger == sweep.danger;
        let row = rows.iter().find(is_it).unwrap();
        assert_eq!(row.compared(), row.steps.len(), "{}", row.danger);
        assert!(
            row.worst_error() <= 1e-13,
            "{} {}",
            row.danger,
            row.worst_error()
        );
    }
}

/// The references themselves: the double-double sums have converged, and tend to the certified limit as the law says,
/// which is another derivation.
#[test]
fn the_references_of_the_bandwidth_sweeps_agree() {
    let mut laws = 0;
    for (sweep, moment) in bandwidth_sweeps() {
        let technique = moment.technique;
        let widest = (sweep.at)(0.1);
        if moment.against == Against::DoubleDouble {
            let once = moments(technique, &widest, AZIMUTHS, RADII).unwrap();
            let twice = moments(technique, &widest, 2 * AZIMUTHS, 2 * RADII).unwrap();
            for (a, b) in once.into_iter().zip(twice) {
                let off = ((a - b) / b).to_f64().abs();
                assert!(off <= 1e-15, "{technique} {off:e}");
            }
            continue;
        }
        if moment.kernel != technique.default_kernel() || technique.name() == "linked" {
            // The double-double sums are of the default kernel, and off the axis.
            continue;
        }
        let numbers = (sweep.at)(1e-2);
        let limit = forms::enclosed("planar-mirror", &numbers)
            .unwrap()
            .value
            .middle();
        let mean = moments(technique, &numbers, AZIMUTHS, RADII).unwrap()[0].to_f64();
        let bias = relative_bias(technique, moment.kernel, &numbers);
        let rest = (mean / limit - 1.0 - bias).abs();
        assert!(rest <= 0.1 * LEFT_OUT * 1e-8, "{technique} {rest:e}");
        assert!(bias.abs() >= 1e-6, "{technique} {bias:e}");
        laws += 1;
    }
    assert_eq!(laws, 4);
}

#[test]
fn a_formula_that_cancels_is_told() {
    // 1 - cos t for (t/2)², t = 1e-3: seven digits are lost, the conditioning explains none.
    let t = 1e-3_f32;
    let naive = f64::from(1.0 - libm::cosf(t));
    let half = libm::sin(0.5 * f64::from(t));
    let exact = 2.0 * half * half;
    let step = Step {
        t: 1e-3,
        outcome: Outcome::Compared {
            error: ((naive - exact) / exact).abs(),
            conditioning: 2.0,
            bounded: true,
        },
    };
    let excess = step.outcome.excess(Precision::Single).unwrap();
    assert!(excess > ALLOWED_EXCESS, "{excess}");
}

#[test]
fn the_command_prints_a_table_and_draws_a_plot() {
    let plot = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("stability.svg");
    let output = Command::new(env!("CARGO_BIN_EXE_nephroid"))
        .args(["stability", "mirror-wall", "--plot"])
        .arg(&plot)
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
    let table = String::from_utf8(output.stdout).unwrap();
    assert!(
        table.contains("grazing incidence") && table.contains("f32"),
        "{table}"
    );
    assert!(
        table
            .lines()
            .skip(1)
            .all(|l| l.starts_with("planar-mirror")),
        "{table}"
    );
    let svg = std::fs::read_to_string(&plot).unwrap();
    assert!(
        svg.starts_with("<svg") && svg.contains("planar-mirror: scale") && !svg.contains("NaN")
    );
    let json = Command::new(env!("CARGO_BIN_EXE_nephroid"))
        .args(["stability", "mirror-wall", "--json"])
        .output()
        .unwrap();
    let json: serde_json::Value = serde_json::from_slice(&json.stdout).unwrap();
    assert_eq!(json["schema"], "nephroid-stability/1");
    assert!(
        json["rows"]
            .as_array()
            .unwrap()
            .iter()
            .all(|r| r["stable"] == true)
    );
    let unknown = Command::new(env!("CARGO_BIN_EXE_nephroid"))
        .args(["stability", "saucer"])
        .output()
        .unwrap();
    assert_eq!(unknown.status.code(), Some(2));
}
