//! The meshes of a scene: each is loaded once, and again when its files change.

use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::limits::MAX_TEXTURE_BYTES;
use super::load::parse_within;
use super::model_pose::ModelPose;
use super::resolve::{MeshFileStamp, ModelFileTable, Reader, inside, read_file};
use super::texture::SharedTextures;
use super::{MeshError, TriangleMesh};

/// A mesh, or the error why it could not be loaded.
pub type MeshResult = Result<Arc<TriangleMesh>, Arc<MeshError>>;

/// The meshes that a scene names, by their paths relative to the scene's folder and their poses. The library keeps failures too, so
/// that a broken file is read once, not once per frame.
#[derive(Clone, Debug, Default)]
pub struct MeshLibrary {
    folder: Option<PathBuf>,
    /// Files that go before those of the folder.
    packed: Arc<ModelFileTable>,
    loaded: HashMap<ModelPose, Loaded>,
    revision: u64,
}

#[derive(Clone, Debug)]
struct Loaded {
    result: MeshResult,
    /// The stamps of the source files.
    files: Vec<MeshFileStamp>,
}

/// The source of a mesh: its path, its pose and the stamps of its files. Enough to read the mesh again on another thread.
#[derive(Clone, Debug)]
pub struct MeshSource {
    folder: Option<PathBuf>,
    packed: Arc<ModelFileTable>,
    pose: ModelPose,
    files: Vec<MeshFileStamp>,
    /// Bytes available for its textures.
    texture_budget: u64,
    /// The same file in another pose, with the stamps of its files: it shares its textures.
    other: Option<(Arc<TriangleMesh>, Vec<MeshFileStamp>)>,
}

/// The result of reading a mesh again.
#[derive(Debug)]
pub struct Reread {
    source: MeshSource,
    result: MeshResult,
}

/// The effect of a mesh that was read again.
#[derive(Clone, Debug)]
pub enum ReloadOutcome {
    /// The new mesh replaces the old one.
    Fresh(Arc<TriangleMesh>),
    /// The new one cannot be used, and the old one stays.
    Kept(Arc<MeshError>),
    /// Neither the old nor the new one can be used.
    Broken(Arc<MeshError>),
    /// The result is obsolete: the library has moved to another folder.
    Unwanted,
}

impl MeshLibrary {
    /// A library for scenes in `folder`. Without a folder (a scene that was never saved) it finds nothing.
    pub fn new(folder: Option<PathBuf>) -> Self {
        Self { folder, ..Self::default() }
    }

    /// The folder that paths are relative to.
    pub fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// Changes the folder; forgets everything if it differs from the old one.
    pub fn set_folder(&mut self, folder: Option<PathBuf>) {
        if self.folder != folder {
            *self = Self { revision: self.revision + 1, packed: self.packed.clone(), ..Self::new(folder) };
        }
    }

    /// The same with files that go before those of the folder.
    pub fn with_packed(mut self, packed: Arc<ModelFileTable>) -> Self {
        self.packed = packed;
        self
    }

    /// Changes the files that go before those of the folder; forgets everything if they differ from the old ones.
    pub fn set_packed(&mut self, packed: &Arc<ModelFileTable>) {
        if !Arc::ptr_eq(&self.packed, packed) {
            if self.packed != *packed {
                *self = Self { revision: self.revision + 1, ..Self::new(self.folder.take()) };
            }
            self.packed = packed.clone();
        }
    }

    /// A number that changes whenever a mesh is loaded, replaced or forgotten.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// The mesh in this file and pose, loaded on the first request. The path must stay inside the folder; the error
    /// names it as the scene does.
    pub fn get(&mut self, pose: impl Into<ModelPose>) -> MeshResult {
        let pose = pose.into();
        if let Some(known) = self.loaded.get(&pose) {
            return known.result.clone();
        }
        let Reread { source, result } = self.source(pose.clone(), Vec::new()).read();
        self.loaded.insert(pose, Loaded { result: result.clone(), files: source.files });
        self.revision += 1;
        result
    }

