//! Runs a renderer: one image for each seed, in a clean directory, with a time limit.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::{Child, Command as Process, ExitStatus, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

use crate::error::Error;
use crate::foreign::channels::content;
use crate::verify::run::quoted;

/// What a command is made of, for messages.
const ALLOWED: &str = "a program with its arguments, with {seed} and {out} in them, and {scene} and {dir} where needed";
/// Lines of a failed program's messages that are shown.
const LAST_LINES: usize = 20;
/// How often a running program is looked at.
const POLL: Duration = Duration::from_millis(5);

/// A renderer as it is called.
#[derive(Clone, Debug, PartialEq)]
pub struct Command {
    text: String,
    /// Program and arguments; `None` if a shell reads the text.
    words: Option<Vec<String>>,
    scene: String,
    timeout: Duration,
}

impl Command {
    /// Reads a command. In it `{seed}` stands for a seed, `{out}` for the file to write, `{scene}` for the scene (its file, or
    /// its name in the catalogue), `{dir}` for the directory in which nephroid was started: the program itself starts in
    /// an empty one.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a command that is empty, lacks `{seed}` or `{out}`, or has an open quote.
    pub fn new(text: &str, scene: &str, timeout: Duration, shell: bool) -> Result<Self, Error> {
        let bad = |found: String| Error::Parameter {
            file: "command line".to_owned(),
            key: "--command".to_owned(),
            found,
            allowed: ALLOWED.to_owned(),
        };
        for needed in ["{seed}", "{out}"] {
            if !text.contains(needed) {
                return Err(bad(format!("without {needed}")));
            }
        }
        let words = if shell {
            None
        } else {
            let words = split(text).ok_or_else(|| bad("not closed: a quote is open".to_owned()))?;
            if words.is_empty() {
                return Err(bad("empty".to_owned()));
            }
            Some(words)
        };
        let file = Path::new(scene);
        let scene = match std::path::absolute(file) {
            Ok(whole) if file.is_file() => whole.display().to_string(),
            _ => scene.to_owned(),
        };
        Ok(Command {
            text: text.to_owned(),
            words,
            scene,
            timeout,
        })
    }

    /// The command as it was given.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Whether a shell reads it.
    pub fn is_shell(&self) -> bool {
        self.words.is_none()
    }

    /// The name of the program.
    pub fn program(&self) -> String {
        let first = match &self.words {
            Some(words) => words[0].clone(),
            None => self
                .text
                .split_whitespace()
                .next()
                .unwrap_or_default()
                .to_owned(),
        };
        let name = Path::new(&first).file_name();
        name.map_or(first.clone(), |n| n.to_string_lossy().into_owned())
    }

    /// Renders with a seed, and gives the file to `read` before it is removed.
    ///
    /// # Errors
    /// [`Error::Content`] if the program fails, takes too long or writes nothing, with what it said last; and what `read`
    /// answers.
    pub fn run<T>(
        &self,
        seed: u64,
        read: impl FnOnce(&Path) -> Result<T, Error>,
    ) -> Result<T, Error> {
        let directory = Temporary::new()?;
        let out = directory.path.join("out.exr");
        let log = directory.path.join("stderr.txt");
        let failed = |what: String| {
            let said = std::fs::read(&log).unwrap_or_default();
            let said = String::from_utf8_lossy(&said);
            let lines: Vec<&str> = said.lines().collect();
            let last = lines[lines.len().saturating_sub(LAST_LINES)..].join("\n");
            let last = if last.is_empty() {
                "it wrote nothing to stderr".to_owned()
            } else {
                format!("its stderr ends:\n{last}")
            };
            content(&self.text, format!("seed {seed}: {what}; {last}"), ALLOWED)
        };
        let log_file =
            File::create(&log).map_err(|e| Error::read(&log.display().to_string(), e))?;
        let mut process = self.process(seed, &out);
        process
            .current_dir(&directory.path)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::from(log_file));
        #[cfg(unix)]
        {
            use std::os::unix::process::CommandExt as _;
            process.process_group(0);
        }
        let mut child = process
            .spawn()
            .map_err(|e| failed(format!("could not be started: {e}")))?;
        let status = match wait(&mut child, self.timeout) {
            Ok(Some(status)) => status,
            Ok(None) => {
                return Err(failed(format!(
                    "not finished after {} s",
                    self.timeout.as_secs_f64()
                )));
            }
            Err(e) => return Err(failed(format!("lost: {e}"))),
        };
        if !status.success() {
            return Err(failed(format!("failed: {status}")));
        }
        if !out.is_file() {
            return Err(failed("it wrote no file to {out}".to_owned()));
        }
        read(&out)
    }

    fn process(&self, seed: u64, out: &Path) -> Process {
        let start = std::env::current_dir().unwrap_or_default();
        let values = [
            ("{seed}", seed.to_string()),
            ("{out}", out.display().to_string()),
            ("{scene}", self.scene.clone()),
            ("{dir}", start.display().to_string()),
        ];
        let replaced = |text: &str, value: &dyn Fn(&str) -> String| {
            values.iter().fold(text.to_owned(), |text, (name, v)| {
                text.replace(name, &value(v))
            })
        };
        match &self.words {
            Some(words) => {
                let mut words = words.iter().map(|w| replaced(w, &str::to_owned));
                let program = words.next().unwrap_or_default();
                // The program starts elsewhere: a path to it is one from here.
                let is_path = program.contains(std::path::MAIN_SEPARATOR);
                let program = if is_path {
                    start.join(&program)
                } else {
                    PathBuf::from(program)
                };
                let mut process = Process::new(program);
                process.args(words);
                process
            }
            None => {
                let mut process = Process::new("sh");
                process.arg("-c").arg(replaced(&self.text, &quoted));
                process
            }
        }
    }
}

