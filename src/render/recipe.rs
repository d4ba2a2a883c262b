//! The frame from top to bottom: the only place where the order of the passes stands.
//!
//! A new pass takes a line here, its Rust file in `render/passes`, and its WGSL file in `shaders/`. The line says what it
//! runs over; planning, binding, recording, labels and timings follow from it.

/// Hands the lines of the recipe to the macro `$each`.
macro_rules! recipe {
    ($each:ident) => {
        $each! {
            /// Clears the targets and draws the meshes.
            Mesh: mesh = MeshPass, "mesh.wgsl", over Picture;
            /// The farthest depth of each subtile after the meshes.
            Hiz: hiz = HizPass, "hiz.wgsl", over Meshes;
            /// Finds the subtiles that a component touches.
            Cone: cone = ConePass, "cone.wgsl", over Parts;
            /// Marches one component within these subtiles.
            Trace: trace = TracePass, "trace.wgsl", over Rounds;
            /// Normals and materials of what is still seen when all components are there.
            Surface: surface = SurfacePass, "surface.wgsl", over Hits;
            /// Light, and the background.
            Shade: shade = ShadePass, "shade.wgsl", over Light;
            /// What was found or counted, as colors over the picture, where a view mode is asked for.
            DebugView: debug_view = DebugViewPass, "debug_view.wgsl", over Finished;
            /// Grid and outline of the selection, where the editor asks for them.
            Overlay: overlay = OverlayPass, "overlay.wgsl", over Finished;
        }
    };
}
pub(super) use recipe;

/// What of a frame a pass runs over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// The picture, at once.
    Picture,
    /// The same, only where there are meshes.
    Meshes,
    /// Each component that is seen, front to back, in parts that are short enough to be waited for.
    Parts,
    /// The same, each part again until no ray can be left.
    Rounds,
    /// The parts once more, when all components have been traced.
    Hits,
    /// The picture, in parts by how many lights there are.
    Light,
    /// The finished picture: recorded with the last dispatch of a frame.
    Finished,
}

impl Extent {
    /// Whether it is a part of a component that goes through this pass and the next one of the kind in turn.
    pub fn is_of_parts(self) -> bool {
        matches!(self, Self::Parts | Self::Rounds)
    }
}

/// Declares [`Pass`] by the recipe.
macro_rules! passes {
    ($($(#[$doc:meta])* $pass:ident: $field:ident = $type:ident, $file:literal, over $extent:ident;)*) => {
        /// A pass of the frame.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Pass {
            $($(#[$doc])* $pass,)*
        }

        impl Pass {
            /// All of them, in the order of the frame.
            pub const ALL: &[Self] = &[$(Self::$pass),*];

            /// The name of its passes on the device and of its row among the timings: that of its shader.
            pub fn label(self) -> &'static str {
                self.file().trim_end_matches(".wgsl")
            }

            /// Its shader.
            pub fn file(self) -> &'static str {
                match self {
                    $(Self::$pass => $file,)*
                }
            }

            /// What it runs over.
            pub fn extent(self) -> Extent {
                match self {
                    $(Self::$pass => Extent::$extent,)*
                }
            }
        }
    };
}
recipe!(passes);

#[cfg(test)]
mod tests {
    use super::*;
    use isolith_wgsl::{FILES, assemble_plain};

    /// The files of `shaders/` that are no passes of a frame.
    const NO_PASSES: &[&str] =
        &["driver.wgsl", "probe.wgsl", "probe_lookahead.wgsl", "probe_scene.wgsl", "probe_surface.wgsl"];

    #[test]
    fn every_pass_has_a_label_and_a_file_with_an_entry_point() {
        for (at, pass) in Pass::ALL.iter().enumerate() {
            assert_eq!(*pass as usize, at);
            assert!(!pass.label().is_empty() && !pass.label().contains('.'), "{pass:?}");
            let text = assemble_plain(pass.file()).unwrap_or_else(|error| panic!("{error}"));
            assert!(["@compute", "@fragment"].iter().any(|kind| text.contains(kind)), "{pass:?}");
        }
        let labels: std::collections::BTreeSet<_> = Pass::ALL.iter().map(|pass| pass.label()).collect();
        assert_eq!(labels.len(), Pass::ALL.len());
    }

    #[test]
    fn every_file_of_a_pass_is_in_the_recipe() {
        let is_planned = |file: &str| Pass::ALL.iter().any(|pass| pass.file() == file);
        let passes = FILES.iter().map(|(file, _)| *file).filter(|file| !file.contains('/'));
        let left: Vec<_> = passes.filter(|file| !is_planned(file)).collect();
        assert_eq!(left, NO_PASSES);
    }
}
