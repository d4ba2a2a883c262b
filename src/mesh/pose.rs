//! The positions of a primitive's vertices: given by its node's transform or by the joints of a skin, with morph
//! targets at the weights of the rest pose.

use glam::{DAffine3, DMat3, DMat4, DVec3};

use super::accessor::Source;
use super::error::LoadRefusal;
use super::limits::MAX_JOINTS;
use super::schema::{GltfNode, Primitive, Root, Skin};

/// The placement of a mesh's vertices in the file's space.
pub(super) enum Pose {
    /// One transform for all vertices.
    Rigid(DAffine3),
    /// Each vertex by its joints; the node's own transform does not count (specification, 3.7.3.1).
    Skinned {
        /// The transform from the bind pose to the file's space, for each joint.
        joints: Vec<DAffine3>,
        /// The transform for primitives without joints.
        world_from_node: DAffine3,
    },
}

impl Pose {
    /// The pose of the mesh at a node.
    pub fn of(source: &Source<'_>, world_from_node: &[DAffine3], node: usize) -> Result<Self, LoadRefusal> {
        let root: &Root = source.root;
        let Some(skin) = root.nodes[node].skin else { return Ok(Self::Rigid(world_from_node[node])) };
        let place = format!("skins[{}]", skin.0);
        let Some(entry) = root.skins.get(skin.index()) else { return Err(LoadRefusal::at(place, "is missing")) };
        let joints = joints(source, world_from_node, entry, &place)?;
        Ok(Self::Skinned { joints, world_from_node: world_from_node[node] })
    }
}

fn joints(
    source: &Source<'_>,
    world_from_node: &[DAffine3],
    skin: &Skin,
    place: &str,
) -> Result<Vec<DAffine3>, LoadRefusal> {
    if skin.joints.is_empty() || skin.joints.len() > MAX_JOINTS {
        let count = skin.joints.len();
        return Err(LoadRefusal::at(
            format!("{place}.joints"),
            format!("has {count} entries; 1 to {MAX_JOINTS} are allowed"),
        ));
    }
    // Many meshes may share a skin.
    source.charge(skin.joints.len() as u64, place)?;
    let places = skin.joints.iter().map(|joint| world_from_node[joint.index()]);
    let Some(accessor) = skin.inverse_bind_matrices else { return Ok(places.collect()) };
    let user = format!("{place}.inverseBindMatrices");
    let inverse = source.matrices(accessor, &user)?;
    if inverse.len() < skin.joints.len() {
        let reason = format!("has {} entries for {} joints", inverse.len(), skin.joints.len());
        return Err(LoadRefusal::at(user, reason));
    }
    let bound = places.zip(&inverse).map(|(place, m)| {
        let m = DMat4::from_cols_array(&m.map(f64::from));
        let w = if m.w_axis.w == 0.0 { 1.0 } else { m.w_axis.w };
        place * DAffine3::from_mat3_translation(DMat3::from_mat4(m) * (1.0 / w), m.w_axis.truncate() / w)
    });
    let bound: Vec<_> = bound.collect();
    match bound.iter().position(|m| !m.is_finite()) {
        Some(joint) => Err(LoadRefusal::at(user, format!("is not finite for joint {joint}"))),
        None => Ok(bound),
    }
}

/// The vertices of a primitive after the morph targets, with their pose.
pub(super) struct Vertices<'a> {
    pub positions: Vec<[f32; 3]>,
    /// `None` if the file has none.
    pub normals: Option<Vec<[f32; 3]>>,
    /// With the sign of the bitangent; `None` if nothing needs them or the file has none.
    pub tangents: Option<Vec<[f32; 4]>>,
    pose: &'a Pose,
    /// Joints and their weights, four at a time; empty if the pose is rigid.
    influences: Vec<Influences>,
}

struct Influences {
    joints: Vec<[f32; 4]>,
    weights: Vec<[f32; 4]>,
}

