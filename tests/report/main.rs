//! What `verify` and `gate` write for people and for CI: the page in a browser, JSON against its schema, JUnit XML.

mod browser;
mod formats;
mod schema;
mod support;
