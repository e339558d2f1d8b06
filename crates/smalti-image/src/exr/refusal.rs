//! Why the library refuses the header of an OpenEXR file, as far as a look at the header tells.

/// Bytes of the magic number and the version, which the attributes follow.
const PREAMBLE: usize = 8;

/// Compressions, numbered from 0, that the library knows.
const COMPRESSIONS: u8 = 12;

/// The bit of the version, in its second byte, of files with deep data.
const DEEP: u8 = 0x08;

/// The reason for which a header is refused, in words.
pub(super) fn reason(bytes: &[u8]) -> &'static str {
    if bytes.get(5).is_some_and(|flags| flags & DEEP != 0) {
        return "it holds deep data, which is not read";
    }
    let attributes = attributes(bytes);
    let channels = || attributes.iter().filter(|(name, _)| *name == b"channels").flat_map(|(_, value)| channels(value));
    let compressions = attributes.iter().filter(|(name, _)| *name == b"compression").flat_map(|(_, value)| *value);
    let is_chroma = |name: &[u8]| name.rsplit(|&byte| byte == b'.').next().is_some_and(|holds| holds == b"RY");
    match channels().any(|(_, is_sparse)| is_sparse) {
        true if channels().any(|(name, _)| is_chroma(name)) => {
            "its colours are luminance and chroma (Y, RY, BY) of lower resolution, which is not read"
        }
        true => "its channels differ in resolution, which is not read",
        false if compressions.copied().any(|number| number >= COMPRESSIONS) => "its compression is not known",
        false => "its header is damaged or cut short",
    }
}

/// Names and values of the attributes of all parts, up to the end of the header or to what is no attribute.
fn attributes(bytes: &[u8]) -> Vec<(&[u8], &[u8])> {
    let mut rest = bytes.get(PREAMBLE..).unwrap_or_default();
    let mut found = Vec::new();
    while let Some((name, behind)) = text(rest) {
        rest = behind;
        // An empty name ends a part; a second one ends the header.
        if name.is_empty() {
            continue;
        }
        let Some((value, behind)) = text(rest).and_then(|(_, behind)| sized(behind)) else { break };
        found.push((name, value));
        rest = behind;
        if rest.starts_with(&[0, 0]) {
            break;
        }
    }
    found
}

/// A text that a zero ends, and what follows.
fn text(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let end = bytes.iter().take(256).position(|&byte| byte == 0)?;
    Some((&bytes[..end], &bytes[end + 1..]))
}

/// A value behind its size, and what follows.
fn sized(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let (size, behind) = bytes.split_first_chunk()?;
    behind.split_at_checked(u32::from_le_bytes(*size) as usize)
}

/// Names of channels, and whether each has fewer samples than the image has pixels.
fn channels(value: &[u8]) -> Vec<(&[u8], bool)> {
    let mut found = Vec::new();
    let mut rest = value;
    while let Some((name, behind)) = text(rest).filter(|(name, _)| !name.is_empty()) {
        // Type and linearity, four bytes each; columns and rows that a sample is of.
        let Some((about, behind)) = behind.split_at_checked(16) else { break };
        found.push((name, about[8..] != [1, 0, 0, 0, 1, 0, 0, 0]));
        rest = behind;
    }
    found
}