impl<'a> Vertices<'a> {
    /// Reads the attributes that place the vertices. `place` is that of the primitive.
    pub fn read(
        source: &Source<'_>,
        primitive: &Primitive,
        pose: &'a Pose,
        morph: &[f64],
        with_tangents: bool,
        place: &str,
    ) -> Result<Self, LoadRefusal> {
        let at = |name: &str| format!("{place}.attributes.{name}");
        let Some(accessor) = primitive.attributes.get("POSITION") else {
            return Err(LoadRefusal::at(at("POSITION"), "is missing"));
        };
        if source.is_zero(*accessor) {
            return Err(LoadRefusal::at(at("POSITION"), "lacks data: its accessor names no buffer view"));
        }
        let positions = source.floats::<3>(*accessor, 3, &at("POSITION"))?;
        let count = positions.len();
        let normals = match primitive.attributes.get("NORMAL") {
            None => None,
            Some(accessor) => {
                same_count(source.count(*accessor), count, &at("NORMAL"))?;
                let normals = source.floats::<3>(*accessor, 3, &at("NORMAL"))?;
                if let Some(i) = normals.iter().position(|n| n.iter().any(|c| !c.is_finite())) {
                    return Err(LoadRefusal::at(at("NORMAL"), format!("is not finite at vertex {i}")));
                }
                Some(normals)
            }
        };
        let tangents = match primitive.attributes.get("TANGENT").filter(|_| with_tangents && normals.is_some()) {
            None => None,
            Some(accessor) => {
                same_count(source.count(*accessor), count, &at("TANGENT"))?;
                let tangents = source.floats::<4>(*accessor, 4, &at("TANGENT"))?;
                if let Some(i) = tangents.iter().position(|t| t.iter().any(|c| !c.is_finite())) {
                    return Err(LoadRefusal::at(at("TANGENT"), format!("is not finite at vertex {i}")));
                }
                Some(tangents)
            }
        };
        let mut vertices = Self { positions, normals, tangents, pose, influences: Vec::new() };
        vertices.morph(source, primitive, morph, place)?;
        if let Pose::Skinned { joints, .. } = pose {
            vertices.read_influences(source, primitive, joints.len(), place)?;
        }
        Ok(vertices)
    }

    /// Adds the morph targets. Does not read targets of weight 0.
    fn morph(
        &mut self,
        source: &Source<'_>,
        primitive: &Primitive,
        morph: &[f64],
        place: &str,
    ) -> Result<(), LoadRefusal> {
        for (t, (target, weight)) in primitive.targets.iter().zip(morph).enumerate() {
            for (name, values) in [("POSITION", Some(&mut self.positions)), ("NORMAL", self.normals.as_mut())] {
                let (Some(accessor), Some(values)) = (target.get(name), values) else { continue };
                if *weight == 0.0 || source.is_zero(*accessor) {
                    continue;
                }
                let user = format!("{place}.targets[{t}].{name}");
                same_count(source.count(*accessor), values.len(), &user)?;
                for (value, offset) in values.iter_mut().zip(source.floats::<3>(*accessor, 3, &user)?) {
                    *value = [0, 1, 2].map(|c| (f64::from(value[c]) + weight * f64::from(offset[c])) as f32);
                }
                if let Some(i) = values.iter().position(|v| v.iter().any(|c| !c.is_finite())) {
                    return Err(LoadRefusal::at(user, format!("is not finite at vertex {i}")));
                }
            }
        }
        Ok(())
    }

    fn read_influences(
        &mut self,
        source: &Source<'_>,
        primitive: &Primitive,
        joint_count: usize,
        place: &str,
    ) -> Result<(), LoadRefusal> {
        let count = self.positions.len();
        for set in 0.. {
            let names = [format!("JOINTS_{set}"), format!("WEIGHTS_{set}")];
            let [Some(joints), Some(weights)] = names.each_ref().map(|name| primitive.attributes.get(name)) else {
                break;
            };
            let users = names.each_ref().map(|name| format!("{place}.attributes.{name}"));
            let read = |accessor, user: &str| {
                same_count(source.count(accessor), count, user)?;
                source.floats::<4>(accessor, 4, user)
            };
            let (joints, weights) = (read(*joints, &users[0])?, read(*weights, &users[1])?);
            for (i, (joints, weights)) in joints.iter().zip(&weights).enumerate() {
                if weights.iter().any(|w| !w.is_finite() || *w < 0.0) {
                    return Err(LoadRefusal::at(&users[1], format!("is no share at vertex {i}")));
                }
                let names_joint = |joint: f32| joint >= 0.0 && joint.fract() == 0.0 && (joint as usize) < joint_count;
                // A joint of weight 0 has no effect, and many exporters leave any index there.
                if joints.iter().zip(weights).any(|(joint, weight)| *weight > 0.0 && !names_joint(*joint)) {
                    return Err(LoadRefusal::at(&users[0], format!("names a joint that is missing at vertex {i}")));
                }
            }
            self.influences.push(Influences { joints, weights });
        }
        Ok(())
    }

