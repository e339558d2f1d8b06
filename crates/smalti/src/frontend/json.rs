//! JSON lines for machines: one object for each fact, in the order in which they happened.
//!
//! Every object has `event`; times are in seconds, places are `[x, y, width, height]` in pixels of the whole image:
//! - `reading`: `file, bytes` (0 where it has no length, as a pipe); before a scene or mesh file is read
//! - `building`: `triangles` (of all meshes); before the scene is compiled and its tree built
//! - `started`: `scene, area, spp, integrator, threads, simd, setup_seconds, tiles` (their number)`, from_spp` (what
//!   every pixel had before)`, samples` (to do, over all pixels); `spp` and `samples` are null where they cannot be
//!   foreseen yet: before the first sample of a render until a time, before the first judgement of one until an error
//! - `photons_emitted`: `round` (of samples, from 0)`, photons`
//! - `photons_stored`: `round, emitted, stored, nonfinite, bytes` (of the maps)`, seconds` (to emit, trace and build)
//! - `tile_finished`: `tile` (from 0)`, area, pass` (from 0)`, worker` (from 0)`, seconds, samples` (added, over all
//!   pixels)`, rays { camera, scattered, shadow }, nonfinite` (samples that were not finite)
//! - `sample_rejected`: `pixel [x, y], sample`; a sample that was not finite, the first ones of each tile
//! - `pass_finished`: `pass, spp` (that every pixel has now, in the mean)`, seconds` (since the render began)`,
//!   relative_error` (or null)`, foreseen_spp` (that it will come to, or null where that cannot be foreseen yet)`,
//!   left_seconds [least, most]` (until the end, or null likewise)
//! - `finished`: `interrupted, seconds, passes, idle` (share of each worker)`, tile_seconds { min, median, max },
//!   slowest_tile` (both null without tiles)

use std::io::Write;
use std::time::Duration;

use serde_json::{Value, json};
use smalti_core::settings::Rect;
use smalti_scheduler::{Event, Timing};

use super::tally::Tally;
use super::{Title, View};

/// JSON lines on `out`.
pub struct Json<W> {
    title: Title,
    out: W,
    /// Whole lines that wait to be written in one go, so that nothing else comes between.
    lines: String,
}

impl<W: Write> Json<W> {
    /// JSON lines on `out`.
    pub fn new(title: Title, out: W) -> Self {
        Self { title, out, lines: String::new() }
    }

    fn write(&mut self) {
        let _ = self.out.write_all(self.lines.as_bytes());
        self.lines.clear();
    }
}

impl<W: Write> View for Json<W> {
    fn hear(&mut self, event: &Event, tally: &Tally) {
        self.lines += &object(event, &self.title, tally).to_string();
        self.lines.push('\n');
    }

    fn tick(&mut self, _: &Tally) {
        self.write();
    }

    fn end(&mut self, _: &Tally) {
        self.write();
    }
}

fn object(event: &Event, title: &Title, tally: &Tally) -> Value {
    match event {
        Event::Started { area, tiles, from, until, samples, .. } => json!({
            "event": "started", "scene": title.scene, "area": place(*area), "spp": until,
            "integrator": title.integrator, "threads": title.threads, "simd": title.level,
            "setup_seconds": title.setup.as_secs_f64(), "tiles": tiles.len(), "from_spp": from, "samples": samples,
        }),
        Event::TileFinished { tile, area, pass, worker, elapsed, rays, samples, rejected, .. } => json!({
            "event": "tile_finished", "tile": tile, "area": place(*area), "pass": pass, "worker": worker,
            "seconds": elapsed.as_secs_f64(), "samples": samples,
            "rays": { "camera": rays.camera, "scattered": rays.scattered, "shadow": rays.shadow },
            "nonfinite": rejected,
        }),
        Event::PhotonsEmitted { round, photons } => json!({
            "event": "photons_emitted", "round": round, "photons": photons,
        }),
        Event::PhotonsStored { round, photons } => json!({
            "event": "photons_stored", "round": round, "emitted": photons.emitted, "stored": photons.stored,
            "nonfinite": photons.nonfinite, "bytes": photons.bytes, "seconds": photons.elapsed.as_secs_f64(),
        }),
        Event::SampleRejected(rejected) => json!({
            "event": "sample_rejected", "pixel": rejected.pixel, "sample": rejected.sample,
        }),
        Event::PassFinished { pass, samples, foreseen, elapsed, error } => json!({
            "event": "pass_finished", "pass": pass, "spp": samples, "seconds": elapsed.as_secs_f64(),
            "relative_error": error, "foreseen_spp": foreseen, "left_seconds": left(title, tally),
        }),
        Event::Finished { interrupted, timing } => finished(*interrupted, timing),
    }
}