/// Waits for a program; ends it, and what it has started, when its time is over: `None`.
fn wait(child: &mut Child, timeout: Duration) -> std::io::Result<Option<ExitStatus>> {
    let started = Instant::now();
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(Some(status));
        }
        if started.elapsed() >= timeout {
            #[cfg(unix)]
            let _ = Process::new("kill")
                .args(["-KILL", "--", &format!("-{}", child.id())])
                .stderr(Stdio::null())
                .status();
            let _ = child.kill();
            let _ = child.wait();
            return Ok(None);
        }
        std::thread::sleep(POLL);
    }
}

/// Splits a command into words as a POSIX shell does, without anything else that a shell does; `None` for an open quote.
pub fn split(text: &str) -> Option<Vec<String>> {
    let mut words = Vec::new();
    let mut word: Option<String> = None;
    let mut characters = text.chars();
    while let Some(c) = characters.next() {
        match c {
            c if c.is_whitespace() => words.extend(word.take()),
            '\'' => {
                let word = word.get_or_insert_default();
                loop {
                    match characters.next()? {
                        '\'' => break,
                        c => word.push(c),
                    }
                }
            }
            '"' => {
                let word = word.get_or_insert_default();
                loop {
                    match characters.next()? {
                        '"' => break,
                        '\\' => match characters.next()? {
                            c if "\"\\$`".contains(c) => word.push(c),
                            c => word.extend(['\\', c]),
                        },
                        c => word.push(c),
                    }
                }
            }
            '\\' => word.get_or_insert_default().push(characters.next()?),
            c => word.get_or_insert_default().push(c),
        }
    }
    words.extend(word);
    Some(words)
}

/// A directory that is removed with everything in it.
struct Temporary {
    path: PathBuf,
}

impl Temporary {
    fn new() -> Result<Self, Error> {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let mut path;
        loop {
            let count = COUNT.fetch_add(1, Ordering::Relaxed);
            path =
                std::env::temp_dir().join(format!("nephroid-gate-{}-{count}", std::process::id()));
            match std::fs::create_dir(&path) {
                Ok(()) => break,
                Err(e) if e.kind() == std::io::ErrorKind::AlreadyExists && count < 1 << 20 => {}
                Err(e) => return Err(Error::read(&path.display().to_string(), e)),
            }
        }
        Ok(Temporary { path })
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.path);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_those_of_a_shell() {
        let words = |t: &str| split(t).unwrap();
        assert_eq!(words("a  b\tc"), ["a", "b", "c"]);
        assert_eq!(
            words("a 'b c' \"d e\"f g\\ h ''"),
            ["a", "b c", "d ef", "g h", ""]
        );
        assert_eq!(words("\"a\\\"b\\n\" '$x' `ls`"), ["a\"b\\n", "$x", "`ls`"]);
        assert_eq!(words("a; rm -rf *"), ["a;", "rm", "-rf", "*"]);
        for open in ["'a", "\"a", "a\\", "\"a\\"] {
            assert_eq!(split(open), None, "{open}");
        }
    }
}
