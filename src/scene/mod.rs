//! The scene as plain data: a flat table of nodes, a table of materials, an environment.
//!
//! Nothing here evaluates fields, draws or edits; see `field`, `render` and `document` for that.
//!
//! # Example
//!
//! A scene in a file, and back:
//!
//! ```
//! use isolith_scene::{Node, NodeKind, Object, Scene, Shape, file};
//!
//! let mut scene = Scene::new();
//! let material = scene.materials()[0].id;
//! let shape = Shape::Sphere { radius: 1.0 };
//! scene.insert(None, 0, Node::new("Ball", NodeKind::Object(Object { shape, material })))?;
//! let text = file::to_json(&scene)?;
//! assert_eq!(file::parse(text.as_bytes(), "ball.json".as_ref())?, scene);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod animation;
mod attached;
mod attachment;
mod axis;
mod baked;
mod bookmark;
pub mod check;
mod decode_budget;
mod display;
mod drawn;
mod dynamics;
mod empty_set;
mod environment;
mod environment_image;
mod error;
mod eval_params;
pub mod file;
mod heights;
mod image_budget;
mod image_file;
mod instancer;
mod instancer_presets;
mod light;
pub mod limits;
mod march;
mod material;
mod model_fields;
mod model_file;
mod modifier;
mod node;
mod node_id;
mod operator;
mod packed;
mod param_path;
mod params;
mod presets;
mod response_curve;
mod shadowing;
mod shape;
mod table;
mod texture;
mod texture_image;
mod texture_source;
mod whole;

pub use animation::{Animation, KeyInterpolation, Keyframe, MovedParts, SAME_TIME, Timeline, Track};
pub use attached::Attached;
pub use attachment::{Attachment, Content};
pub use axis::Axis;
pub use bookmark::{Bookmark, MAX_BOOKMARKS};
pub use display::{DisplaySettings, ViewTransform};
pub use drawn::{Corners, Points, profile_curve, text_profile, tube_curve};
pub use dynamics::{Dynamic, DynamicKind, DynamicSlot, MAX_DYNAMICS};
pub use empty_set::EmptyOperandResult;
pub use environment::{Environment, EnvironmentKind};
pub use environment_image::EnvironmentImage;
pub use error::SceneError;
pub use eval_params::{
    EvalMember, EvalParams, EvalValue, MAX_MEMBERS, MemberType, ParamLayout, PolygonSides, SineCosine,
};
pub use heights::Heights;
pub use instancer::{
    Instancer, Lattice, LatticeKind, MAX_MASKS, MAX_PALETTE, MAX_TYPES, Mask, MaskJoin, MaskKind, MaskSlot,
    MaterialVariation, Snap, Variation,
};
pub use instancer_presets::InstancerPreset;
pub use light::{Falloff, Light, LightKind};
pub use limits::Limits;
pub use march::{MarchResolution, MarchSettings};
pub use material::{Material, MaterialId, ReflectionModel};
pub use model_fields::ModelRequest;
pub use model_file::ModelFile;
pub use modifier::{MAX_MODIFIERS, Modifier, ModifierKind, ModifierSlot};
pub use node::{CameraNode, Group, MeshNode, Node, NodeKind, Object};
pub use node_id::NodeId;
pub use operator::{Blend, BlendKernel, BlendOverride, Operation, Operator, RadiusUnit};
pub use packed::{PACKED_ENDINGS, PackedFiles};
pub use param_path::{Changed, ParamOwner, ParamPath, Part};
pub use params::{
    Choice, LIST_COLUMNS, List, Param, ParamField, ParamSlot, ParamSpec, ParamValue, Params, Variants, Visit,
};
pub use presets::material_presets;
pub use response_curve::{CurvePreset, MAX_CURVE_POINTS, MIN_CURVE_GAP, MIN_CURVE_POINTS, ResponseCurve};
pub use shadowing::Shadowing;
pub use shape::{Degrees, SHAPE_FLOATS, Shape, ShapeKind, Sides, shape_params};
pub use table::Scene;
pub use texture::{NormalTexture, TextureSpace, Textures};
pub use texture_image::{MAX_SHARES, Pyramid, ShareImage, TexelForm, TexelLevel, TextureImage};
pub use texture_source::{
    ColorSpace, ColorTexture, HeightTexture, OpacityTexture, PatternKind, RoughnessTexture, TextureSource, TextureWrap,
};
