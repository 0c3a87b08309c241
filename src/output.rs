//! Files are written whole or not at all: to a temporary beside the target, then renamed.

use std::fs;
use std::path::Path;

use crate::error::Error;

/// Writes a file through a temporary beside it, so that an interrupted or failed write leaves nothing half-written.
///
/// # Errors
/// What `write` answers, or [`Error::Io`] if the file cannot be made or renamed.
pub fn write_whole(
    target: &Path,
    write: impl FnOnce(&Path) -> Result<(), Error>,
) -> Result<(), Error> {
    let name = target
        .file_name()
        .map(|n| n.to_string_lossy().into_owned())
        .unwrap_or_default();
    let shown = target.display().to_string();
    if name.is_empty() {
        let source =
            std::io::Error::new(std::io::ErrorKind::InvalidInput, "not the name of a file");
        return Err(Error::read(&shown, source));
    }
    let temporary = target.with_file_name(format!(".{name}.{}.part", std::process::id()));
    let result = write(&temporary).and_then(|()| {
        fs::rename(&temporary, target).map_err(|source| Error::read(&shown, source))
    });
    if result.is_err() {
        let _ = fs::remove_file(&temporary);
    }
    result
}

/// Writes text through [`write_whole`].
///
/// # Errors
/// [`Error::Io`] if the file cannot be written.
pub fn write_text(target: &Path, text: &str) -> Result<(), Error> {
    write_whole(target, |path| {
        fs::write(path, text).map_err(|source| Error::read(&target.display().to_string(), source))
    })
}
