//! Instances of meshes (EXT_mesh_gpu_instancing).

use glam::{Mat4, Quat, Vec3};
use gltf::accessor::Dimensions;
use gltf::{Accessor, Document, Node};

use super::reader::Reader;
use crate::error::SceneError;

/// Maximum number of instances of a node's mesh.
const MAX_INSTANCES: usize = 1 << 20;

impl Reader<'_> {
    /// Returns the transforms of the instances of a node's mesh, in the node's frame; one without change if it has
    /// none. Skins have one instance, since their joints say where they are.
    pub(super) fn instances(&self, document: &Document, node: &Node) -> Result<Vec<Mat4>, SceneError> {
        let stated = node.extension_value("EXT_mesh_gpu_instancing").filter(|_| node.skin().is_none());
        let Some(attributes) = stated.map(|extension| &extension["attributes"]) else {
            return Ok(vec![Mat4::IDENTITY]);
        };
        let damaged = |what: &str| self.damaged(format!("the instances of node {} {what}", node.index()));
        let accessor = |name: &str| -> Result<Option<Accessor>, SceneError> {
            let Some(index) = attributes.get(name) else { return Ok(None) };
            let accessor = index.as_u64().and_then(|i| document.accessors().nth(usize::try_from(i).ok()?));
            let accessor = accessor.ok_or_else(|| damaged("name an accessor that does not exist"))?;
            if accessor.count() > MAX_INSTANCES {
                return Err(SceneError::too_large(self.path, MAX_INSTANCES, "instances of a mesh"));
            }
            Ok(Some(accessor))
        };
        let [places, turns, sizes] = [accessor("TRANSLATION")?, accessor("ROTATION")?, accessor("SCALE")?];
        let counts = [&places, &turns, &sizes].map(|a| a.as_ref().map(Accessor::count));
        let Some(count) = counts.into_iter().flatten().next() else { return Ok(vec![Mat4::IDENTITY]) };
        if counts.into_iter().flatten().any(|other| other != count) {
            return Err(damaged("have attributes of different length"));
        }
        let vectors = |accessor: Option<Accessor>, otherwise: f32| match accessor {
            Some(accessor) => self.floats::<3>(&accessor, &[Dimensions::Vec3]),
            None => Ok(vec![[otherwise; 3]; count]),
        };
        let (places, sizes) = (vectors(places, 0.0)?, vectors(sizes, 1.0)?);
        let turns = match turns {
            Some(accessor) => self.floats::<4>(&accessor, &[Dimensions::Vec4])?,
            None => vec![Quat::IDENTITY.to_array(); count],
        };
        let matrix = |((place, turn), size): (([f32; 3], [f32; 4]), [f32; 3])| {
            let turn = Quat::from_array(turn);
            let turn =
                if turn.length() > 0.0 && turn.is_finite() { turn.normalize() } else { Quat::IDENTITY };
            Mat4::from_scale_rotation_translation(Vec3::from(size), turn, Vec3::from(place))
        };
        Ok(places.into_iter().zip(turns).zip(sizes).map(matrix).collect())
    }
}
