//! Every shader is valid and used, and its structs have the memory layout of their Rust counterparts.

use std::mem::{offset_of, size_of};

use isolith::field::{FlatMaterial, FlatNode, FlatTexture, GpuLight, GpuPlacedTextures, TextureSet, flatten};
use isolith::gallery;
use isolith::render::uniforms::{DispatchParams, GpuComponent, GpuView};
use isolith::render::{DebugView, GpuHierarchyNode, Instance, Overlay, RayMesh, SceneLimits, ShadowSettings};
use isolith::scene::ShapeKind;
use isolith::wgsl::{
    Evaluator, FILES, OpSet, Options, SCENE_COPIES, ShapeSet, SkipMode, Structure, Veil, assemble, assemble_featured,
    assemble_with, fits_templates,
};
use naga::valid::{Capabilities, ValidationFlags, Validator};

/// The passes: the files outside of all folders.
fn passes() -> impl Iterator<Item = &'static str> {
    FILES.iter().map(|(name, _)| *name).filter(|name| !name.contains('/'))
}

/// The interpreter for every shape, and specialized pipelines for every structure of the shipped scenes.
fn evaluators() -> Vec<Evaluator> {
    let flats =
        gallery::all().into_iter().map(|(name, scene)| flatten(&scene, 0.0).unwrap_or_else(|e| panic!("{name}: {e}")));
    let mut structures: Vec<_> = flats
        .flat_map(|flat| flat.components.iter().filter_map(|c| Structure::of(&flat, c)).collect::<Vec<_>>())
        .collect();
    let everything = flatten(&gallery::random(16, 1), 0.0).expect("within the limits");
    let shapes = ShapeSet::of(ShapeKind::ALL.iter().copied().filter(|kind| fits_templates(*kind)));
    structures.extend(everything.components.iter().filter_map(|c| Structure::template(&everything, c, shapes)));
    structures.sort();
    structures.dedup();
    let alone = ShapeKind::ALL.iter().map(|kind| OpSet { shapes: [*kind].into(), ..OpSet::none() });
    let kinds = OpSet::all().modifiers;
    let modified = kinds.iter().map(|kind| OpSet { modifiers: [*kind].into(), stack: 2, ..OpSet::none() });
    let walked: Vec<_> = alone.chain(modified).chain([OpSet::all()]).collect();
    let interpreted = walked.iter().cloned().map(Evaluator::Interpreter);
    let tape = walked.iter().cloned().map(Evaluator::Tape);
    interpreted.chain(tape).chain(structures.into_iter().map(Evaluator::StraightLine)).collect()
}

/// Every file of a pass, with the interpreter for everything, then with a specialized pipeline.
fn sources() -> Vec<(&'static str, String)> {
    let everything = Evaluator::Interpreter(OpSet::all());
    let special =
        evaluators().into_iter().find(|e| matches!(e, Evaluator::StraightLine(_))).expect("scenes have structures");
    let tape = Evaluator::Tape(OpSet::all());
    let text =
        |pass, evaluator| assemble(pass, evaluator, Options::default()).unwrap_or_else(|error| panic!("{error}"));
    let all = [everything, tape, special];
    let shadowed = Options { shadowed: true, ..Options::default() };
    let shade = assemble_with("shade.wgsl", &all[0], shadowed, &[]).unwrap_or_else(|error| panic!("{error}"));
    let plain = passes().flat_map(|pass| all.each_ref().map(|evaluator| (pass, text(pass, evaluator))));
    let meshes = assemble_with("shadow.wgsl", &all[1], Options::default(), &["MESH_RAYS", "AMBIENT_RAYS"]);
    let meshes = meshes.unwrap_or_else(|error| panic!("{error}"));
    let among = [all[0].clone(), all[1].clone()].map(|evaluator| {
        let text = assemble_with("shadow.wgsl", &evaluator, Options::default(), &["MESH_RAYS", SCENE_COPIES]);
        ("shadow.wgsl", text.unwrap_or_else(|error| panic!("{error}")))
    });
    let with_copies = Options { copies: true, ..Options::default() };
    let of_copies = ["copy/cone.wgsl", "trace.wgsl", "surface.wgsl"].into_iter().flat_map(|pass| {
        let text = |evaluator| assemble(pass, evaluator, with_copies).unwrap_or_else(|error| panic!("{error}"));
        all.each_ref().map(|evaluator| (pass, text(evaluator)))
    });
    let veils = [(Veil::Plain, false), (Veil::Textured, false), (Veil::Plain, true), (Veil::Textured, true)];
    let veiled = veils.into_iter().flat_map(|(veil, copies)| {
        let options = Options { veil, copies, ..Options::default() };
        let text = |evaluator| assemble("trace.wgsl", evaluator, options).unwrap_or_else(|error| panic!("{error}"));
        [&all[0], &all[1]].map(|evaluator| ("trace.wgsl", text(evaluator)))
    });
    let lit = [&["VEILS"][..], &["VEILS", "SPARSE_SHARES"]].map(|features| {
        let text = assemble_with("shade.wgsl", &all[0], shadowed, features);
        ("shade.wgsl", text.unwrap_or_else(|error| panic!("{error}")))
    });
    let dimmed = assemble_with(
        "shadow.wgsl",
        &all[1],
        Options::default(),
        &["MESH_RAYS", SCENE_COPIES, "VEILS", "AMBIENT_RAYS"],
    );
    let dimmed = dimmed.unwrap_or_else(|error| panic!("{error}"));
    let shown = assemble_featured("shade.wgsl", &["COPIES"]).unwrap_or_else(|error| panic!("{error}"));
    plain
        .chain(of_copies)
        .chain(among)
        .chain(veiled)
        .chain(lit)
        .chain([
            ("shadow.wgsl", dimmed),
            ("shade.wgsl", shown),
            ("shade.wgsl", textured()),
            ("shade.wgsl", carried()),
            ("shade.wgsl", shade),
            ("shadow.wgsl", meshes),
        ])
        .collect()
}

