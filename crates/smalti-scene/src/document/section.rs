//! A table of the document whose keys are known: unknown ones are refused when it is opened, missing ones when asked.

use std::ops::Range;

use toml::de::{DeTable, DeValue};

use super::{Node, advice};
use crate::error::{Fault, Result};

/// A key that a table may have, as it would be written.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    name: &'static str,
    example: &'static str,
}

/// The key `name`, with an example of its value and what it means.
pub const fn key(name: &'static str, example: &'static str) -> Key {
    Key { name, example }
}

/// A table whose keys are all known.
#[derive(Clone)]
pub struct Section<'d> {
    /// The table as the user writes it: `[[sphere]]`.
    pub heading: String,
    /// Where it starts in the document.
    pub span: Range<usize>,
    entries: &'d DeTable<'d>,
    keys: &'static [Key],
}

impl<'d> Section<'d> {
    /// Opens the table `node`; only `keys` may stand in it.
    pub fn open(node: Node<'d>, heading: impl Into<String>, keys: &'static [Key]) -> Result<Self> {
        let heading = heading.into();
        match node.value().as_table() {
            Some(entries) => Self::of_entries(entries, heading, node.span(), keys),
            None if heading.contains('[') => Err(no_table(node, &heading)),
            None => {
                let inside: Vec<String> = keys.iter().map(|key| format!("{} = {}", key.name, key.example)).collect();
                let example = format!("write `{} = {{ {} }}`", node.name, inside.join(", "));
                Err(node.fault("must be a table", node.kind()).help(example))
            }
        }
    }

    /// The table of `entries`; only `keys` may stand in it.
    pub fn of_entries(
        entries: &'d DeTable<'d>,
        heading: String,
        span: Range<usize>,
        keys: &'static [Key],
    ) -> Result<Self> {
        let known = || keys.iter().map(|key| key.name);
        let unknown = entries.iter().filter(|(name, _)| !known().any(|key| key == name.get_ref()));
        match unknown.min_by_key(|(name, _)| name.span().start) {
            None => Ok(Self { heading, span, entries, keys }),
            Some((name, value)) => {
                let table =
                    value.get_ref().is_table() || value.get_ref().get(0).is_some_and(|item| item.get_ref().is_table());
                let what = if table { "table" } else { "key" };
                let name_is = name.get_ref();
                Err(Fault::at(name.span(), format!("unknown {what} `{name_is}` in {heading}"), "")
                    .help(advice(name_is, known())))
            }
        }
    }

    /// The value of `name`, if it is there.
    pub fn find(&self, name: &'static str) -> Option<Node<'d>> {
        debug_assert!(self.keys.iter().any(|key| key.name == name), "{name} is not a key of {}", self.heading);
        self.entries.get(name).map(|value| Node::new(name, value))
    }

    /// The value of `name`, which must be there.
    pub fn need(&self, name: &'static str) -> Result<Node<'d>> {
        self.find(name).ok_or_else(|| {
            let example = self.keys.iter().find(|key| key.name == name).map_or("", |key| key.example);
            Fault::at(self.span.clone(), format!("`{name}` is missing in {}", self.heading), "")
                .help(format!("add for example `{name} = {example}`"))
        })
    }

    /// Reads `name`, if it is there.
    pub fn read<T>(&self, name: &'static str, read: impl FnOnce(Node<'d>) -> Result<T>) -> Result<Option<T>> {
        self.find(name).map(read).transpose()
    }

    /// The tables of the list `name` (`[[name]]`), in file order; `keys` may stand in each.
    pub fn items(&self, name: &'static str, heading: &str, keys: &'static [Key]) -> Result<Vec<Section<'d>>> {
        let Some(node) = self.find(name) else { return Ok(Vec::new()) };
        if !matches!(node.value(), DeValue::Array(_)) {
            let fault = node.fault("must be a list of tables", node.kind());
            return Err(fault.help(format!("write {heading} with two brackets: there may be several")));
        }
        node.list()?.map(|item| Section::open(item, heading, keys)).collect()
    }

    /// The entries with names of the user's choice, in file order. (Keys are not checked: open with those.)
    pub fn named(node: Node<'d>, heading: &str) -> Result<Vec<Node<'d>>> {
        let entries = node.value().as_table().ok_or_else(|| no_table(node, heading))?;
        let mut entries: Vec<_> = entries.iter().collect();
        entries.sort_by_key(|(name, _)| name.span().start);
        Ok(entries.into_iter().map(|(name, value)| Node::new(name.get_ref(), value)).collect())
    }
}

fn no_table(node: Node, heading: &str) -> Box<Fault> {
    node.fault("must be a table", node.kind()).help(format!("write {heading} and its keys below"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const KEYS: &[Key] = &[key("centre", "[0, 0, 0]"), key("radius", "1"), key("ball", "")];

    fn open(text: &str) -> Result<Vec<String>> {
        let document = crate::document::parse(text)?;
        let section = Section::of_entries(document.get_ref(), "the file".to_owned(), 0..0, KEYS)?;
        section.need("radius")?;
        Ok(section.items("ball", "`[[ball]]`", KEYS)?.into_iter().map(|ball| ball.heading).collect())
    }

    #[test]
    fn the_first_unknown_key_is_reported_in_file_order() {
        let fault = open("radius = 1\nzentre = 2\nabc = 3\n").unwrap_err();
        assert_eq!(fault.title, "unknown key `zentre` in the file");
        assert_eq!(fault.help.unwrap(), "did you mean `centre`?");
    }

    #[test]
    fn a_missing_key_is_answered_with_an_example() {
        assert_eq!(open("centre = 1\n").unwrap_err().help.unwrap(), "add for example `radius = 1`");
    }

    #[test]
    fn a_list_needs_two_brackets() {
        assert_eq!(open("radius = 1\n[[ball]]\n[[ball]]\n").unwrap().len(), 2);
        assert!(open("radius = 1\n[ball]\n").unwrap_err().help.unwrap().contains("`[[ball]]` with two brackets"));
        assert!(open("radius = 1\nball = [1]\n").unwrap_err().title.contains("must be a table"));
    }
}
