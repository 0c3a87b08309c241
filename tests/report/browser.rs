//! The page in headless Chromium. Skipped, with a message, where there is no Chromium, unless `NEPHROID_CHROMIUM` is set: to the
//! program, or to `required`.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use super::support::{Written, gate, verify};

const VARIABLE: &str = "NEPHROID_CHROMIUM";
const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "chrome"];

fn is_there(program: &str) -> bool {
    Command::new(program)
        .arg("--version")
        .output()
        .is_ok_and(|o| o.status.success())
}

/// The program; `None` if there is none and none is demanded.
fn chromium() -> Option<String> {
    let demanded = std::env::var(VARIABLE).ok().filter(|v| !v.is_empty());
    let named = demanded.clone().filter(|v| v != "required");
    let found = match named {
        Some(program) => Some(program).filter(|p| is_there(p)),
        None => NAMES.map(str::to_owned).into_iter().find(|p| is_there(p)),
    };
    assert!(
        found.is_some() || demanded.is_none(),
        "{VARIABLE} is set, and there is no Chromium: install it, or unset {VARIABLE}"
    );
    if found.is_none() {
        eprintln!("skipped: no Chromium found ({VARIABLE}=required makes that an error)");
    }
    found
}

fn open(program: &str, written: &Written, profile: &str, options: &[&str]) -> Output {
    let profile: PathBuf = Path::new(env!("CARGO_TARGET_TMPDIR")).join(profile);
    let page = written.directory.join("report.html");
    let output = Command::new(program)
        .args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--no-first-run",
            "--disable-background-networking",
            "--enable-logging=stderr",
        ])
        .arg(format!("--user-data-dir={}", profile.display()))
        .args(options)
        .arg(format!("file://{}", page.display()))
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
    output
}

/// Lines that the page has written to the console, errors of the page among them.
fn console(output: &Output) -> Vec<String> {
    String::from_utf8_lossy(&output.stderr)
        .lines()
        .filter(|l| l.contains("CONSOLE"))
        .map(str::to_owned)
        .collect()
}

/// A copy of the page with a script that tells in an attribute how many images have been decoded and how wide the page is.
fn measured(written: &Written, name: &str) -> Written {
    let page = written.read("report.html").replace(
        "</body>",
        "<script>addEventListener('load',()=>{const i=[...document.images];const d=document.documentElement;\
         d.dataset.measured=[i.length,i.filter(x=>x.complete&&x.naturalWidth>0).length,d.scrollWidth,innerWidth].join(' ')})\
         </script></body>",
    );
    let directory = written.directory.with_file_name(name);
    std::fs::create_dir_all(&directory).unwrap();
    std::fs::write(directory.join("report.html"), page).unwrap();
    Written {
        directory,
        code: written.code,
    }
}

#[test]
fn the_page_opens_in_a_browser() {
    let Some(program) = chromium() else {
        return;
    };
    let cases = [
        (verify(), "verify", "Equivalent: everything that was judged"),
        (gate(), "gate", "Different: "),
    ];
    for (written, name, verdict) in cases {
        let profile = format!("chromium-{name}");
        let output = open(&program, written, &profile, &["--dump-dom"]);
        assert_eq!(console(&output), Vec::<String>::new());
        let dom = String::from_utf8_lossy(&output.stdout).into_owned();
        assert!(dom.contains(verdict), "no verdict");
        let copy = measured(written, &format!("{name}-measured"));
        for size in ["--window-size=1400,900", "--window-size=500,844"] {
            let output = open(&program, &copy, &profile, &["--dump-dom", size]);
            assert_eq!(console(&output), Vec::<String>::new());
            let dom = String::from_utf8_lossy(&output.stdout).into_owned();
            let text = dom.split("data-measured=\"").nth(1).expect("not loaded");
            let numbers: Vec<usize> = text
                .split('"')
                .next()
                .unwrap_or_default()
                .split(' ')
                .map(|n| n.parse().unwrap())
                .collect();
            let [images, decoded, page, window] = numbers[..] else {
                panic!("{numbers:?}");
            };
            assert_eq!(images, dom.matches("<img ").count());
            assert_eq!(images, decoded, "images that are not there");
            assert!(images >= 6, "{images} images");
            assert!(page <= window, "{page} px in a window of {window}");
        }
    }
}
