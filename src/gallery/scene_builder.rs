//! The builder of the example scenes.

use std::f64::consts::PI;

use glam::{DQuat, DVec3};

use isolith_geometry::Camera;
use isolith_scene::{
    Blend, BlendKernel, CameraNode, Environment, EnvironmentKind, Falloff, Group, Light, LightKind, Material,
    MaterialId, MeshNode, Node, NodeId, NodeKind, Object, Operator, ParamValue, ReflectionModel, Scene, Shadowing,
    Shape,
};

/// A scene under construction.
///
/// It rounds every result of a sine or a square root to nine decimals: math libraries differ in the last bits, and the
/// files must not.
pub(super) struct SceneBuilder {
    scene: Scene,
}

impl SceneBuilder {
    /// An empty scene with this environment.
    pub fn new(sky: [f64; 3], horizon: [f64; 3], ambient: [f64; 3]) -> Self {
        let scene = Scene::from_tables(Vec::new(), Vec::new(), Environment::sky(sky, horizon, ambient), 1)
            .expect("an empty scene is within every limit");
        Self { scene }
    }

    /// Brightens the picture by this many stops.
    pub fn expose(&mut self, stops: f64) {
        self.scene.display.exposure = stops;
    }

    /// Switches shadows and occlusion on.
    pub fn shade(&mut self, shadowing: Shadowing) {
        self.scene.environment.shadowing = shadowing;
    }

    /// A dry material without a visible highlight.
    pub fn matte(&mut self, name: &str, base_color: [f64; 3]) -> MaterialId {
        let (base_diffuse_roughness, specular_weight, specular_roughness) = (0.5, 0.5, 0.8);
        self.material(Material {
            base_diffuse_roughness,
            specular_weight,
            specular_roughness,
            ..Material::new(MaterialId(0), name, base_color)
        })
    }

    /// A plastic of this roughness.
    pub fn glossy(&mut self, name: &str, base_color: [f64; 3], specular_roughness: f64) -> MaterialId {
        self.material(Material { specular_roughness, ..Material::new(MaterialId(0), name, base_color) })
    }

    /// A rough material under a clear coat of this roughness: enamel, glaze, lacquer.
    pub fn coated(&mut self, name: &str, base_color: [f64; 3], coat_roughness: f64) -> MaterialId {
        let (specular_roughness, coat_weight, coat_ior) = (0.5, 1.0, 1.5);
        self.material(Material {
            specular_roughness,
            coat_weight,
            coat_roughness,
            coat_ior,
            ..Material::new(MaterialId(0), name, base_color)
        })
    }

    /// A metal of this roughness.
    pub fn metal(&mut self, name: &str, base_color: [f64; 3], specular_roughness: f64) -> MaterialId {
        let material = Material::new(MaterialId(0), name, base_color);
        self.material(Material { specular_roughness, base_metalness: 1.0, ..material })
    }

    /// A material that emits light.
    pub fn glowing(&mut self, name: &str, base_color: [f64; 3], emission_color: [f64; 3]) -> MaterialId {
        let material = Material::new(MaterialId(0), name, base_color);
        self.material(Material { specular_weight: 0.0, emission_luminance: 1.0, emission_color, ..material })
    }

    /// A smooth material that glows from within.
    pub fn gem(&mut self, name: &str, base_color: [f64; 3], emission_color: [f64; 3]) -> MaterialId {
        let (specular_roughness, specular_ior, emission_luminance) = (0.12, 1.8, 1.0);
        self.material(Material {
            specular_roughness,
            specular_ior,
            emission_luminance,
            emission_color,
            ..Material::new(MaterialId(0), name, base_color)
        })
    }

    /// A smooth liquid.
    pub fn water(&mut self, name: &str, base_color: [f64; 3]) -> MaterialId {
        let (specular_roughness, specular_ior) = (0.1, 1.33);
        self.material(Material { specular_roughness, specular_ior, ..Material::new(MaterialId(0), name, base_color) })
    }

