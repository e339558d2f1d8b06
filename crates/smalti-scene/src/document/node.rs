//! One value of the document under the name of its key, and the ways to read it.

use std::ops::Range;

use glam::DVec3;
use smalti_core::scene::world::Rgb;
use toml::Spanned;
use toml::de::DeValue;

use super::{Bounds, advice};
use crate::error::{Fault, Result};

/// A value and the key that it belongs to (for a component: the key of the list).
#[derive(Clone, Copy)]
pub struct Node<'d> {
    /// The key.
    pub name: &'d str,
    value: &'d Spanned<DeValue<'d>>,
}

impl<'d> Node<'d> {
    /// The value of the key `name`.
    pub fn new(name: &'d str, value: &'d Spanned<DeValue<'d>>) -> Self {
        Self { name, value }
    }

    /// Bytes of the document that the value takes.
    pub fn span(self) -> Range<usize> {
        self.value.span()
    }

    /// The value of `name` in this table, if it is there.
    pub fn entry(self, name: &'d str) -> Option<Node<'d>> {
        self.value().as_table()?.get(name).map(|value| Node::new(name, value))
    }

    /// The value.
    pub fn value(self) -> &'d DeValue<'d> {
        self.value.get_ref()
    }

    /// A mistake in this value: `name` and what is wrong with it, and what stands there.
    pub fn fault(self, wrong: &str, label: impl Into<String>) -> Box<Fault> {
        Fault::at(self.span(), format!("`{}` {wrong}", self.name), label)
    }

    /// A number within `bounds`.
    pub fn number(self, bounds: Bounds) -> Result<f64> {
        let number = self.parsed_number().ok_or_else(|| self.not_a_number())?;
        if bounds.allow(number) {
            return Ok(number);
        }
        let says = if number.is_finite() { bounds.says } else { "finite" };
        Err(self.fault(&format!("must be {says}"), self.kind()))
    }

    fn parsed_number(self) -> Option<f64> {
        match self.value() {
            // As f64, not as i64: an integer of any length is a good coordinate.
            DeValue::Integer(integer) if integer.radix() == 10 => integer.as_str().parse().ok(),
            DeValue::Integer(_) => self.integer().map(|integer| integer as f64),
            DeValue::Float(float) => float.as_str().parse().ok(),
            _ => None,
        }
    }

    fn not_a_number(self) -> Box<Fault> {
        let fault = self.fault("must be a number", self.kind());
        match self.value() {
            DeValue::String(text) if text.trim().parse::<f64>().is_ok() => {
                fault.help(format!("write it without quotes: {}", text.trim()))
            }
            _ => fault,
        }
    }

    /// A list of `N` numbers within `bounds`.
    pub fn numbers<const N: usize>(self, bounds: Bounds) -> Result<[f64; N]> {
        let items = self.exactly(N, "numbers")?;
        let mut numbers = [0.0; N];
        for (number, item) in numbers.iter_mut().zip(items) {
            *number = item.number(bounds)?;
        }
        Ok(numbers)
    }

    /// A point, a direction or a displacement.
    pub fn vector(self) -> Result<DVec3> {
        self.numbers::<3>(Bounds::COORDINATE).map(DVec3::from_array)
    }

    /// Three numbers, or one number for all three.
    pub fn triple(self, bounds: Bounds) -> Result<Rgb> {
        match self.value() {
            DeValue::Integer(_) | DeValue::Float(_) => Ok([self.number(bounds)?; 3]),
            _ => self.numbers(bounds),
        }
    }

    /// A whole number from `low` to `high`.
    pub fn whole(self, low: u64, high: u64) -> Result<u64> {
        let whole = self.integer().and_then(|integer| u64::try_from(integer).ok());
        whole
            .filter(|whole| (low..=high).contains(whole))
            .ok_or_else(|| self.fault(&format!("must be a whole number from {low} to {high}"), self.kind()))
    }

    /// A whole number that fits 32 bits, at least `low`.
    pub fn count(self, low: u32) -> Result<u32> {
        self.whole(low.into(), u32::MAX.into()).map(|whole| whole as u32)
    }

    fn integer(self) -> Option<i128> {
        let integer = self.value().as_integer()?;
        i128::from_str_radix(integer.as_str(), integer.radix()).ok()
    }

    /// `true` or `false`.
    pub fn truth(self) -> Result<bool> {
        self.value().as_bool().ok_or_else(|| self.fault("must be true or false", self.kind()))
    }

    /// Text in quotes.
    pub fn text(self) -> Result<&'d str> {
        self.value().as_str().ok_or_else(|| self.fault("must be text in quotes", self.kind()))
    }

