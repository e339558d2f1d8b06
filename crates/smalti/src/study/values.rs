//! How the values of knobs are read, and which are near.

use clap::ValueEnum;
use smalti_core::settings::MOST_PHOTONS;

use super::way::cores;
use crate::args::MAX_THREADS;
use crate::job;

/// Half of a number and twice that.
pub fn half_and_twice(value: u32) -> Vec<String> {
    [value / 2, value.saturating_mul(2)].into_iter().filter(|&near| near > 0).map(|near| near.to_string()).collect()
}

/// The names of a choice.
pub fn names<N: ValueEnum>() -> Vec<String> {
    N::value_variants().iter().filter_map(|name| Some(name.to_possible_value()?.get_name().to_owned())).collect()
}

/// One of several names.
pub fn choice<N: ValueEnum>(text: &str) -> Result<N, String> {
    N::from_str(text, false).map_err(|_| {
        let names = names::<N>();
        let known: Vec<&str> = names.iter().map(String::as_str).collect();
        let meant = job::nearest(text, &known).map_or(String::new(), |name| format!("; did you mean '{name}'?"));
        format!("'{text}' is none of {}{meant}", names.join(", "))
    })
}

/// A whole number.
pub fn whole(text: &str, least: u32, most: u32) -> Result<u32, String> {
    let number: Option<u32> = text.parse().ok();
    number
        .filter(|number| (least..=most).contains(number))
        .ok_or_else(|| format!("'{text}' is no whole number from {least} to {most}"))
}

/// `none`, or something else.
pub fn or_none<T>(text: &str, read: impl Fn(&str) -> Result<T, String>) -> Result<Option<T>, String> {
    if text == "none" { Ok(None) } else { read(text).map(Some).map_err(|message| format!("{message}, or 'none'")) }
}

/// `on` or `off`.
pub fn on_or_off(text: &str) -> Result<bool, String> {
    match text {
        "on" => Ok(true),
        "off" => Ok(false),
        _ => Err(format!("'{text}' is neither 'on' nor 'off'")),
    }
}

/// A number of photons, or `auto`.
pub fn photons(text: &str) -> Result<Option<u32>, String> {
    if text == "auto" { Ok(None) } else { whole(text, 0, MOST_PHOTONS).map(Some).map_err(|m| m + ", nor 'auto'") }
}

/// A number of threads, or `max`.
pub fn threads(text: &str) -> Result<usize, String> {
    let typed = || whole(text, 1, MAX_THREADS as u32).map_err(|message| message + ", nor 'max'");
    if text == "max" { Ok(cores()) } else { typed().map(|threads| threads as usize) }
}
