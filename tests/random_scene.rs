//! Random scenes, identical for the same seed on every machine.

use glam::{DQuat, DVec3};
use isolith::geometry::Transform;
use isolith::scene::{
    Blend, BlendKernel, BlendOverride, CameraNode, DisplaySettings, Environment, Falloff, Group, Light, LightKind,
    Limits, Material, MaterialId, MeshNode, Modifier, ModifierKind, ModifierSlot, Node, NodeId, NodeKind, Object,
    Operation, Operator, ParamValue, RadiusUnit, Scene, Shape, ShapeKind, ViewTransform, limits,
};

use crate::contract::samples::image;

/// A small random number generator: splitmix64 (Steele, Lea and Flood, 2014).
pub struct Random(u64);

impl Random {
    /// The sequence of this seed.
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0xd134_2543_de82_ef95))
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A random integer below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    /// From 0 to 1.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// True once in `n` times.
    pub fn once_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }

    /// A random element.
    pub fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.below(from.len())]
    }

    /// A number within limits, often an end of the range, zero, tiny or round.
    pub fn number(&mut self, limits: &Limits) -> f64 {
        let [least, most] = limits.hard;
        let value = match self.below(8) {
            0 => self.pick(&[least, most, 0.0, -0.0, 1.0, 0.1, f64::MIN_POSITIVE, 5e-324, 1.0 / 3.0]),
            1 => (self.unit() * 10.0).round(),
            2 => least + (most - least) * self.unit(),
            3 => self.unit() * 10f64.powi(self.below(20) as i32 - 12),
            _ => limits.soft[0] + (limits.soft[1] - limits.soft[0]) * self.unit(),
        };
        value.clamp(least, most)
    }

    fn numbers(&mut self, limits: &Limits) -> [f64; 3] {
        [self.number(limits), self.number(limits), self.number(limits)]
    }

    /// A name, occasionally a difficult one.
    pub fn name(&mut self) -> String {
        let parts = ["Pawn", "Häuschen", "球", "a \"b\" \\ c", "🙂", "", " ", "Torus 2", "x\u{202e}y", "{}[],:", "é́"];
        (0..=self.below(3)).map(|_| self.pick(&parts)).collect()
    }

    /// A transform within the limits.
    pub fn transform(&mut self) -> Transform {
        let mut transform = Transform::IDENTITY;
        if !self.once_in(3) {
            transform.translation = self.numbers(&limits::POSITION).into();
        }
        if self.once_in(2) {
            let axis = DVec3::new(self.unit() - 0.5, self.unit() - 0.5, self.unit() + 0.01).normalize();
            transform.rotation = DQuat::from_axis_angle(axis, self.unit() * 7.0);
        }
        if self.once_in(2) {
            let factor = |r: &mut Self| (0.1 + r.number(&limits::UNIT)) * r.pick(&[1.0, -1.0, 1e5, 1e-5]);
            transform.scale = DVec3::new(factor(self), factor(self), factor(self));
        }
        transform
    }

    /// A shape within its limits.
    pub fn shape(&mut self) -> Shape {
        // Models, the last kind, take no number, so that scenes without them are what they were.
        let (model, others) = ShapeKind::ALL.split_last().expect("there are shapes");
        let kind = if self.0 >> 59 == 7 { *model } else { self.pick(others) };
        let mut shape = kind.default_shape();
        for (i, param) in kind.params().iter().enumerate() {
            let value = match shape.values().swap_remove(i) {
                ParamValue::Scalar(_) => ParamValue::Scalar(self.number(&param.limits)),
                ParamValue::Vector(_) => ParamValue::Vector(self.numbers(&param.limits).into()),
                ParamValue::Flag(_) if kind == *model => ParamValue::Flag(self.0 >> 58 & 1 == 1),
                ParamValue::Flag(_) => ParamValue::Flag(self.once_in(2)),
                ParamValue::Text(_) => ParamValue::Text(self.pick(&["", "a\nb", "\"ß\" {7}"]).to_owned()),
                ParamValue::File(file) if file.endings().contains(&"png") && self.once_in(2) => {
                    ParamValue::File(image(&file, &mut || self.bits() as u16))
                }
                ParamValue::File(file) => ParamValue::File(file),
                ParamValue::List(mut list) => {
                    let count = list.count[0] + self.below(5);
                    let limits: Vec<_> = (0..list.columns.len()).map(|c| list.limits(c, &param.limits)).collect();
                    let mut row = || std::array::from_fn(|c| limits.get(c).map_or(0.0, |l| self.number(l)));
                    list.rows = (0..count).map(|_| row()).collect();
                    ParamValue::List(list)
                }
                other => unreachable!("no shape has {other:?}"),
            };
            assert!(shape.set_value(i, value));
        }
        shape
    }

    /// A modifier within its limits.
    pub fn modifier(&mut self) -> Modifier {
        let kind = self.pick(ModifierKind::ALL);
        let mut modifier = kind.default_modifier();
        for (i, (param, value)) in kind.params().iter().zip(modifier.values()).enumerate() {
            let limits = &param.limits;
            let mut whole = || self.number(limits).round() as u32;
            let value = match value {
                ParamValue::Count(_) => ParamValue::Count(whole()),
                ParamValue::Counts(_) => ParamValue::Counts([whole(), whole(), whole()]),
                ParamValue::Scalar(_) => ParamValue::Scalar(self.number(limits)),
                ParamValue::Vector(_) => ParamValue::Vector(self.numbers(limits).into()),
                ParamValue::Flag(_) => ParamValue::Flag(self.once_in(2)),
                ParamValue::Flags(_) => ParamValue::Flags([0, 1, 2].map(|_| self.once_in(2))),
                ParamValue::Choice(_) => ParamValue::Choice(&self.pick(&param.choices.iter().collect::<Vec<_>>()).key),
                ParamValue::File(file) if self.once_in(2) => ParamValue::File(image(&file, &mut || self.bits() as u16)),
                ParamValue::File(file) => ParamValue::File(file),
                other => unreachable!("no modifier has {other:?}"),
            };
            assert!(modifier.set_value(i, value));
        }
        modifier
    }

    /// A material within its limits.
    pub fn material(&mut self, id: u64) -> Material {
        let mut material = Material::new(MaterialId(id), self.name(), self.numbers(&limits::UNIT));
        let (specular, shininess) = (self.number(&limits::UNIT), self.number(&limits::SHININESS));
        material.model = isolith::scene::ReflectionModel::BlinnPhong { specular, shininess };
        material.emission_color = self.numbers(&limits::INTENSITY);
        material
    }

    /// An environment within its limits.
    pub fn environment(&mut self) -> Environment {
        let mut color = || self.numbers(&limits::INTENSITY);
        Environment::sky(color(), color(), color())
    }

    /// Display settings within their limits.
    pub fn display(&mut self) -> DisplaySettings {
        DisplaySettings { exposure: self.number(&limits::EXPOSURE), view_transform: self.pick(&ViewTransform::ALL) }
    }

    fn light(&mut self) -> Light {
        let falloff = Falloff::Attenuation {
            constant: 0.5 + self.number(&limits::UNIT),
            linear: self.number(&limits::ATTENUATION),
            quadratic: self.number(&limits::ATTENUATION),
            range: self.number(&limits::RANGE),
        };
        let (a, b) = (self.number(&limits::CONE), self.number(&limits::CONE));
        let falloff = if self.once_in(2) { falloff } else { Falloff::InverseSquare {} };
        let (power, radius) = (self.number(&limits::LIGHT_POWER), self.number(&limits::LIGHT_RADIUS));
        let light = match self.below(4) {
            0 => LightKind::Sun { strength: self.number(&limits::IRRADIANCE), angle: self.number(&limits::SUN_ANGLE) },
            1 => LightKind::Point { power, radius, falloff },
            2 => LightKind::Spot { power, radius, falloff, inner: a.min(b), outer: a.max(b) },
            _ => LightKind::Rectangle {
                power,
                width: self.number(&limits::LIGHT_SIDE),
                height: self.number(&limits::LIGHT_SIDE),
            },
        };
        Light { color: self.numbers(&limits::INTENSITY), cast_shadows: self.once_in(2), light }
    }

    /// Operator and blend of a group.
    pub fn group(&mut self) -> Group {
        let blend = Blend::new(self.pick(&BlendKernel::ALL), self.number(&limits::BLEND_RADIUS));
        let mut group = Group::new(self.pick(&Operator::ALL), blend);
        if self.once_in(2) {
            group.blend.unit = self.pick(&RadiusUnit::ALL);
            group.blend.steps = 1 + self.below(64) as u32;
            group.width = self.number(&limits::THICKNESS);
            group.depth = self.number(&limits::THICKNESS);
            group.share = self.number(&limits::UNIT);
        }
        group
    }

    fn kind(&mut self, materials: &[MaterialId]) -> NodeKind {
        match self.below(if materials.is_empty() { 4 } else { 9 }) {
            0 | 1 => NodeKind::Group(self.group()),
            2 => NodeKind::Light(self.light()),
            3 => {
                let (a, b) = (self.number(&limits::CLIP), self.number(&limits::CLIP));
                let near = a.min(b).min(1e8);
                let far = a.max(b).max(near * 2.0);
                NodeKind::Camera(CameraNode {
                    fov_y: self.number(&limits::FOV),
                    near,
                    far,
                    aperture: self.number(&limits::APERTURE),
                    // By a copy of the generator, so that what follows is what it was.
                    shutter: Self(self.0).number(&limits::SHUTTER),
                    focus_distance: self.number(&limits::CLIP),
                })
            }
            4 => {
                let path = self.pick(&["duck.glb", "models/a b/ü.gltf", "x.y/z"]).to_owned();
                let material = if self.once_in(2) { Some(self.pick(materials)) } else { None };
                let clip = self.pick(&["", "Walk", "0", "Läuft 2"]).to_owned();
                let (clip_time, clip_speed) = (self.number(&limits::CLIP_TIME), self.number(&limits::CLIP_SPEED));
                NodeKind::Mesh(MeshNode { path, material, clip, clip_time, clip_speed })
            }
            _ => NodeKind::Object(Object { shape: self.shape(), material: self.pick(materials) }),
        }
    }

    /// A node of any kind, without id and parent.
    pub fn node(&mut self, materials: &[MaterialId]) -> Node {
        let mut node = Node::new(self.name(), self.kind(materials));
        node.transform = self.transform();
        node.visible = !self.once_in(5);
        node.locked = self.once_in(5);
        if node.has_field() && self.once_in(4) {
            // Not by one more random number, which would change all that follow.
            node.operation = if node.locked { Operation::Intersect } else { Operation::Subtract };
        }
        if node.has_field() && self.once_in(3) {
            let slot = |r: &mut Self| ModifierSlot { enabled: !r.once_in(4), modifier: r.modifier() };
            node.modifiers = (0..=self.below(3)).map(|_| slot(self)).collect();
        }
        if self.once_in(3) {
            let radius = self.number(&limits::BLEND_RADIUS);
            node.blend_override = self.pick(&[BlendOverride::Hard, BlendOverride::Radius(radius)]);
            node.apart = (0..self.below(3)).map(|_| NodeId(self.below(1000) as u64)).collect();
        }
        node
    }
}

