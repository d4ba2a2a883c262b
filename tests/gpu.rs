//! One graphics device for all tests, because opening each one takes time; and pictures of scenes.

use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock, Mutex, MutexGuard};

use isolith::field::{FlatScene, GBuffer};
use isolith::geometry::Camera;
use isolith::jobs::Task;
use isolith::mesh::TriangleMesh;
use isolith::render::{EvalStrategy, Gpu, Renderer};
use isolith::scene::{Scene, file};
use isolith::session::PreparedScene;

/// The device and its renderers.
pub struct Shared {
    pub gpu: Gpu,
    pub renderer: Renderer,
}

/// The shared device. Fails the test if no driver answers.
pub fn shared() -> MutexGuard<'static, Shared> {
    static SHARED: LazyLock<Mutex<Shared>> = LazyLock::new(|| {
        let gpu = Gpu::headless().unwrap_or_else(|error| {
            panic!("no graphics driver answers ({error}); on Debian and Ubuntu: apt-get install mesa-vulkan-drivers libvulkan1")
        });
        let renderer = Renderer::new(&gpu).unwrap_or_else(|error| panic!("{error}"));
        Mutex::new(Shared { gpu, renderer })
    });
    // A test that failed while it held the device does not fail the others.
    SHARED.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

/// A scene to draw.
pub struct BenchScene {
    pub name: String,
    pub flat: FlatScene,
    pub meshes: Vec<Option<Arc<TriangleMesh>>>,
    pub camera: Camera,
}

impl BenchScene {
    /// A scene without a file, in its default view, for a square picture.
    pub fn new(name: &str, scene: &Scene, folder: Option<PathBuf>) -> Self {
        Self::at(name, scene, 0.0, folder)
    }

    /// The same at a moment in seconds.
    pub fn at(name: &str, scene: &Scene, time: f64, folder: Option<PathBuf>) -> Self {
        let prepared = PreparedScene::of(scene, time, folder, &Task::new("Preparing"));
        let prepared = prepared.unwrap_or_else(|error| panic!("{name}: {error:?}"));
        let mut prepared = prepared.expect("nobody cancels");
        assert!(prepared.warnings_of_fields().is_empty(), "{name}: {:?}", prepared.warnings_of_fields());
        let flat = FlatScene::clone(&prepared.flat);
        let (meshes, missing) = flat.load_meshes(&mut prepared.library);
        assert!(missing.is_empty(), "{name}: {missing:?}");
        let camera = flat.default_camera(&meshes, 1.0);
        Self { name: name.into(), flat, meshes, camera }
    }

    /// Draws it on the shared device.
    pub fn render(&self, side: u32, strategy: EvalStrategy) -> GBuffer {
        self.render_on(&mut shared().renderer, side, strategy)
    }

    /// Draws it by this renderer. Who changes its settings holds it until they are as before.
    pub fn render_on(&self, renderer: &mut Renderer, side: u32, strategy: EvalStrategy) -> GBuffer {
        renderer.set_strategy(strategy);
        let picture = renderer.render(&self.flat, &self.meshes, &self.camera, [side, side], &mut |_| true);
        let (buffers, unfinished) = picture.unwrap_or_else(|error| panic!("{}: {error}", self.name));
        assert!(unfinished.is_empty(), "{}: {unfinished:?}", self.name);
        buffers
    }
}

/// Every scene of the folder `scenes`, in the order of their names.
pub fn scenes() -> impl Iterator<Item = BenchScene> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let entries = std::fs::read_dir(&folder).expect("the folder `scenes` can be read");
    let mut paths: Vec<_> = entries.map(|entry| entry.expect("an entry can be read").path()).collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "json"));
    paths.sort();
    assert!(!paths.is_empty(), "there is no scene in {}", folder.display());
    paths.into_iter().map(move |path| {
        let name = path.file_stem().expect("a file has a name").to_string_lossy().into_owned();
        let scene = file::load(&path).unwrap_or_else(|error| panic!("{error}"));
        BenchScene::new(&name, &scene, Some(folder.clone()))
    })
}
