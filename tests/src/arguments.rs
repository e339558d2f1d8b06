//! What campaigns are asked for: flags with a number each.

use anyhow::{Context, Result, bail};

/// The numbers of these flags as typed, or else as given here.
///
/// # Errors
/// A flag that is not among them, or one without a number.
pub fn numbers<const N: usize>(flags: [(&str, u64); N]) -> Result<[u64; N]> {
    let mut values = flags.map(|(_, value)| value);
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let Some(place) = flags.iter().position(|(flag, _)| *flag == word) else { bail!("unknown: {word}") };
        values[place] = words.next().with_context(|| format!("{word} needs a value"))?.parse()?;
    }
    Ok(values)
}