/// The pass `shade` for scenes with textures.
fn textured() -> String {
    assemble_featured("shade.wgsl", &["TEXTURES"]).unwrap_or_else(|error| panic!("{error}"))
}

/// The same with looks of models, and with copies that carry them.
fn carried() -> String {
    let features = ["TEXTURES", "LOOKS", SCENE_COPIES, "COPIES"];
    assemble_featured("shade.wgsl", &features).unwrap_or_else(|error| panic!("{error}"))
}

/// The module of a source, or the error in it.
fn validate(source: &str) -> Result<naga::Module, String> {
    let module = naga::front::wgsl::parse_str(source).map_err(|error| error.emit_to_string(source))?;
    // WebGPU has `pack2x16float`; only OpenGL's old versions lack it.
    let capabilities = Capabilities::default() | Capabilities::SHADER_FLOAT16_IN_FLOAT32;
    let mut validator = Validator::new(ValidationFlags::all(), capabilities);
    validator.validate(&module).map_err(|error| error.emit_to_string(source))?;
    Ok(module)
}

#[test]
fn every_pass_is_valid_with_every_evaluator() {
    let choices = evaluators();
    let options = [Options::default(), Options { counting: true, skip_mode: SkipMode::Selects, ..Options::default() }];
    let mut count = 0;
    for pass in passes() {
        for evaluator in &choices {
            for options in options {
                let text = assemble(pass, evaluator, options).unwrap_or_else(|error| panic!("{error}"));
                // Passes without a field are the same for all evaluators.
                if !text.contains("fn field(") && !text.contains("fn surface(") && count > 0 {
                    continue;
                }
                if let Err(fault) = validate(&text) {
                    panic!("{pass} with {evaluator:?}:\n{fault}");
                }
                count += 1;
            }
        }
    }
    assert!(count > 50, "hardly a pass was looked at: {count}");
}

#[test]
fn every_source_is_valid_and_has_an_entry_point() {
    for (pass, text) in sources() {
        let module = validate(&text).unwrap_or_else(|fault| panic!("{pass}:\n{fault}"));
        assert!(!module.entry_points.is_empty(), "{pass} has no entry point");
    }
}

#[test]
fn every_file_is_part_of_some_pass() {
    let all: String = sources().into_iter().map(|(_, text)| text).collect();
    for (name, text) in FILES {
        let first = text.lines().find(|line| line.starts_with("fn ") || line.starts_with("const "));
        assert!(first.is_none_or(|line| all.contains(line)), "{name} is included by nothing");
    }
}

#[test]
fn a_broken_shader_is_refused() {
    assert!(validate("fn f() -> f32 { return 1u; }").is_err());
    assert!(validate("fn f() -> f32 { return g(); }").is_err());
    assert!(validate("fn f() -> f32 { return 1.0; }").is_ok());
}

/// Memory layout of a Rust struct.
struct Layout {
    name: &'static str,
    size: usize,
    members: Vec<(&'static str, usize)>,
}

macro_rules! layout {
    ($name:literal = $type:ty { $($member:ident),* $(,)? }) => {
        Layout {
            name: $name,
            size: size_of::<$type>(),
            members: vec![$((stringify!($member), offset_of!($type, $member))),*],
        }
    };
}

impl Layout {
    /// Differences from the WGSL struct of the same name; empty if there are none.
    fn differences(&self, module: &naga::Module) -> String {
        let found = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(self.name));
        let Some((_, naga::Type { inner: naga::TypeInner::Struct { members, span }, .. })) = found else {
            return format!("{} is not in the shader", self.name);
        };
        let theirs: Vec<_> = members.iter().map(|m| (m.name.as_deref().unwrap_or(""), m.offset as usize)).collect();
        if theirs != self.members || *span as usize != self.size {
            return format!("{}: Rust {:?} of {}, WGSL {theirs:?} of {span}", self.name, self.members, self.size);
        }
        String::new()
    }
}

fn instance() -> Layout {
    layout!(
        "Instance" = Instance {
            eye_from_local_x,
            eye_from_local_y,
            eye_from_local_z,
            normal_x,
            normal_y,
            normal_z,
            color,
            texture_x,
            texture_y,
            base_color,
            visibility,
            overridden,
            mirrored,
            alpha_cutoff,
            ray_origin_depth,
            emission,
            material,
            metalness,
            roughness,
            normal_scale,
            occlusion_strength,
            unlit,
            blended,
            padding_1,
            padding_2,
            map_rows
        }
    )
}

