//! Knobs with their values as typed: `--spp 4,16,64 --integrator path,auto`.

use clap::{Arg, ArgAction, ArgMatches, Args, Command, Error, FromArgMatches};
use smalti_core::settings::{Integrator, Settings};

use super::knobs::{KNOBS, Knob};
use super::way::Way;
use crate::exit::Failure;

/// The values of each knob that was named, in the order of the table. The flags come from the table too.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct KnobLists(Vec<(&'static str, Vec<String>)>);

impl KnobLists {
    /// The values of a knob; `None`: it was not named.
    pub fn of(&self, knob: &Knob) -> Option<&[String]> {
        self.0.iter().find(|(name, _)| *name == knob.name).map(|(_, values)| values.as_slice())
    }

    /// Refuses a knob that the preset turns itself.
    pub fn refuse(&self, name: &str, why: &str) -> Result<(), Failure> {
        match self.0.iter().any(|(named, _)| *named == name) {
            true => Err(Failure::user(format!("--{name}: {why}"))),
            false => Ok(()),
        }
    }

    /// Lists as a test or a preset gives them.
    #[cfg(test)]
    pub fn new(lists: &[(&'static str, &[&str])]) -> Self {
        let owned = |values: &[&str]| values.iter().map(ToString::to_string).collect();
        Self(lists.iter().map(|(name, values)| (*name, owned(values))).collect())
    }

    /// Adds a list for a knob that was not named.
    #[must_use]
    pub fn or(mut self, name: &'static str, values: Vec<String>) -> Self {
        if self.of(Knob::named(name)).is_none() {
            self.0.push((name, values));
        }
        self
    }

    /// `way` with the first value of every knob that was named.
    pub fn first(&self, way: &Way) -> Result<Way, Failure> {
        let mut first = way.clone();
        for (name, values) in &self.0 {
            let knob = Knob::named(name);
            values.first().map_or(Ok(()), |value| (knob.set)(&mut first, value)).map_err(Failure::user)?;
        }
        Ok(first)
    }
}

/// A value that a way can take.
fn checked(knob: &Knob, text: &str) -> Result<String, String> {
    let image = Settings { integrator: Integrator::Auto, ..Settings::default() };
    let text = text.trim();
    (knob.set)(&mut Way { image, downsample: 1, threads: 1 }, text)?;
    Ok(text.to_owned())
}

impl Args for KnobLists {
    fn augment_args(command: Command) -> Command {
        let flag = |knob: &'static Knob| {
            let value = move |text: &str| checked(knob, text);
            let arg = Arg::new(knob.name).long(knob.name).help(knob.help).help_heading("Knobs");
            arg.value_name("LIST").action(ArgAction::Append).value_delimiter(',').value_parser(value)
        };
        command.args(KNOBS.iter().map(flag))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for KnobLists {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, Error> {
        let typed = |knob: &Knob| Some((knob.name, matches.get_many(knob.name)?.cloned().collect()));
        Ok(Self(KNOBS.iter().filter_map(typed).collect()))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(line: &str) -> Result<KnobLists, Error> {
        let command = KnobLists::augment_args(Command::new("study"));
        KnobLists::from_arg_matches(&command.try_get_matches_from(line.split(' '))?)
    }

    #[test]
    fn lists_are_read_in_the_order_of_the_table() {
        let lists = read("study --spp 4,16 --size 8x8,16x16 --integrator path,auto --spp 64").unwrap();
        let expected =
            [("integrator", &["path", "auto"][..]), ("size", &["8x8", "16x16"][..]), ("spp", &["4", "16", "64"][..])];
        assert_eq!(lists, KnobLists::new(&expected));
    }

    #[test]
    fn a_wrong_value_names_its_flag() {
        let message = read("study --spp 4,x").unwrap_err().to_string();
        assert!(message.contains("--spp") && message.contains("'x' is no whole number"), "{message}");
    }

    #[test]
    fn what_a_preset_turns_is_refused() {
        let lists = read("study --spp 4").unwrap();
        assert!(lists.refuse("size", "no").is_ok());
        assert_eq!(lists.refuse("spp", "it is the result").unwrap_err().message, "--spp: it is the result");
    }
}