/// The least and the most time that is left.
fn left(title: &Title, tally: &Tally) -> Value {
    let left = title.goal.left(tally, title.setup);
    json!(left.map(|(least, most)| [least.as_secs_f64(), most.as_secs_f64()]))
}

fn finished(interrupted: bool, timing: &Timing) -> Value {
    let balance = timing.balance();
    let [min, median, max] =
        balance.map_or([Duration::ZERO; 3], |of| [of.min, of.median, of.max]).map(|t| t.as_secs_f64());
    json!({
        "event": "finished", "interrupted": interrupted, "seconds": timing.elapsed.as_secs_f64(),
        "passes": timing.passes, "idle": timing.idle(),
        "tile_seconds": balance.map(|_| json!({ "min": min, "median": median, "max": max })),
        "slowest_tile": balance.map(|of| place(of.slowest)),
    })
}

fn place(area: Rect) -> [u32; 4] {
    [area.x, area.y, area.width, area.height]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frontend::fixture;

    fn lines(facts: &[Event]) -> Vec<Value> {
        let mut json = Json::new(fixture::title(), Vec::new());
        facts.iter().for_each(|fact| json.hear(fact, &Tally::default()));
        json.tick(&Tally::default());
        let text = String::from_utf8(json.out).unwrap();
        text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
    }

    #[test]
    fn every_fact_is_one_object_on_one_line() {
        let mut facts = fixture::first_pass(2);
        facts.push(fixture::finished(true));
        let lines = lines(&facts);
        assert_eq!(lines.len(), facts.len());
        let started = &lines[0];
        assert_eq!((&started["event"], &started["area"]), (&json!("started"), &json!([10, 20, 64, 64])));
        assert_eq!((&started["samples"], &started["setup_seconds"]), (&json!(262_144), &json!(0.12)));
        let tile = &lines[2];
        assert_eq!((&tile["event"], &tile["area"]), (&json!("tile_finished"), &json!([26, 20, 16, 16])));
        assert_eq!(
            (&tile["worker"], &tile["seconds"], &tile["rays"]["shadow"]),
            (&json!(1), &json!(0.01), &json!(49_744))
        );
        assert_eq!(lines[17], json!({ "event": "sample_rejected", "pixel": [12, 30], "sample": 0 }));
        assert_eq!((&lines[18]["relative_error"], &lines[18]["foreseen_spp"]), (&json!(0.0213), &json!(64)));
        assert_eq!((&lines[19]["interrupted"], &lines[19]["slowest_tile"]), (&json!(true), &json!([58, 68, 16, 16])));
    }

    /// At 20 s half is done.
    #[test]
    fn the_time_left_is_told_where_it_can_be_foreseen() {
        let mut json = Json::new(fixture::title(), Vec::new());
        let pass = fixture::first_pass(2).pop().unwrap();
        json.hear(&pass, &fixture::half_way(2));
        json.hear(&pass, &Tally::default());
        let told: Vec<Value> = json.lines.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
        let left = told[0]["left_seconds"].as_array().unwrap();
        assert!(left[0].as_f64().unwrap() < 20.0 && left[1].as_f64().unwrap() > 20.0, "{left:?}");
        assert!(told[1]["left_seconds"].is_null());
    }

    #[test]
    fn numbers_that_do_not_exist_are_null() {
        let timing = Timing::default();
        let pass =
            Event::PassFinished { pass: 0, samples: 1, foreseen: None, elapsed: Duration::ZERO, error: Some(f64::NAN) };
        let lines = lines(&[pass, Event::Finished { interrupted: false, timing }]);
        assert!(lines[0]["relative_error"].is_null() && lines[0]["foreseen_spp"].is_null());
        assert!(lines[1]["tile_seconds"].is_null() && lines[1]["slowest_tile"].is_null());
    }
}
