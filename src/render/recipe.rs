//! The recipe of the frame, from top to bottom: the only place that defines the order of the passes.
//!
//! A new pass takes a line here, its Rust file in `render/passes`, and its WGSL file in `shaders/`. The line names the
//! extent that the pass runs over; planning, binding, recording, labels and timings follow from it.

/// Passes the lines of the recipe to the macro `$each`.
macro_rules! recipe {
    ($each:ident) => {
        $each! {
            /// Clears the targets and draws the meshes.
            Mesh: mesh = MeshPass, "mesh.wgsl", over Picture;
            /// The farthest depth of each subtile after the meshes.
            Hiz: hiz = HizPass, "hiz.wgsl", over Meshes;
            /// Finds the subtiles that a component touches.
            Cone: cone = ConePass, "cone.wgsl", over Parts;
            /// Which rays of a component with a resolution of its own are marched, and what the pixels between show.
            Resolution: resolution = ResolutionPass, "resolution.wgsl", over Thinned;
            /// Marches one component within these subtiles.
            Trace: trace = TracePass, "trace.wgsl", over Rounds;
            /// Normals and materials of the pixels that remain visible after all components are traced.
            Surface: surface = SurfacePass, "surface.wgsl", over Hits;
            /// Which lights may reach the surfaces of each tile.
            Lights: lights = LightsPass, "lights.wgsl", over Lit;
            /// Soft shadows and occlusion, by cones against the whole scene.
            Shadow: shadow = ShadowPass, "shadow.wgsl", over Shaded;
            /// Lighting and background.
            Shade: shade = ShadePass, "shade.wgsl", over Light;
            /// The mean of accumulated samples as a picture.
            Display: display = DisplayPass, "display.wgsl", over Finished;
            /// Hits or counts as colors over the picture, for view modes that ask for it.
            DebugView: debug_view = DebugViewPass, "debug_view.wgsl", over Finished;
            /// Grid and selection outline, if the editor asks for them.
            Overlay: overlay = OverlayPass, "overlay.wgsl", over Finished;
        }
    };
}
pub(super) use recipe;

/// The extent of a frame that a pass runs over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// The picture, in one dispatch.
    Picture,
    /// The picture, if the scene has meshes.
    Meshes,
    /// Each visible component, front to back, in parts that are short enough for one dispatch.
    Parts,
    /// Those of them that have rays for some pixels only, before the first ray and before the last ones.
    Thinned,
    /// The same parts, each relaunched until no ray can be left.
    Rounds,
    /// The parts again, after all components have been traced.
    Hits,
    /// The picture, in one dispatch, if the scene has many lights.
    Lit,
    /// The picture, in parts, each in two dispatches, if the scene has shadows or occlusion. The second one is
    /// repeated until no cone is left.
    Shaded,
    /// The picture, in parts whose size depends on the number of lights.
    Light,
    /// The finished picture: recorded with the last dispatch of a frame.
    Finished,
}

impl Extent {
    /// Whether the pass runs over parts, each of which goes through this pass and the next pass of this kind in turn.
    pub fn is_of_parts(self) -> bool {
        matches!(self, Self::Parts | Self::Thinned | Self::Rounds)
    }
}

/// Declares [`Pass`] from the recipe.
macro_rules! passes {
    ($($(#[$doc:meta])* $pass:ident: $field:ident = $type:ident, $file:literal, over $extent:ident;)*) => {
        /// A pass of the frame.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Pass {
            $($(#[$doc])* $pass,)*
        }

        impl Pass {
            /// All passes, in the order of the frame.
            pub const ALL: &[Self] = &[$(Self::$pass),*];

            /// Whether it computes light from hits that other passes have found.
            pub fn is_of_light(self) -> bool {
                matches!(self.extent(), Extent::Lit | Extent::Shaded | Extent::Light)
            }

            /// Its label on the device and in the timings: the name of its shader.
            pub fn label(self) -> &'static str {
                self.file().trim_end_matches(".wgsl")
            }

            /// Its shader.
            pub fn file(self) -> &'static str {
                match self {
                    $(Self::$pass => $file,)*
                }
            }

            /// The extent that it runs over.
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

    /// Files in `shaders/` that belong to no pass of a frame.
    const NO_PASSES: &[&str] = &[
        "driver.wgsl",
        "probe.wgsl",
        "probe_brdf.wgsl",
        "probe_copies.wgsl",
        "probe_lookahead.wgsl",
        "probe_mesh_rays.wgsl",
        "probe_scene.wgsl",
        "probe_surface.wgsl",
    ];

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