    /// A material by Blinn and Phong.
    pub fn phong(&mut self, name: &str, base_color: [f64; 3], specular: f64, shininess: f64) -> MaterialId {
        let model = ReflectionModel::BlinnPhong { specular, shininess };
        self.material(Material { model, ..Material::new(MaterialId(0), name, base_color) })
    }

    /// Any material, under a new id.
    pub fn material(&mut self, material: Material) -> MaterialId {
        let id = self.scene.next_material_id();
        self.scene.insert_material(Material { id, ..material }).expect("the id is new");
        id
    }

    /// Adds a node behind the other children of its parent.
    pub fn add(&mut self, parent: impl Into<Option<NodeId>>, node: Node) -> NodeId {
        let inserted = self.scene.insert(parent.into(), usize::MAX, settled(node));
        inserted.expect("example scenes are within every limit")
    }

    /// Parallel light from the direction `from`, under which a white surface has the radiance `white`.
    pub fn sun(&mut self, name: &str, from: [f64; 3], color: [f64; 3], white: f64) {
        let rotation = Camera::looking_at(DVec3::from(from), DVec3::ZERO, 1.0).rotation;
        let sun = LightKind::Sun { strength: rounded(white * PI), angle: 0.0 };
        let light = Light { color, ..Light::new(sun) };
        self.add(None, Node::new(name, NodeKind::Light(light)).at(DVec3::from(from)).rotated(rotation));
    }

    /// A point light under which a white surface has the radiance `white`, where the falloff is 1.
    pub fn lamp(&mut self, name: &str, at: [f64; 3], color: [f64; 3], white: f64, falloff: Falloff) {
        let point = LightKind::Point { power: rounded(white * (4.0 * PI * PI)), radius: 0.0, falloff };
        let light = Light { color, ..Light::new(point) };
        self.add(None, Node::new(name, NodeKind::Light(light)).at(DVec3::from(at)));
    }

    /// A spot light at `at`, aimed at `target`, with a cone from `inner` to `outer` degrees.
    pub fn spot(
        &mut self,
        name: &str,
        [at, target]: [[f64; 3]; 2],
        color: [f64; 3],
        white: f64,
        [inner, outer]: [f64; 2],
    ) {
        let falloff = Falloff::Attenuation { constant: 1.0, linear: 0.0, quadratic: 0.02, range: 40.0 };
        let power = rounded(white * (4.0 * PI * PI));
        let light = Light { color, ..Light::new(LightKind::Spot { power, radius: 0.0, falloff, inner, outer }) };
        let rotation = Camera::looking_at(DVec3::from(at), DVec3::from(target), 1.0).rotation;
        self.add(None, Node::new(name, NodeKind::Light(light)).at(DVec3::from(at)).rotated(rotation));
    }

    /// A material by OpenPBR.
    pub fn surface(&mut self, name: &str, color: [f64; 3], metalness: f64, roughness: f64) -> MaterialId {
        let material = Material::new(MaterialId(0), name, color);
        self.material(Material { base_metalness: metalness, specular_roughness: roughness, ..material })
    }

    /// A light at `at`, aimed at `target`.
    pub fn light(&mut self, name: &str, [at, target]: [[f64; 3]; 2], color: [f64; 3], kind: LightKind) {
        let (at, target) = (DVec3::from(at), DVec3::from(target));
        let rotation = Camera::looking_at(at, target, 1.0).rotation;
        let light = Light { color, ..Light::new(kind) };
        self.add(None, Node::new(name, NodeKind::Light(light)).at(at).rotated(rotation));
    }

    /// Replaces the environment.
    pub fn environment(&mut self, background: EnvironmentKind) {
        let environment = Environment { background, ..self.scene.environment.clone() };
        self.scene.set_environment(environment).expect("its image is small");
    }

    /// Adds the camera.
    pub fn camera(&mut self, position: [f64; 3], target: [f64; 3], fov_y: f64) {
        self.view(CameraNode { fov_y, ..CameraNode::default() }, position, target);
    }

    /// Adds a camera.
    pub fn view(&mut self, camera: CameraNode, position: [f64; 3], target: [f64; 3]) {
        let (position, target) = (DVec3::from(position), DVec3::from(target));
        let rotation = Camera::looking_at(position, target, 1.0).rotation;
        self.add(None, Node::new("Camera", NodeKind::Camera(camera)).at(position).rotated(rotation));
    }

