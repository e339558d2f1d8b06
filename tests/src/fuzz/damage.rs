//! Damage to an input: what a disk, an editor or a tired user does to a file.

use rand_core::Rng;
use rand_xoshiro::Xoshiro128PlusPlus;

/// What stands in files, and what should not.
const TOKENS: &[&[u8]] = &[
    b"nan",
    b"-inf",
    b"1e999",
    b"0",
    b"-1",
    b"1.0",
    b"[",
    b"]",
    b"[[",
    b"{}",
    b"\"",
    b"'''",
    b"=",
    b".",
    b",",
    b"\n",
    b"\r\n",
    b"\t",
    b"#",
    "é".as_bytes(),
    b"\x1b[31m",
    "\u{200b}".as_bytes(),
    b"camera",
    b"light",
    b"material",
    b"99999999999999999999",
    b"true",
    b"1979-05-27",
    b"\0",
    b"\xff\xff\xff\xff",
    b"\0\0\xc0\x7f",
    b"\x80",
    b"4294967295",
    b"65536",
];

/// Most that an input is made longer by at once.
const LONGEST: usize = 60;

/// `bytes` with one part removed, replaced by a token or by another part of itself, or with some bits turned.
pub fn damage(bytes: &[u8], random: &mut Xoshiro128PlusPlus) -> Vec<u8> {
    let mut place = |end: usize| random.next_u32() as usize % (end + 1);
    let start = place(bytes.len());
    let end = (start + place(12)).min(bytes.len());
    let from = place(bytes.len());
    let part = &bytes[from..(from + place(LONGEST)).min(bytes.len())];
    let middle = match place(3) {
        0 => Vec::new(),
        1 => TOKENS[place(TOKENS.len() - 1)].to_vec(),
        2 => part.to_vec(),
        _ => bytes[start..end].iter().map(|byte| byte ^ (1 << place(7))).collect(),
    };
    [&bytes[..start], &middle, &bytes[end..]].concat()
}