fn flat_node() -> Layout {
    layout!("FlatNode" = FlatNode { code, extent, params, material })
}

fn view() -> Layout {
    layout!(
        "View" = GpuView {
            right,
            near,
            up,
            far,
            forward,
            footprint,
            sky,
            light_count,
            horizon,
            width,
            ambient,
            height,
            jitter,
            exposure,
            sample_index,
            transparent,
            first_surfaces,
            padding_1,
            padding_2
        }
    )
}

fn dispatch_params() -> Layout {
    layout!(
        "DispatchParams" = DispatchParams {
            origin,
            end,
            component,
            max_steps,
            relaunch,
            last_relaunch,
            list,
            first_subtile,
            compacted,
            rays,
            hits,
            max_cells,
            near,
            far,
            footprint,
            copy_steps,
            spacing,
            padding_1
        }
    )
}

fn shadow_settings() -> Layout {
    layout!(
        "ShadowSettings" = ShadowSettings {
            lights,
            stride,
            cones,
            sample,
            fineness,
            occlusion_radius,
            occlusion_strength,
            spacing,
            cone_spacing
        }
    )
}

fn flat_material() -> Layout {
    layout!(
        "FlatMaterial" = FlatMaterial {
            base_color,
            metalness,
            specular_color,
            specular_weight,
            emission,
            coat_darkening,
            coat_color,
            coat_weight,
            roughness,
            ior,
            coat_roughness,
            coat_ior,
            diffuse_roughness,
            phong_weight,
            phong_specular,
            phong_shininess,
            opacity,
            opacity_threshold,
            padding_0,
            padding_1
        }
    )
}

fn light() -> Layout {
    layout!(
        "Light" = GpuLight {
            position,
            kind,
            direction,
            range,
            color,
            radius,
            right,
            cos_inner,
            up,
            cos_outer,
            constant,
            linear,
            quadratic,
            cast_shadows
        }
    )
}

#[test]
fn rust_and_wgsl_agree_about_every_struct() {
    let layouts = [
        layout!("FlatTexture" = FlatTexture { first, kind, second, image, scale, a, b, wrap }),
        layout!("TextureSet" = TextureSet { slots, base_weight, sharpness, strength }),
        layout!(
            "GpuPlacedTextures" =
                GpuPlacedTextures { rows, textures, bump, copied_by, cells, first, skew, last, repeated, steps }
        ),
        flat_node(),
        flat_material(),
        layout!(
            "Component" = GpuComponent {
                eye,
                first,
                low,
                end,
                high,
                params,
                half_space,
                grid_low,
                grid_side,
                grid_counts,
                tapes,
                ray_origin_depth,
                flush,
                flush_near,
                kind,
                translucency,
                padding_0,
                padding_1,
                padding_2
            }
        ),
        view(),
        dispatch_params(),
        instance(),
        layout!("RayMesh" = RayMesh { local_x, local_y, local_z, nodes, triangles, index, padding_0 }),
        layout!("HierarchyNode" = GpuHierarchyNode { low, link, high, axis }),
        shadow_settings(),
        layout!("SceneLimits" = SceneLimits { tree_nodes, all_nodes, max_evaluations, max_visits }),
        layout!("Overlay" = Overlay { eye, cell, axis_x, axis_z, leaf_count, size, axis, reach, bias, padding }),
        layout!(
            "DebugView" =
                DebugView { view_mode, top, bottom, spacing, first_mesh, first_component, padding_0, padding_1 }
        ),
        light(),
    ];
    let modules: Vec<_> = passes()
        .map(|pass| {
            validate(&assemble(pass, &Evaluator::Interpreter(OpSet::all()), Options::default()).expect("checked above"))
                .expect("checked above")
        })
        .chain([validate(&textured()).expect("checked above")])
        .collect();
    for layout in &layouts {
        let holds = |m: &&naga::Module| m.types.iter().any(|(_, ty)| ty.name.as_deref() == Some(layout.name));
        let holding: Vec<_> = modules.iter().filter(holds).collect();
        assert!(!holding.is_empty(), "{} is in no shader", layout.name);
        for module in holding {
            assert_eq!(layout.differences(module), "");
        }
    }
}

#[test]
fn a_struct_that_lies_differently_is_caught() {
    let differs = |members: &str| {
        let text = format!("struct FlatNode {{ {members} }}\n@group(0) @binding(0) var<storage> n: FlatNode;");
        !flat_node().differences(&validate(&text).expect("a valid sample")).is_empty()
    };
    assert!(!differs("code: u32, extent: u32, params: u32, material: u32"));
    assert!(differs("extent: u32, code: u32, params: u32, material: u32"));
    assert!(differs("code: u32, extent: u32, params: u32"));
    assert!(differs("code: u32, extent: u32, params: vec2u"));
    assert!(differs("code: u32, extent: u32, params: u32, material: u32, more: u32"));
}
