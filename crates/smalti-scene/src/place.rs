//! Where in the scene file each surface stands: for the order in which they were written, and for messages.

use smalti_core::scene::world::Order;
use smalti_core::scene::{Origin, World};

use crate::document::{Node, Section};
use crate::error::Result;

/// Bytes of the document before each surface, in the order of the world's lists.
#[derive(Clone, Debug, Default)]
pub struct Places {
    polygons: Vec<usize>,
    meshes: Vec<usize>,
    spheres: Vec<usize>,
}

impl Places {
    /// Those of everything that `root` lists; it has been read without a mistake.
    pub fn of(root: &Section) -> Result<Self> {
        let light = root.find("light");
        let lights = |name: &'static str| match light.and_then(|light| light.entry(name)) {
            Some(node) => starts(node),
            None => Ok(Vec::new()),
        };
        let surfaces = |name: &'static str| root.find(name).map_or(Ok(Vec::new()), starts);
        let sorted = |lists: [Result<Vec<usize>>; 3]| -> Result<Vec<usize>> {
            let mut all = lists.into_iter().collect::<Result<Vec<_>>>()?.concat();
            all.sort_unstable();
            Ok(all)
        };
        let flat = sorted([surfaces("polygon"), surfaces("quad"), surfaces("triangle")])?;
        let lamps = sorted([lights("quad"), lights("triangle"), Ok(Vec::new())])?;
        Ok(Self {
            polygons: [flat, lamps].concat(),
            meshes: surfaces("mesh")?,
            spheres: [surfaces("sphere")?, lights("sphere")?].concat(),
        })
    }

    /// Forgets what is not kept, as [`Vec::retain`] does with the lists themselves.
    pub fn retain(&mut self, [polygons, spheres, meshes]: [&[bool]; 3]) {
        for (list, kept) in [(&mut self.polygons, polygons), (&mut self.spheres, spheres), (&mut self.meshes, meshes)] {
            let mut kept = kept.iter();
            list.retain(|_| kept.next().copied().unwrap_or(true));
        }
    }

    /// The order of the surfaces.
    pub fn order(&self) -> Order {
        Order { polygons: self.polygons.clone(), meshes: self.meshes.clone() }
    }

    /// How a surface is called in a message on the file `text`: by its kind and line.
    pub fn name(&self, text: &str, world: &World, surface: Origin) -> String {
        let (kind, at) = match surface {
            Origin::Polygon(index) => {
                let kind = match world.polygons[index as usize].vertices.len() {
                    3 => "triangle",
                    4 => "quad",
                    _ => "polygon",
                };
                (kind, self.polygons.get(index as usize))
            }
            Origin::Mesh(index, _) => ("mesh", self.meshes.get(index as usize)),
            Origin::Sphere(index) => ("sphere", self.spheres.get(index as usize)),
        };
        match at.and_then(|at| text.get(..*at)) {
            Some(before) => format!("the {kind} in line {}", before.matches('\n').count() + 1),
            None => format!("the {surface}"),
        }
    }
}

fn starts(node: Node) -> Result<Vec<usize>> {
    Ok(node.list()?.map(|item| item.span().start).collect())
}
