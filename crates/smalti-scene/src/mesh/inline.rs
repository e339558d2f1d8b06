//! A mesh that is written out in the scene file: `vertices` and `faces`.

use super::soup::Soup;
use crate::document::Section;
use crate::error::Result;

/// Reads `vertices` and `faces`; a face may have more than three corners if it is convex.
pub fn read(section: &Section) -> Result<Soup> {
    let vertices = section.need("vertices")?.list()?.map(|node| node.vector()).collect::<Result<Vec<_>>>()?;
    let faces = section.need("faces")?;
    let mut soup = Soup { vertices, faces: Vec::new() };
    for face in faces.list()? {
        let corners = face.list()?.map(|node| node.whole(0, u32::MAX.into())).collect::<Result<Vec<_>>>()?;
        let corners: Vec<i64> = corners.into_iter().map(|corner| corner as i64).collect();
        soup.add_face(&corners, 0).map_err(|wrong| crate::error::Fault::at(face.span(), wrong, ""))?;
    }
    if soup.faces.is_empty() {
        return Err(faces.fault("is empty: the mesh has no triangles", ""));
    }
    Ok(soup)
}
