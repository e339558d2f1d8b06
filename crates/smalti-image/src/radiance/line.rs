//! A line of RGBE pixels: flat, or with run lengths of the old or the new kind. After Radiance's `color.c`.

use crate::codec::Broken;

/// Four bytes: red, green, blue and the exponent that they share.
pub(super) type Rgbe = [u8; 4];

/// Lengths of lines that may have run lengths of the new kind.
const NEW_KIND: std::ops::RangeInclusive<usize> = 8..=0x7fff;

/// Fills `line` from the bytes at the start of `rest`, which it takes away.
pub(super) fn read(line: &mut [Rgbe], rest: &mut &[u8]) -> Result<(), Broken> {
    match rest.first_chunk() {
        Some(&[2, 2, high @ 0..128, low]) if NEW_KIND.contains(&line.len()) => {
            if usize::from(high) << 8 | usize::from(low) != line.len() {
                return Err("the length of a line in it is not that of the header".into());
            }
            *rest = &rest[4..];
            (0..4).try_for_each(|channel| read_channel(line, channel, rest))
        }
        _ => read_pixels(line, rest),
    }
}

/// A channel of all pixels: counts up to 128 are of bytes that follow, above of repetitions of the one that follows.
fn read_channel(line: &mut [Rgbe], channel: usize, rest: &mut &[u8]) -> Result<(), Broken> {
    let mut at = 0;
    while at < line.len() {
        let [count] = take(rest)?;
        let repeats = count > 128;
        let count = usize::from(if repeats { count - 128 } else { count });
        let run = line.get_mut(at..at + count).filter(|run| !run.is_empty()).ok_or(OVERLONG)?;
        let repeated = if repeats { take::<1>(rest)? } else { [0] };
        for pixel in run {
            [pixel[channel]] = if repeats { repeated } else { take(rest)? };
        }
        at += count;
    }
    Ok(())
}

const OVERLONG: &str = "a run in it is longer than its line, or empty";

/// Whole pixels; 1, 1, 1 and a count repeats the one before, and each further count is of 256 times as many.
fn read_pixels(line: &mut [Rgbe], rest: &mut &[u8]) -> Result<(), Broken> {
    let (mut at, mut shift) = (0, 0);
    while at < line.len() {
        let pixel: Rgbe = take(rest)?;
        let [1, 1, 1, count] = pixel else {
            line[at] = pixel;
            (at, shift) = (at + 1, 0);
            continue;
        };
        let before = *at.checked_sub(1).and_then(|before| line.get(before)).ok_or("a line in it begins with a run")?;
        let count = usize::from(count).checked_shl(shift).ok_or(OVERLONG)?;
        let end = at.checked_add(count).ok_or(OVERLONG)?;
        line.get_mut(at..end).ok_or(OVERLONG)?.fill(before);
        (at, shift) = (end, shift + 8);
    }
    Ok(())
}

fn take<const N: usize>(rest: &mut &[u8]) -> Result<[u8; N], Broken> {
    let (taken, left) = rest.split_first_chunk().ok_or("it is cut short")?;
    *rest = left;
    Ok(*taken)
}

#[cfg(test)]
mod tests {
    use super::*;

    const A: Rgbe = [10, 20, 30, 128];
    const B: Rgbe = [2, 2, 3, 129];

    /// The line of `length` pixels, and the bytes that are left.
    fn line(length: usize, parts: &[&[u8]]) -> Result<(Vec<Rgbe>, Vec<u8>), Broken> {
        let bytes = parts.concat();
        let (mut line, mut rest) = (vec![[0; 4]; length], bytes.as_slice());
        read(&mut line, &mut rest)?;
        Ok((line, rest.to_vec()))
    }

    #[test]
    fn flat_pixels_are_themselves() {
        assert_eq!(line(3, &[&A, &B, &A, b"rest"]).unwrap(), (vec![A, B, A], b"rest".to_vec()));
        // Too short for run lengths of the new kind, as B seems to begin one.
        assert_eq!(line(7, &[&B, &A, &A, &A, &A, &A, &A]).unwrap().0, [B, A, A, A, A, A, A]);
        // 128 and above are no length.
        assert_eq!(line(8, &[&[2, 2, 128, 9], &A.repeat(7)]).unwrap().0[..2], [[2, 2, 128, 9], A]);
    }

    #[test]
    fn old_runs_repeat_the_pixel_before() {
        assert_eq!(line(5, &[&A, &[1, 1, 1, 3], &B]).unwrap().0, [A, A, A, A, B]);
        // 0x0102 repetitions take two counts, the lower one first; another pixel begins anew.
        let (found, _) = line(1 + 0x102 + 2, &[&A, &[1, 1, 1, 2], &[1, 1, 1, 1], &B, &[1, 1, 1, 1]]).unwrap();
        assert_eq!(found, [vec![A; 0x103], vec![B; 2]].concat());
        assert!(line(3, &[&[1, 1, 1, 3], &A]).is_err());
        assert!(line(3, &[&A, &[1, 1, 1, 3]]).is_err());
        assert!(line(3, &[&A, &[[1, 1, 1, 0]; 20].concat()]).is_err());
    }

    #[test]
    fn new_runs_are_of_channels() {
        let channel = [131, 7, 3, 1, 2, 3, 130, 9];
        let (found, rest) = line(8, &[&[2, 2, 0, 8], &channel.repeat(4), &A]).unwrap();
        assert_eq!(found, [7, 7, 7, 1, 2, 3, 9, 9].map(|value| [value; 4]));
        assert_eq!(rest, A);
        for wrong in [&[137, 7][..], &[0, 0], &[9, 1, 2, 3, 4, 5, 6, 7, 8, 9], &[128 + 8]] {
            assert!(line(8, &[&[2, 2, 0, 8], wrong]).is_err(), "{wrong:?}");
        }
        assert!(line(8, &[&[2, 2, 0, 9], &[137, 7].repeat(4)]).unwrap_err().to_string().contains("header"));
    }
}
