//! The expression language: how it groups, what it computes, and where it says an error is.

use nephroid_analytic::schedule::Expression;

fn read(text: &str) -> Expression {
    text.parse().unwrap_or_else(|e| panic!("{text}: {e}"))
}

#[test]
fn how_it_groups() {
    for (text, shown) in [
        ("0.2*n^(-1/6)", "(0.2 * (n ^ (-1/6)))"),
        ("n^-1/6", "((n ^ (-1)) / 6)"),
        ("2^n^2", "(2 ^ (n ^ 2))"),
        ("-n^2", "(-(n ^ 2))"),
        ("1-n-2", "((1 - n) - 2)"),
        ("8/n/2*n", "(((8 / n) / 2) * n)"),
        ("1+n*n^2", "(1 + (n * (n ^ 2)))"),
        ("-n*2+1", "(((-n) * 2) + 1)"),
        (" max( n , 2,log (n)) ", "max(n, 2, log(n))"),
        ("1e-1*n+.5E0", "((0.1 * n) + 0.5)"),
        ("+n", "n"),
    ] {
        let shown_again = read(shown).to_string();
        assert_eq!(read(text).to_string(), shown, "{text}");
        assert_eq!(shown_again, shown);
    }
}

#[test]
fn what_it_computes() {
    let n = 7.0;
    for (text, expected) in [
        ("n^-1/6", 1.0 / 42.0),
        ("2^3^2*n/n", 512.0),
        ("-2^2+n-n", -4.0),
        ("sqrt(n)*sqrt(n)", n),
        ("log(e^n)", n),
        ("ln(exp(n))", n),
        ("sin(pi*n/14)+cos(pi*n/7)", 0.0),
        ("max(n, 3)-min(n, 3, 9)", 4.0),
        ("geometric(0.5, 0.5)", 1.0 / 128.0),
        ("at_powers(7, 1, 2)+at_powers(2, 10, 20)", 21.0),
    ] {
        let found = read(text).at(7);
        assert!(f64::abs(found - expected) < 1e-14, "{text} {found}");
    }
    // The recursion r²ₙ₊₁ = r²ₙ (n + a)/(n + 1), step by step.
    for a in [0.1, 0.5, 2.0 / 3.0, 0.99] {
        let schedule = read(&format!("ppm(0.2, {a})"));
        let mut square = 0.04;
        for n in 1..5000_u64 {
            let r = schedule.at(n);
            assert!(f64::abs(r * r / square - 1.0) < 3e-13, "{a} {n} {r}");
            let n = n as f64;
            square *= (n + a) / (n + 1.0);
        }
    }
    assert_eq!(read("at_powers(2, 1, 5)").between(8.0), 5.0);
    // What is no number stays none.
    assert!(read("max(log(0-n), 1)").at(3).is_nan());
    assert!(read("min(1, log(0-n))").at(3).is_nan());
}

#[test]
fn where_an_error_is() {
    for (text, column, found, expected) in [
        ("", 1, "the end", "a number, n, a function"),
        ("   ", 4, "the end", "a number"),
        ("0.2*", 5, "the end", "a number"),
        ("0.2*)", 5, "`)`", "a number"),
        ("2n", 2, "`n`", "an operator"),
        ("n^(-1/6", 8, "the end", "`)`"),
        ("n)", 2, "`)`", "an operator"),
        ("0.2*m^2", 5, "`m`", "one of max"),
        ("max(n)", 6, "`)`", "2 to 16"),
        ("sqrt(n, 2)", 7, "`,`", "sqrt(a)"),
        ("sqrt n", 6, "`n`", "`(` after `sqrt`"),
        ("1 + ppm(0.1, 2)", 14, "2", "0 < A < 1"),
        ("ppm(0-1, 0.5)", 5, "-1", "R1 > 0"),
        ("ppm(0.1, n)", 10, "an expression in n", "constant"),
        ("geometric(0.3, 1.01)", 16, "1.01", "0 < G"),
        ("at_powers(1.5, 1, n)", 11, "1.5", "whole number"),
        ("n $ 2", 3, "`$`", "+ - * /"),
        ("n·2", 2, "`·`", "+ - * /"),
        ("αβ+1", 1, "`α`", "a number"),
        ("1.2.3", 4, "`.3`", "an operator"),
        (".", 1, "`.`", "decimal"),
        ("1e999", 1, "`1e999`", "finite"),
        ("n,2", 2, "`,`", "an operator"),
    ] {
        let error = text.parse::<Expression>().unwrap_err();
        assert_eq!(error.column, column, "{text}: {error}");
        assert!(error.found.contains(found), "{text}: {error}");
        assert!(error.expected.contains(expected), "{text}: {error}");
    }
}

#[test]
fn long_and_deep_texts_are_refused() {
    for text in [
        "(".repeat(100_000),
        "-".repeat(100_000),
        "n^".repeat(100_000),
        "n+".repeat(100_000),
        "sqrt(".repeat(100_000),
        "1".repeat(100_000),
        format!("{}n{}", "(".repeat(150), ")".repeat(150)),
    ] {
        assert!(text.parse::<Expression>().is_err());
    }
    // At the limit the tree is used without harm.
    let long = format!("n{}", "+n".repeat(499));
    assert_eq!(read(&long).at(2), 1000.0);
    assert!(read(&long).behaviour().is_ok());
    let deep = format!("{}n{}", "sqrt(".repeat(90), ")".repeat(90));
    assert!(read(&deep).at(2) > 0.999);
}