    /// The finished scene.
    pub fn finish(self) -> Scene {
        self.scene
    }
}

/// A group with a hard operator.
pub(super) fn group(name: &str, operator: Operator) -> Node {
    Node::new(name, NodeKind::Group(Group::new(operator, Blend::HARD)))
}

/// A group with a blend.
pub(super) fn blended(name: &str, operator: Operator, kernel: BlendKernel, radius: f64) -> Node {
    Node::new(name, NodeKind::Group(Group::new(operator, Blend::new(kernel, radius))))
}

/// A shape with a material.
pub(super) fn object(name: &str, shape: Shape, material: MaterialId) -> Node {
    Node::new(name, NodeKind::Object(Object { shape, material }))
}

/// A mesh from a glTF file.
pub(super) fn mesh(name: &str, path: &str) -> Node {
    Node::new(name, NodeKind::Mesh(MeshNode::new(path)))
}

pub(super) fn sphere(radius: f64) -> Shape {
    Shape::Sphere { radius }
}

pub(super) fn ellipsoid(x: f64, y: f64, z: f64) -> Shape {
    Shape::Ellipsoid { radii: [x, y, z] }
}

/// A box of the given edge lengths with rounded edges.
pub(super) fn cuboid(x: f64, y: f64, z: f64, rounding: f64) -> Shape {
    Shape::Box { size: [x, y, z], rounding }
}

pub(super) fn cylinder(radius: f64, height: f64, rounding: f64) -> Shape {
    Shape::Cylinder { radius, height, rounding }
}

pub(super) fn torus(major_radius: f64, minor_radius: f64) -> Shape {
    Shape::Torus { major_radius, minor_radius }
}

pub(super) fn cone(bottom_radius: f64, top_radius: f64, height: f64) -> Shape {
    Shape::CappedCone { bottom_radius, top_radius, height }
}

pub(super) fn round_cone(bottom_radius: f64, top_radius: f64, height: f64) -> Shape {
    Shape::RoundCone { bottom_radius, top_radius, height }
}

pub(super) fn capsule(start: [f64; 3], end: [f64; 3], radius: f64) -> Shape {
    Shape::Capsule { start, end, radius }
}

/// A rotation about X, in degrees.
pub(super) fn turn_x(degrees: f64) -> DQuat {
    DQuat::from_rotation_x(degrees.to_radians())
}

/// A rotation about Y, in degrees.
pub(super) fn turn_y(degrees: f64) -> DQuat {
    DQuat::from_rotation_y(degrees.to_radians())
}

/// A rotation about Z, in degrees.
pub(super) fn turn_z(degrees: f64) -> DQuat {
    DQuat::from_rotation_z(degrees.to_radians())
}

pub(super) fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// A computed number, to nine decimals.
fn rounded(v: f64) -> f64 {
    (v * 1e9).round() / 1e9 + 0.0
}

/// The node with every computed number rounded.
fn settled(mut node: Node) -> Node {
    let round = rounded;
    let round3 = |v: DVec3| DVec3::new(round(v.x), round(v.y), round(v.z));
    let transform = &mut node.transform;
    transform.translation = round3(transform.translation);
    transform.scale = round3(transform.scale);
    transform.rotation = DQuat::from_array(transform.rotation.to_array().map(round)).normalize();
    if let NodeKind::Object(object) = &mut node.kind {
        for (i, value) in object.shape.values().into_iter().enumerate() {
            object.shape.set_value(
                i,
                match value {
                    ParamValue::Scalar(v) => ParamValue::Scalar(round(v)),
                    ParamValue::Vector(v) => ParamValue::Vector(round3(v)),
                    ParamValue::List(mut list) => {
                        list.rows.iter_mut().flatten().for_each(|v| *v = round(*v));
                        ParamValue::List(list)
                    }
                    other => other,
                },
            );
        }
    }
    if let NodeKind::Group(group) = &mut node.kind {
        group.blend.radius = round(group.blend.radius);
    }
    node
}
