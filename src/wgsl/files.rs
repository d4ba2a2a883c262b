//! The files of `shaders/`, and the resolution of their includes.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::path::Path;

use thiserror::Error;

use super::disk;
use super::params::params_file;

/// Every file of `shaders/`, by its path there.
pub const FILES: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/shaders.rs"));

/// The text of a file of `shaders/`: from the time of the build or, with `shaders-from-disk`, as it is now.
fn text_of(name: &str) -> Option<Cow<'static, str>> {
    let shipped = FILES.iter().find(|(file, _)| *file == name).map(|(_, text)| Cow::Borrowed(*text))?;
    if cfg!(feature = "shaders-from-disk") {
        return disk::read(Path::new(ROOT), name).map(Cow::Owned).or(Some(shipped));
    }
    Some(shipped)
}

/// The folder `shaders/` at the time of the build.
const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shaders");

/// Why a shader could not be assembled.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum ShaderError {
    /// An include names a missing file.
    #[error("{from}: includes {name}, which does not exist")]
    NoFile {
        /// The including file.
        from: String,
        /// The name in the include.
        name: String,
    },
}

/// The text of `entry` with all its includes, each file once, before its first user. Of generated files it may include
/// those of parameters only.
pub fn library(entry: &str) -> Result<String, ShaderError> {
    resolve(entry, &[], &|_| None)
}

/// Like [`library`], where `generated` returns the text of files that do not exist. The part between `#if` and `#end`
/// remains only if `features` has the word behind `#if`; a part between `#else` and `#end` only if not.
pub fn resolve(
    entry: &str,
    features: &[&str],
    generated: &dyn Fn(&str) -> Option<String>,
) -> Result<String, ShaderError> {
    let mut resolver = Resolver { features, generated, seen: BTreeSet::new(), out: String::new() };
    resolver.include(entry, entry)?;
    Ok(resolver.out)
}

struct Resolver<'a> {
    features: &'a [&'a str],
    generated: &'a dyn Fn(&str) -> Option<String>,
    seen: BTreeSet<String>,
    out: String,
}

impl Resolver<'_> {
    fn include(&mut self, name: &str, from: &str) -> Result<(), ShaderError> {
        if !self.seen.insert(name.to_owned()) {
            return Ok(());
        }
        let mut generated = (self.generated)(name).or_else(|| params_file(name));
        if let Some(text) = generated.as_mut().filter(|_| name.starts_with("generated/dual/")) {
            // The texts of several shapes may contain the dual function of the same function; write it once.
            let fresh = text.split("\n\n").filter(|part| self.seen.insert((*part).trim_end().to_owned()));
            *text = fresh.collect::<Vec<_>>().join("\n\n");
        }
        let text = match generated {
            Some(text) => Cow::Owned(text),
            None => {
                let missing = || ShaderError::NoFile { from: from.to_owned(), name: name.to_owned() };
                text_of(name).ok_or_else(missing)?
            }
        };
        let mut is_wanted = true;
        for line in text.lines() {
            match (line, line.strip_prefix("#if ")) {
                (_, Some(feature)) => is_wanted = self.features.contains(&feature),
                ("#else", _) => is_wanted = !is_wanted,
                ("#end", _) => is_wanted = true,
                _ if is_wanted => self.line(line, name)?,
                _ => {}
            }
        }
        Ok(())
    }

    fn line(&mut self, line: &str, name: &str) -> Result<(), ShaderError> {
        match line.strip_prefix("#include \"").and_then(|rest| rest.strip_suffix('"')) {
            Some(included) => self.include(included, name),
            None => {
                self.out.push_str(line);
                self.out.push('\n');
                Ok(())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_missing_is_named_with_what_includes_it() {
        assert!(library("sdf/sphere.wgsl").is_ok_and(|text| text.contains("fn sdf_sphere")));
        let error = library("no_such.wgsl").expect_err("there is no such file");
        assert!(error.to_string().contains("no_such.wgsl"), "{error}");
        let error = library("field/tape_surface.wgsl").expect_err("it needs what is generated");
        assert!(error.to_string().contains("generated/"), "{error}");
    }

    #[test]
    fn one_of_two_parts_remains() {
        let text = "before\n#if A\none\n#else\nother\n#end\nbehind\n";
        let with = |features: &[&str]| resolve("made.wgsl", features, &|_| Some(text.to_owned()));
        assert_eq!(with(&["A"]).as_deref(), Ok("before\none\nbehind\n"));
        assert_eq!(with(&["B"]).as_deref(), Ok("before\nother\nbehind\n"));
    }
}
