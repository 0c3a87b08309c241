//! What can go wrong before anything is computed: bad usage, unreadable input. Each of these ends with exit code 2.

use miette::Diagnostic;
use thiserror::Error as ThisError;

/// Bad usage or unreadable input. A wrong renderer is a verdict, not an error.
#[derive(Debug, Diagnostic, ThisError)]
pub enum Error {
    /// The scene is neither in the catalogue nor a file.
    #[error("`{name}` is neither in the catalogue nor a TOML file")]
    #[diagnostic(help("the catalogue has: {known}"))]
    UnknownScene {
        /// What was given.
        name: String,
        /// The catalogue's names.
        known: String,
    },
    /// A name that is not one of a known list.
    #[error("`{found}` is not a known {what}")]
    #[diagnostic(help("allowed: {allowed}"))]
    UnknownName {
        /// What kind of name: `integrator`.
        what: &'static str,
        /// What was given.
        found: String,
        /// What is allowed.
        allowed: String,
    },
    /// A file could not be read or written.
    #[error("{file}: {source}")]
    Io {
        /// The file.
        file: String,
        /// The system's answer.
        source: std::io::Error,
    },
    /// TOML that does not have the expected keys and types.
    #[error("{file}: line {line}, column {column}: {message}")]
    #[diagnostic(help("{help}"))]
    Toml {
        /// The file.
        file: String,
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// The parser's message, which names the key.
        message: String,
        /// The line itself.
        help: String,
    },
    /// A parameter out of range.
    #[error("{file}: `{key}` is {found}")]
    #[diagnostic(help("allowed: {allowed}"))]
    Parameter {
        /// The file, or the command line option's owner.
        file: String,
        /// The key.
        key: String,
        /// What was found.
        found: String,
        /// What is allowed.
        allowed: String,
    },
    /// A file that was read, but whose contents cannot be used.
    #[error("{file}: {message}")]
    #[diagnostic(help("{help}"))]
    Content {
        /// The file.
        file: String,
        /// What is wrong, with the place.
        message: String,
        /// What is allowed.
        help: String,
    },
}

impl Error {
    /// A file that could not be read or written.
    pub fn read(file: &str, source: std::io::Error) -> Self {
        Error::Io {
            file: file.to_owned(),
            source,
        }
    }

    /// Turns a TOML error into file, line and column; `allowed` says what the line's key may be, where that is known.
    pub fn toml(
        file: &str,
        text: &str,
        error: &toml::de::Error,
        allowed: impl FnOnce(&str) -> Option<&'static str>,
    ) -> Self {
        let start = error.span().map_or(0, |s| s.start).min(text.len());
        let before = text.get(..start).unwrap_or_default();
        let line = before.matches('\n').count() + 1;
        let column = before
            .rsplit('\n')
            .next()
            .unwrap_or_default()
            .chars()
            .count()
            + 1;
        let shown = text.lines().nth(line - 1).unwrap_or_default();
        Error::Toml {
            file: file.to_owned(),
            line,
            column,
            message: error.message().to_owned(),
            help: match allowed(shown) {
                Some(allowed) => format!("allowed: {allowed}"),
                None => format!("the line reads: {shown}"),
            },
        }
    }
}
