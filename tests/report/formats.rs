//! JUnit XML and Markdown, the page's own promises, and the same bytes every time.

use std::collections::HashSet;

use super::support::{gate, verify, verify_into};

/// The values of an attribute, in their order.
fn attributes<'a>(text: &'a str, start: &str) -> Vec<&'a str> {
    text.split(start)
        .skip(1)
        .filter_map(|rest| rest.split('"').next())
        .collect()
}

#[test]
fn junit_has_unique_ids_and_properties() {
    for (written, name) in [(verify(), "verify.xml"), (gate(), "gate.xml")] {
        let xml = written.read(name);
        let mut reader = quick_xml::Reader::from_str(&xml);
        while reader.read_event().unwrap() != quick_xml::events::Event::Eof {}
        let cases = xml.matches("<testcase ").count();
        let ids = attributes(&xml, " id=\"");
        assert_eq!(ids.len(), cases, "{xml}");
        assert_eq!(ids.iter().collect::<HashSet<_>>().len(), cases, "{ids:?}");
        for key in ["level", "seed", "margin", "command"] {
            let found = xml.matches(&format!("<property name=\"{key}\"")).count();
            assert_eq!(found, cases, "{key}: {xml}");
        }
        assert!(xml.contains("<property name=\"power\""), "{xml}");
    }
    let xml = verify().read("verify.xml");
    assert!(xml.contains(" id=\"floor/pt/LDE/image\""), "{xml}");
}

#[test]
fn exit_codes_and_verdicts_agree() {
    assert_eq!((verify().code, gate().code), (0, 1));
    let of = |page: &str| {
        let rest = page
            .split("id=\"verdict\" class=\"verdict ")
            .nth(1)
            .unwrap();
        rest.split('"').next().unwrap().to_owned()
    };
    assert_eq!(of(&verify().read("report.html")), "equivalent");
    let page = gate().read("report.html");
    assert_eq!(of(&page), "different");
    assert!(page.contains("class missing"), "no diagnosis");
    assert!(gate().read("gate.md").contains("class missing"));
    assert!(verify().read("verify.md").contains("| floor | pt | LDE |"));
}

#[test]
fn the_page_needs_nothing_else_and_is_the_same_every_time() {
    for written in [verify(), gate()] {
        let page = written.read("report.html");
        for start in [" src=\"", " href=\""] {
            for value in attributes(&page, start) {
                let is_own = value.starts_with('#') || value.starts_with("data:");
                assert!(is_own, "{value}");
            }
        }
        assert!(
            !page.contains("<script") && !page.contains("http"),
            "not self-contained"
        );
        assert!(!page.contains(env!("CARGO_TARGET_TMPDIR")), "a path");
        // Each link has its target, and each id is one of a kind.
        let ids = attributes(&page, " id=\"");
        assert_eq!(ids.iter().collect::<HashSet<_>>().len(), ids.len());
        for link in attributes(&page, " href=\"#") {
            assert!(ids.contains(&link), "{link}");
        }
    }
    let again = verify_into("report-again").read("report.html");
    assert!(again == verify().read("report.html"), "other bytes");
}
