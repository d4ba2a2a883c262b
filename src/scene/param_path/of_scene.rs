//! Parameters found by their paths in a scene.

use super::{Changed, ParamOwner, ParamPath, collect};
use crate::params::{Param, ParamValue, Params};
use crate::{Material, Node, Scene, SceneError};

impl ParamPath {
    /// All parameters of a scene: those of the environment, the display, the materials and the nodes.
    pub fn all(scene: &Scene) -> Vec<(Self, &'static Param, ParamValue)> {
        let mut all = Vec::new();
        collect(ParamOwner::Environment, &scene.environment, &mut all);
        collect(ParamOwner::Display, &scene.display, &mut all);
        for material in scene.materials() {
            collect(ParamOwner::Material(material.id), &**material, &mut all);
        }
        all.extend(scene.nodes().iter().flat_map(|node| Self::all_of_node(node)));
        all
    }

    /// The description of the parameter.
    pub fn param(&self, scene: &Scene) -> Result<&'static Param, SceneError> {
        let params = self.params(scene)?;
        params.find(&self.name).ok_or_else(|| self.unknown(params))
    }

    /// Its value; that of one element is a value of its own.
    pub fn get(&self, scene: &Scene) -> Result<ParamValue, SceneError> {
        let params = self.params(scene)?;
        self.value_in(params).ok_or_else(|| self.unknown(params))
    }

    /// A copy of the owner with another value for the parameter; the scene stays unchanged. Does not check limits.
    pub fn changed(&self, scene: &Scene, value: ParamValue) -> Result<Changed, SceneError> {
        let refusal = |params: &dyn Params| match self.value_in(params) {
            None => self.unknown(params),
            Some(now) => self.refused(format!("must be a value like {now}, not {value}")),
        };
        match self.owner {
            ParamOwner::Node(id, part) => {
                let mut node = Node::clone(scene.node(id).ok_or(SceneError::NoNode(id))?);
                let params = part.params_mut(&mut node).ok_or_else(|| self.no_part())?;
                if !self.set_value(params, value.clone()) {
                    return Err(refusal(params));
                }
                Ok(Changed::Node(Box::new(node)))
            }
            ParamOwner::Material(id) => {
                let mut material = Material::clone(scene.material(id).ok_or(SceneError::NoMaterial(id))?);
                if !self.set_value(&mut material, value.clone()) {
                    return Err(refusal(&material));
                }
                Ok(Changed::Material(Box::new(material)))
            }
            ParamOwner::Environment => {
                let mut environment = scene.environment.clone();
                if !self.set_value(&mut environment, value.clone()) {
                    return Err(refusal(&environment));
                }
                Ok(Changed::Environment(environment))
            }
            ParamOwner::Display => {
                let mut display = scene.display;
                if !self.set_value(&mut display, value.clone()) {
                    return Err(refusal(&display));
                }
                Ok(Changed::Display(display))
            }
        }
    }

    fn params<'s>(&self, scene: &'s Scene) -> Result<&'s dyn Params, SceneError> {
        match self.owner {
            ParamOwner::Node(id, part) => {
                let node = scene.node(id).ok_or(SceneError::NoNode(id))?;
                part.params(node).ok_or_else(|| self.no_part())
            }
            ParamOwner::Material(id) => Ok(&**scene.material(id).ok_or(SceneError::NoMaterial(id))?),
            ParamOwner::Environment => Ok(&scene.environment),
            ParamOwner::Display => Ok(&scene.display),
        }
    }
}