    /// One of several things by its name.
    pub fn choice<T: Copy>(self, choices: &[(&str, T)]) -> Result<T> {
        let name = self.text()?;
        let known = || choices.iter().map(|(known, _)| *known);
        choices.iter().find(|(known, _)| *known == name).map(|(_, choice)| *choice).ok_or_else(|| {
            Fault::at(self.span(), format!("unknown {} `{name}`", self.name), "").help(advice(name, known()))
        })
    }

    /// A list.
    pub fn list(self) -> Result<impl ExactSizeIterator<Item = Node<'d>> + Clone> {
        let items = self.value().as_array().ok_or_else(|| self.fault("must be a list in brackets", self.kind()))?;
        Ok(items.iter().map(move |item| Node::new(self.name, item)))
    }

    /// A list of exactly `length` items, which are called `what`.
    pub fn exactly(self, length: usize, what: &str) -> Result<impl ExactSizeIterator<Item = Node<'d>> + Clone> {
        let wrong = format!("must be a list of {length} {what}");
        let items = self.list().map_err(|_| self.fault(&wrong, self.kind()))?;
        let found = items.len();
        if found == length { Ok(items) } else { Err(self.fault(&wrong, format!("{found} {what}"))) }
    }

    /// What stands there, in the user's words.
    pub fn kind(self) -> String {
        match self.value() {
            DeValue::String(_) => "text".to_owned(),
            DeValue::Integer(integer) => integer.to_string(),
            DeValue::Float(float) => float.to_string(),
            DeValue::Boolean(truth) => truth.to_string(),
            DeValue::Datetime(_) => "a date".to_owned(),
            DeValue::Array(_) => "a list".to_owned(),
            DeValue::Table(_) => "a table".to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reads the value of `x = TEXT`.
    fn with<T>(text: &str, read: impl Fn(Node<'_>) -> Result<T>) -> Result<T> {
        let text = format!("x = {text}\n");
        let document = crate::document::parse(&text)?;
        read(Node::new("x", &document.get_ref()["x"]))
    }

    #[test]
    fn numbers_are_read_as_f64() {
        let number = |text| with(text, |node| node.number(Bounds::COORDINATE)).unwrap();
        assert_eq!(number("0.1"), 0.1);
        assert_eq!(number("-1_000"), -1000.0);
        assert_eq!(number("0x10"), 16.0);
        assert_eq!(number("123456789012345678901234567890"), 123456789012345678901234567890.0);
        for bad in ["nan", "-inf", "1e999", "'1'", "true", "[1]"] {
            assert!(with(bad, |node| node.number(Bounds::COORDINATE)).is_err(), "{bad}");
        }
        let help = with("'90'", |node| node.number(Bounds::COORDINATE)).unwrap_err().help;
        assert_eq!(help.unwrap(), "write it without quotes: 90");
    }

    #[test]
    fn lists_must_have_their_length() {
        assert_eq!(with("[1, 2, 3]", |node| node.vector()).unwrap(), DVec3::new(1.0, 2.0, 3.0));
        let fault = with("[1, 2]", |node| node.vector()).unwrap_err();
        assert_eq!((fault.title.as_str(), fault.label.as_str()), ("`x` must be a list of 3 numbers", "2 numbers"));
        assert_eq!(with("0.5", |node| node.triple(Bounds::FRACTION)).unwrap(), [0.5; 3]);
    }

    #[test]
    fn whole_numbers_keep_their_range() {
        assert_eq!(with("5", |node| node.count(1)).unwrap(), 5);
        assert_eq!(with("18446744073709551615", |node| node.whole(0, u64::MAX)).unwrap(), u64::MAX);
        for bad in ["0", "-1", "5.0", "4294967296", "99999999999999999999999999999999999999999"] {
            assert!(with(bad, |node| node.count(1)).is_err(), "{bad}");
        }
    }

    #[test]
    fn a_choice_answers_with_the_nearest_name() {
        let choice = |text| with(text, |node| node.choice(&[("path", 1), ("whitted", 2)]));
        assert_eq!(choice("'whitted'").unwrap(), 2);
        assert_eq!(choice("'whited'").unwrap_err().help.unwrap(), "did you mean `whitted`?");
    }
}
