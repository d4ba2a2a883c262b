//! From a scene to text, always the same for the same scene, one value per line.

use std::io;
use std::path::Path;

use serde::Serialize;
use serde_json::ser::Formatter;
use serde_json::{Map, Value};

use super::FileError;
use super::animation;
use super::format::{NodeFile, SceneFile, VERSION};
use crate::{Bookmark, Material, Scene, check};

/// The text of a scene. Floating-point numbers use the shortest form that reads back as the same number, so reading and
/// writing again gives the same bytes.
///
/// Fails if a value is not finite or out of its limits, so that every written file can be read.
pub fn to_json(scene: &Scene) -> Result<String, FileError> {
    let file = Path::new("scene");
    check::environment(&scene.environment).map_err(|f| FileError::from_fault(file, "environment", f))?;
    check::display(&scene.display).map_err(|f| FileError::from_fault(file, "display", f))?;
    for (i, material) in scene.materials().iter().enumerate() {
        check::material(material).map_err(|f| FileError::from_fault(file, &format!("materials[{i}]"), f))?;
    }
    for (i, node) in scene.nodes().iter().enumerate() {
        check::node(node)
            .map_err(|f| FileError::from_fault(file, &format!("nodes[{i}]"), f).of_node(&node.name, node.id))?;
    }
    animation::check(scene, file)?;
    for (i, bookmark) in scene.bookmarks.iter().enumerate() {
        let checked = bookmark.as_ref().map_or(Ok(()), Bookmark::check);
        checked.map_err(|reason| FileError::new(file, reason).at(format!("bookmarks[{i}]")))?;
    }
    let failed = |e: serde_json::Error| FileError::new(file, e.to_string());
    let table = SceneFile {
        schema: None,
        isolith: VERSION,
        environment: scene.environment.clone(),
        display: scene.display,
        materials: scene.materials().iter().map(|m| short(m)).collect::<Result<_, _>>().map_err(failed)?,
        next_id: scene.next_id(),
        nodes: scene.nodes().iter().map(|n| NodeFile::from(&check::settled((**n).clone()))).collect(),
        timeline: scene.animation.timeline,
        tracks: animation::written(&scene.animation),
        bookmarks: bookmarks(scene),
        packed: scene.packed.clone(),
    };
    let mut out = Vec::new();
    let written = table.serialize(&mut serde_json::Serializer::with_formatter(&mut out, OneValuePerLine::default()));
    written.map_err(failed)?;
    out.push(b'\n');
    String::from_utf8(out).map_err(|e| FileError::new(file, e.to_string()))
}

/// The views up to the last that is kept.
fn bookmarks(scene: &Scene) -> Vec<Option<Bookmark>> {
    let count = scene.bookmarks.iter().rposition(Option::is_some).map_or(0, |last| last + 1);
    scene.bookmarks[..count].to_vec()
}

/// A material as files hold it: without the values that a new one has.
fn short(material: &Material) -> Result<Map<String, Value>, serde_json::Error> {
    let fields = |material: &Material| match serde_json::to_value(material)? {
        Value::Object(fields) => Ok::<_, serde_json::Error>(fields),
        _ => Ok(Map::new()),
    };
    let (mut own, new) = (fields(material)?, fields(&Material::default())?);
    own.retain(|key, value| ["id", "name"].contains(&key.as_str()) || new.get(key) != Some(value));
    Ok(own)
}

/// Puts every value of an object on its own line, and every object and list within a list too. A list of numbers stays
/// on one line: a point or a color is one value.
#[derive(Default)]
struct OneValuePerLine {
    indent: usize,
    /// For each open list: whether it is itself an entry of a list.
    nested: Vec<bool>,
    /// Whether the next closing bracket ends a value of several lines.
    has_lines: bool,
    /// Whether the next value is an entry of a list.
    is_entry: bool,
}

impl OneValuePerLine {
    fn new_line<W: ?Sized + io::Write>(&self, writer: &mut W) -> io::Result<()> {
        writer.write_all(b"\n")?;
        (0..self.indent).try_for_each(|_| writer.write_all(b"  "))
    }

    fn open<W: ?Sized + io::Write>(&mut self, writer: &mut W, bracket: &[u8]) -> io::Result<()> {
        self.indent += 1;
        self.has_lines = false;
        self.is_entry = false;
        writer.write_all(bracket)
    }

    fn close<W: ?Sized + io::Write>(&mut self, writer: &mut W, bracket: &[u8]) -> io::Result<()> {
        self.indent -= 1;
        if self.has_lines {
            self.new_line(writer)?;
        }
        writer.write_all(bracket)
    }
}

impl Formatter for OneValuePerLine {
    fn begin_array<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.nested.push(self.is_entry);
        if self.is_entry {
            self.new_line(writer)?;
        }
        self.open(writer, b"[")
    }

    fn end_array<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.close(writer, b"]")?;
        if self.nested.pop() == Some(true) {
            self.has_lines = true;
        }
        Ok(())
    }

    fn begin_array_value<W: ?Sized + io::Write>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        self.is_entry = true;
        match (first, self.has_lines) {
            (true, _) => Ok(()),
            (false, true) => writer.write_all(b","),
            (false, false) => writer.write_all(b", "),
        }
    }

    fn begin_object<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        if self.is_entry {
            self.new_line(writer)?;
        }
        self.open(writer, b"{")
    }

    fn end_object<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.close(writer, b"}")?;
        self.has_lines = true;
        Ok(())
    }

    fn begin_object_key<W: ?Sized + io::Write>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        if !first {
            writer.write_all(b",")?;
        }
        self.new_line(writer)
    }

    fn begin_object_value<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.is_entry = false;
        writer.write_all(b": ")
    }

    fn end_object_value<W: ?Sized + io::Write>(&mut self, _: &mut W) -> io::Result<()> {
        self.has_lines = true;
        Ok(())
    }
}
