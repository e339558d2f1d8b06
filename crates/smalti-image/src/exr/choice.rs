//! Which channels of an OpenEXR file are the picture.
//!
//! A channel's name is that of its layer, a dot, and what it holds; the layer of a part of a file with several parts has
//! the part's name in front. A layer is a picture if it has R, G and B, or Y with RY and BY, or Y alone (a Y beside an X
//! is of a vector); upper or lower case. The layer without a name comes first, then one called Combined, as Blender
//! calls it, then the others, of each kind those in colour first; of equals the first in the file.

use ::exr::meta::header::Header;

use crate::codec::Broken;

/// The channels that are read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Choice {
    /// Number of the part.
    pub part: usize,
    /// Which of its channels.
    pub colour: Colour,
    /// Which layer was chosen, if there was a choice.
    pub note: Option<String>,
}

/// Numbers of channels, and their meaning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Colour {
    /// Red, green, blue.
    Rgb([usize; 3]),
    /// Luminance, and what red and blue differ from it, as parts of it.
    Chroma([usize; 3]),
    /// Luminance.
    Grey(usize),
}

impl Colour {
    /// The channel behind each value of a pixel.
    pub fn channels(self) -> [usize; 3] {
        match self {
            Colour::Rgb(channels) | Colour::Chroma(channels) => channels,
            Colour::Grey(channel) => [channel; 3],
        }
    }
}

/// Channels of a part that share a layer.
struct Layer {
    part: usize,
    /// Empty for the layer without a name.
    name: String,
    /// What each holds, and its number.
    channels: Vec<(String, usize)>,
}

/// Chooses by the headers of all parts.
pub(super) fn choose(headers: &[Header]) -> Result<Choice, Broken> {
    let layers = layers(headers);
    let mut pictures: Vec<(&Layer, Colour)> =
        layers.iter().filter_map(|layer| Some((layer, layer.colour()?))).collect();
    pictures.sort_by_key(|(layer, colour)| (layer.rank(), kind(*colour)));
    let (first, colour) = *pictures.first().ok_or_else(|| Broken::from(nothing(headers)))?;
    let others: Vec<&str> = pictures[1..].iter().map(|(layer, _)| layer.shown()).collect();
    let note =
        (!others.is_empty()).then(|| format!("its layer {} is read; others are {}", first.shown(), list(&others)));
    Ok(Choice { part: first.part, colour, note })
}

/// Colour before grey.
fn kind(colour: Colour) -> u8 {
    match colour {
        Colour::Rgb(_) => 0,
        Colour::Chroma(_) => 1,
        Colour::Grey(_) => 2,
    }
}

fn layers(headers: &[Header]) -> Vec<Layer> {
    let mut layers: Vec<Layer> = Vec::new();
    for (part, header) in headers.iter().enumerate().filter(|(_, header)| !header.deep) {
        for (number, channel) in header.channels.list.iter().enumerate() {
            let name = channel.name.to_string();
            let (layer, holds) = name.rsplit_once('.').unwrap_or(("", &name));
            let name = match headers.len() {
                1 => layer.to_owned(),
                _ => in_part(header, layer),
            };
            let holds = (holds.to_owned(), number);
            match layers.iter_mut().find(|layer| layer.part == part && layer.name == name) {
                Some(layer) => layer.channels.push(holds),
                None => layers.push(Layer { part, name, channels: vec![holds] }),
            }
        }
    }
    layers
}

/// The name of a layer with that of its part, which some programs write in both places.
fn in_part(header: &Header, layer: &str) -> String {
    let part = header.own_attributes.layer_name.as_ref().map(ToString::to_string).unwrap_or_default();
    match (part.as_str(), layer) {
        ("", only) | (only, "") => only.to_owned(),
        (part, layer) if layer.starts_with(part) => layer.to_owned(),
        (part, layer) => format!("{part}.{layer}"),
    }
}

impl Layer {
    /// The layer's name, or words for the one without.
    fn shown(&self) -> &str {
        if self.name.is_empty() { "(without a name)" } else { &self.name }
    }

    fn rank(&self) -> u8 {
        let is_combined = || self.name.split('.').any(|word| word.eq_ignore_ascii_case("combined"));
        match self.name.as_str() {
            "" => 0,
            _ if is_combined() => 1,
            _ => 2,
        }
    }

    fn colour(&self) -> Option<Colour> {
        let all = |names: [&str; 3]| {
            let [a, b, c] = names.map(|name| self.channel(name));
            Some([a?, b?, c?])
        };
        let grey = || self.channel("Y").filter(|_| ["X", "RY", "BY"].iter().all(|name| self.channel(name).is_none()));
        let rgb = all(["R", "G", "B"]).or_else(|| all(["red", "green", "blue"])).map(Colour::Rgb);
        rgb.or_else(|| all(["Y", "RY", "BY"]).map(Colour::Chroma)).or_else(|| grey().map(Colour::Grey))
    }

    /// The channel that holds `what`, rather in this case than in another.
    fn channel(&self, what: &str) -> Option<usize> {
        let found = |same: fn(&str, &str) -> bool| self.channels.iter().find(|(holds, _)| same(holds, what));
        found(|a, b| a == b).or_else(|| found(str::eq_ignore_ascii_case)).map(|(_, number)| *number)
    }
}

/// Why there is no picture in a file.
fn nothing(headers: &[Header]) -> String {
    let named = |header: &Header| header.channels.list.iter().map(|c| c.name.to_string()).collect::<Vec<_>>();
    let deep = headers.iter().any(|header| header.deep);
    let names: Vec<String> = headers.iter().flat_map(named).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let note = if deep { "; deep data is not read" } else { "" };
    format!("it has neither R, G and B nor Y; its channels are {}{note}", list(&names))
}

/// Up to a dozen names.
fn list(names: &[&str]) -> String {
    const MOST: usize = 12;
    let shown = names.iter().take(MOST).map(|name| name.escape_debug().to_string()).collect::<Vec<_>>().join(", ");
    match names.len().saturating_sub(MOST) {
        0 => shown,
        more => format!("{shown} and {more} more"),
    }
}