    /// The mesh in this file and pose, if it was requested before.
    pub fn known(&self, pose: impl Into<ModelPose>) -> Option<&MeshResult> {
        self.loaded.get(&pose.into()).map(|loaded| &loaded.result)
    }

    /// The mesh in this file and pose; while it is not loaded yet, that of the same file in the pose of the nearest
    /// time.
    pub fn nearest(&self, pose: &ModelPose) -> Option<&MeshResult> {
        let time = |pose: &ModelPose| pose.clip.as_ref().map_or(0.0, |clip| clip.time);
        let off = |other: &ModelPose| (time(other) - time(pose)).abs();
        let others = self.loaded.iter().filter(|(other, _)| other.path == pose.path);
        let nearest = || others.min_by(|(a, _), (b, _)| off(a).total_cmp(&off(b))).map(|(_, loaded)| &loaded.result);
        self.known(pose).or_else(nearest)
    }

    /// Forgets the poses of clips that are not among these; rest poses stay.
    pub fn keep_poses<'a>(&mut self, used: impl Iterator<Item = &'a ModelPose>) {
        let used: HashSet<&ModelPose> = used.collect();
        self.loaded.retain(|pose, _| pose.clip.is_none() || used.contains(pose));
    }

    /// Takes over the meshes that a copy of this library has read since; does nothing if this one has moved to another
    /// folder. So another thread can read meshes, each within the texture budget that the others leave it.
    pub fn take_new(&mut self, other: Self) {
        if self.folder != other.folder || self.packed != other.packed {
            return;
        }
        for (pose, loaded) in other.loaded {
            if let Entry::Vacant(place) = self.loaded.entry(pose) {
                place.insert(loaded);
                self.revision += 1;
            }
        }
    }

    /// Records that this mesh cannot be loaded, and why, until it is read again.
    pub fn refuse(&mut self, pose: &ModelPose, reason: &str) {
        let files = self.folder.iter().map(|folder| MeshFileStamp::of(&folder.join(&pose.path))).collect();
        let result = Err(Arc::new(MeshError::new(&pose.path, "", reason)));
        self.loaded.insert(pose.clone(), Loaded { result, files });
        self.revision += 1;
    }

    /// The sources of all requested meshes.
    pub fn sources(&self) -> Vec<MeshSource> {
        let sources = self.loaded.iter().map(|(pose, loaded)| self.source(pose.clone(), loaded.files.clone()));
        sources.collect()
    }

    fn source(&self, pose: ModelPose, files: Vec<MeshFileStamp>) -> MeshSource {
        let others = || self.loaded.iter().filter(|(other, _)| **other != pose);
        let meshes =
            || others().filter_map(|(other, loaded)| Some((other, loaded.result.as_ref().ok()?, &loaded.files)));
        let textures: HashMap<_, _> = meshes()
            .filter(|(other, ..)| other.path != pose.path)
            .flat_map(|(_, mesh, _)| &mesh.textures)
            .map(|texture| (Arc::as_ptr(texture), texture.rgba.len() as u64))
            .collect();
        let texture_budget = MAX_TEXTURE_BYTES.saturating_sub(textures.values().sum());
        let other = meshes().find(|(other, ..)| other.path == pose.path);
        let other = other.map(|(_, mesh, files)| (mesh.clone(), files.clone()));
        MeshSource { folder: self.folder.clone(), packed: self.packed.clone(), pose, files, texture_budget, other }
    }

    /// Replaces a mesh by a newly read one, unless the new one is broken and the old one is not.
    pub fn replace(&mut self, fresh: Reread) -> ReloadOutcome {
        let Reread { source, result } = fresh;
        let is_same_place = self.folder == source.folder && self.packed == source.packed;
        let Some(loaded) = self.loaded.get_mut(&source.pose).filter(|_| is_same_place) else {
            return ReloadOutcome::Unwanted;
        };
        self.revision += 1;
        // Recorded for a broken file, too, so that it is not read again until it changes again.
        loaded.files = source.files;
        match (&loaded.result, &result) {
            (Ok(_), Err(error)) => ReloadOutcome::Kept(error.clone()),
            (Err(_), Err(error)) => {
                let error = error.clone();
                loaded.result = result;
                ReloadOutcome::Broken(error)
            }
            (_, Ok(mesh)) => {
                let mesh = mesh.clone();
                loaded.result = result;
                ReloadOutcome::Fresh(mesh)
            }
        }
    }
}