/// A scene of about `count` nodes, nested at random, with ids in no order and with gaps.
pub fn random_scene(seed: u64, count: usize) -> Scene {
    let mut random = Random::new(seed);
    let mut materials = Vec::new();
    for i in 0..random.below(4) as u64 {
        let id = i * 3 + random.below(3) as u64;
        materials.push(random.material(id));
    }
    let used: Vec<MaterialId> = materials.iter().map(|m| m.id).collect();
    let mut ids: Vec<u64> = (0..count as u64).map(|i| i * 3 + 1).collect();
    for i in (1..ids.len()).rev() {
        ids.swap(i, random.below(i + 1));
    }
    let mut nodes: Vec<Node> = Vec::new();
    let mut open: Vec<NodeId> = Vec::new();
    for id in ids {
        open.truncate(if random.once_in(3) { random.below(open.len() + 1) } else { open.len() });
        let node = Node { id: NodeId(id), parent: open.last().copied(), ..random.node(&used) };
        if matches!(node.kind, NodeKind::Group(_)) && open.len() < 40 {
            open.push(node.id);
        }
        nodes.push(node);
    }
    let environment = random.environment();
    let tables = Scene::from_tables(nodes, materials, environment, random.bits() >> 20);
    let mut scene = tables.expect("random scenes keep the rules");
    scene.display = random.display();
    scene
}
