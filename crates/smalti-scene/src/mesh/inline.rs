//! A mesh that is written out in the scene file: `vertices` and `faces`.

use super::soup::Soup;
use crate::document::Section;
use crate::error::{Fault, Result};

/// Reads `vertices` and `faces`; a face has three corners or more.
pub fn read(section: &Section) -> Result<Soup> {
    let vertices = section.need("vertices")?.list()?.map(|node| node.vector()).collect::<Result<Vec<_>>>()?;
    let faces = section.need("faces")?;
    let mut soup = Soup { vertices, ..Soup::default() };
    for face in faces.list()? {
        let corners = face.list()?.map(|node| node.whole(0, u32::MAX.into())).collect::<Result<Vec<_>>>()?;
        let corners: Vec<i64> = corners.into_iter().map(|corner| corner as i64).collect();
        // Files have such faces by chance; what is written by hand is a slip.
        if corners.len() < 3 {
            let wrong = format!("a face has {} vertices: it needs at least 3", corners.len());
            return Err(Fault::at(face.span(), wrong, ""));
        }
        soup.add_face(&corners, 0).map_err(|wrong| Fault::at(face.span(), wrong, ""))?;
    }
    if soup.faces.is_empty() {
        let wrong = if soup.tally.short > 0 { "has no face with three different corners" } else { "is empty" };
        return Err(faces.fault(&format!("{wrong}: the mesh has no triangles"), ""));
    }
    Ok(soup)
}