    /// The transform of a vertex from its stored position to the file's space.
    pub fn world_from_local(&self, vertex: usize) -> DAffine3 {
        let joints = match self.pose {
            Pose::Rigid(world_from_local) => return *world_from_local,
            Pose::Skinned { world_from_node, .. } if self.influences.is_empty() => return *world_from_node,
            Pose::Skinned { joints, .. } => joints,
        };
        let (mut matrix3, mut translation, mut total) = (DMat3::ZERO, DVec3::ZERO, 0.0);
        for set in &self.influences {
            for (joint, weight) in set.joints[vertex].iter().zip(set.weights[vertex]) {
                if weight > 0.0 {
                    let (joint, weight) = (&joints[*joint as usize], f64::from(weight));
                    matrix3 += joint.matrix3 * weight;
                    translation += joint.translation * weight;
                    total += weight;
                }
            }
        }
        // Weights should sum to 1; the rounding of quantized weights would scale the vertex toward the origin.
        if total > 0.0 {
            DAffine3 { matrix3: matrix3 * (1.0 / total), translation: translation / total }
        } else {
            joints[0]
        }
    }

    /// The position of a vertex in the file's space.
    pub fn world(&self, vertex: usize) -> DVec3 {
        self.world_from_local(vertex).transform_point3(DVec3::from(self.positions[vertex].map(f64::from)))
    }

    /// The unit normal of a vertex in the file's space, zero if the file's normal is zero; `None` without normals.
    pub fn normal(&self, vertex: usize) -> Option<DVec3> {
        let normal = DVec3::from(self.normals.as_ref()?[vertex].map(f64::from));
        let cofactors = cofactors(&self.world_from_local(vertex).matrix3);
        Some((cofactors * normal).try_normalize().unwrap_or(DVec3::ZERO))
    }

    /// The unit tangent of a vertex in the file's space, with the sign of the bitangent; zero if the file's tangent is
    /// zero; `None` without tangents.
    pub fn tangent(&self, vertex: usize) -> Option<[f32; 4]> {
        let [x, y, z, sign] = self.tangents.as_ref()?[vertex];
        let matrix = self.world_from_local(vertex).matrix3;
        let tangent = matrix * DVec3::from([x, y, z].map(f64::from));
        let Some(tangent) = tangent.try_normalize() else { return Some([0.0; 4]) };
        // A mirror reverses the cross product of normal and tangent.
        let sign = if (sign < 0.0) == (matrix.determinant() < 0.0) { 1.0 } else { -1.0 };
        let [x, y, z] = tangent.as_vec3().to_array();
        Some([x, y, z, sign])
    }

    /// Whether the pose mirrors a triangle at this vertex, so that its winding is reversed.
    pub fn is_mirrored(&self, vertex: usize) -> bool {
        self.world_from_local(vertex).matrix3.determinant() < 0.0
    }
}

/// The weights of the morph targets of the mesh at a node, in the rest pose.
pub(super) fn morph_weights<'a>(root: &'a Root, node: &'a GltfNode) -> &'a [f64] {
    let of_mesh = || node.mesh.and_then(|mesh| root.meshes.get(mesh.index())?.weights.as_deref());
    node.weights.as_deref().or_else(of_mesh).unwrap_or(&[])
}

/// Refuses an attribute whose entry count differs from the vertex count.
pub(super) fn same_count(count: u64, vertices: usize, place: &str) -> Result<(), LoadRefusal> {
    if count == vertices as u64 {
        return Ok(());
    }
    Err(LoadRefusal::at(place, format!("has {count} entries for {vertices} vertices")))
}

/// The normal matrix of `m`: the inverse transpose times the magnitude of the determinant, which exists for singular
/// matrices too.
fn cofactors(m: &DMat3) -> DMat3 {
    let (x, y, z) = (m.x_axis, m.y_axis, m.z_axis);
    DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y)) * m.determinant().signum()
}