impl MeshSource {
    /// The path as the scene names it.
    pub fn path(&self) -> &str {
        &self.pose.path
    }

    /// The stamps of the files as they are now; equal to the recorded ones if nothing has changed.
    pub(super) fn look(&self) -> Vec<MeshFileStamp> {
        self.files.iter().map(MeshFileStamp::again).collect()
    }

    /// The stamps of the files at the time of reading.
    pub(super) fn files(&self) -> &[MeshFileStamp] {
        &self.files
    }

    /// Reads the mesh, with the files that it names.
    pub fn read(mut self) -> Reread {
        let mut files = Vec::new();
        let result = self.read_into(&mut files);
        self.files = files;
        Reread { source: self, result: result.map(Arc::new).map_err(Arc::new) }
    }

    fn read_into(&self, files: &mut Vec<MeshFileStamp>) -> Result<TriangleMesh, MeshError> {
        let path = &self.pose.path;
        let refuse = |reason: String| MeshError::new(path, "", &reason);
        let mut budget = self.texture_budget;
        if let Some(bytes) = self.packed.get(path) {
            let reader = Reader::of_table(&self.packed, path);
            let shared = self.other.as_ref().map_or_else(SharedTextures::new, |(mesh, _)| mesh.shared_textures());
            return parse_within(bytes, Path::new(path), &reader, &mut budget, (self.pose.clip.as_ref(), shared));
        }
        let Some(folder) = &self.folder else {
            return Err(refuse("the scene has no folder to look in until it is saved".into()));
        };
        // Stamped before reading, so that a change during the read is noticed later.
        files.push(MeshFileStamp::of(&folder.join(path)));
        let file = inside(folder, path).map_err(refuse)?;
        let bytes = read_file(&file).map_err(refuse)?;
        // Files that the glTF names must lie in its folder or below, as for any glTF.
        let reader = Reader::new(file.parent());
        let unchanged = self.other.as_ref().filter(|(_, files)| files.iter().all(|file| file.again() == *file));
        let shared = unchanged.map_or_else(SharedTextures::new, |(mesh, _)| mesh.shared_textures());
        let result = parse_within(&bytes, Path::new(path), &reader, &mut budget, (self.pose.clip.as_ref(), shared));
        // Files of shared textures are not read again, but watched as well.
        files.extend(unchanged.into_iter().flat_map(|(_, files)| files.clone()));
        files.extend(reader.into_files());
        result
    }
}

/// The files of a model, by their paths relative to the scene's folder: its own, and those that it names.
///
/// # Errors
/// The model cannot be read.
pub fn model_files(folder: &Path, path: &str) -> Result<ModelFileTable, MeshError> {
    let refuse = |reason: String| MeshError::new(path, "", &reason);
    let file = inside(folder, path).map_err(refuse)?;
    let bytes = read_file(&file).map_err(refuse)?;
    let mut files = ModelFileTable::new();
    if let Some(own) = file.parent() {
        let reader = Reader::keeping(own);
        let mut budget = MAX_TEXTURE_BYTES;
        parse_within(&bytes, Path::new(path), &reader, &mut budget, (None, SharedTextures::new()))?;
        let below = path.rsplit_once('/').map_or(String::new(), |(folder, _)| format!("{folder}/"));
        files.extend(reader.into_named().into_iter().map(|(name, bytes)| (format!("{below}{name}"), bytes)));
    }
    files.insert(path.to_owned(), bytes.into());
    Ok(files)
}

impl Reread {
    /// The source of the mesh.
    pub fn source(&self) -> &MeshSource {
        &self.source
    }
}
