//! Signals, readers that go away, full disks.

use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::process::{Child, ChildStderr, Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use serde_json::Value;
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::flag::register_conditional_shutdown;

#[cfg(target_os = "linux")]
use crate::room::stderr;
use crate::room::{command, folder, json};

const LONG: &str = "render room.toml --spp 1000000 --progress json --json -o a.pfm";

/// Starts a render that takes long and waits until a pass of it is done.
fn start(command: &mut Command) -> (Child, BufReader<ChildStderr>) {
    start_until(command, "pass_finished")
}

/// Starts what takes long and waits until it tells of `fact`.
fn start_until(command: &mut Command, fact: &str) -> (Child, BufReader<ChildStderr>) {
    // What this process ignores (in the background, under nohup) its children would ignore too; what it handles,
    // they do not.
    for signal in [SIGHUP, SIGINT, SIGTERM] {
        register_conditional_shutdown(signal, 1, Arc::new(AtomicBool::new(true))).unwrap();
    }
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut events = BufReader::new(child.stderr.take().unwrap());
    let mut event = String::new();
    while !event.contains(fact) {
        event.clear();
        assert!(events.read_line(&mut event).unwrap() > 0, "it ended");
    }
    (child, events)
}

fn send(signal: &str, child: &Child) {
    assert!(Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap().success());
}

#[test]
fn an_interrupt_keeps_the_picture() {
    for (signal, code) in [("-INT", 130), ("-TERM", 143), ("-HUP", 129)] {
        let folder = folder();
        let (child, mut events) = start(&mut command(folder.path(), LONG));
        send(signal, &child);
        let mut rest = String::new();
        events.read_to_string(&mut rest).unwrap();
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(code), "{rest}");
        assert!(rest.contains("interrupted by SIG"), "{rest}");
        assert!(folder.path().join("a.pfm").is_file());
        let summary: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!((&summary["stopped_by"], &summary["target_reached"]), (&"interrupt".into(), &false.into()));
        assert!(summary["samples_least"].as_u64() > Some(0));
    }
}

#[test]
fn an_interrupted_study_is_kept_and_goes_on() {
    let folder = folder();
    let line =
        "study sweep room.toml --integrator path --spp 1,2 --reps 4000 --reference-spp 64 -o out --progress json";
    let mut command = command(folder.path(), line);
    let (child, mut events) = start_until(&mut command, "run_finished");
    send("-INT", &child);
    let mut rest = String::new();
    events.read_to_string(&mut rest).unwrap();
    assert_eq!(child.wait_with_output().unwrap().status.code(), Some(130), "{rest}");
    assert!(rest.contains("interrupted by SIGINT") && rest.contains("the same command goes on"), "{rest}");
    let text = fs::read_to_string(folder.path().join("out/study.json")).unwrap();
    let done = serde_json::from_str::<Value>(&text).unwrap()["runs"].as_array().unwrap().len();
    assert!((1..8000).contains(&done));
    let more = format!("{} --json", line.replace("4000", &(done / 2 + 1).to_string()));
    let study = json(&folder, &more);
    assert_eq!(study["runs"].as_array().unwrap().len(), 2 * (done / 2 + 1));
}

/// A folder whose scene is a pipe that nobody writes to: it is read for ever.
fn endless() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    assert!(Command::new("mkfifo").arg(folder.path().join("room.toml")).status().unwrap().success());
    folder
}

#[test]
fn an_interrupt_while_the_scene_is_read_ends_it_at_once() {
    for (signal, code) in [("-INT", 130), ("-TERM", 143), ("-HUP", 129)] {
        for line in [
            "render room.toml --progress json -o a.pfm",
            "render room.toml --progress json --quality draft -o a.pfm",
            "photons room.toml --progress json -o a.pfm",
        ] {
            let folder = endless();
            let (child, mut events) = start_until(&mut command(folder.path(), line), "\"reading\"");
            send(signal, &child);
            let mut rest = String::new();
            events.read_to_string(&mut rest).unwrap();
            let output = child.wait_with_output().unwrap();
            assert_eq!((output.status.code(), output.stdout.len()), (Some(code), 0), "{line}: {rest}");
            assert!(rest.contains("before the first sample: nothing is written"), "{line}: {rest}");
            assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "{line} left a file");
        }
    }
}

#[test]
fn a_log_tells_what_is_read_when_it_takes_long() {
    let folder = endless();
    for line in ["render room.toml --progress plain", "study sweep room.toml --spp 1 --progress plain"] {
        let (mut child, _) = start_until(&mut command(folder.path(), line), "reading room.toml\n");
        send("-KILL", &child);
        child.wait().unwrap();
    }
    for quiet in ["--progress none", "--progress plain -q"] {
        let mut command = command(folder.path(), &format!("render room.toml {quiet}"));
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        std::thread::sleep(std::time::Duration::from_millis(400));
        send("-KILL", &child);
        let mut said = String::new();
        child.stderr.take().unwrap().read_to_string(&mut said).unwrap();
        child.wait().unwrap();
        assert_eq!(said, "", "{quiet}");
    }
}

/// The program below limits of the shell.
#[cfg(target_os = "linux")]
fn limited(limit: &str, line: &str) -> std::process::Output {
    let script = format!("ulimit {limit}; exec '{}' {line}", env!("CARGO_BIN_EXE_smalti"));
    let folder = folder();
    let output = Command::new("sh").current_dir(folder.path()).args(["-c", &script]).output().unwrap();
    let files = if output.status.success() { 2 } else { 1 };
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), files, "{line}: {}", stderr(&output));
    output
}

#[cfg(target_os = "linux")]
#[test]
fn what_does_not_fit_below_the_limit_of_the_process_is_refused() {
    for (limit, name) in [("-v 600000", "614 MB (ulimit -v)"), ("-d 500000", "512 MB (ulimit -d)")] {
        for (line, parts) in [
            ("render room.toml --size 8000x8000 --spp 1", ["8000x8000 pixels need", "--size"]),
            ("render room.toml --size 4000x4000 --downsample 2", ["8000x8000 pixels need", "--size"]),
            ("render room.toml --photons 50000000", ["50000000 photons need", "--photons"]),
            ("photons room.toml --photons 100000000", ["100000000 photons need", "--photons"]),
            ("study sweep room.toml --size 8000x8000", ["8000x8000 pixels need", "--size"]),
        ] {
            let output = limited(limit, line);
            let said = stderr(&output);
            assert_eq!(output.status.code(), Some(2), "{limit} {line}: {said}");
            assert!(said.contains(&format!("this process may use {name}")), "{limit} {line}: {said}");
            assert!(parts.iter().all(|part| said.contains(part)), "{limit} {line}: {said}");
        }
        let output = limited(limit, "render room.toml --threads 2 -q");
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    }
}

#[test]
fn an_ignored_hangup_stays_ignored() {
    let folder = folder();
    let script = format!("trap '' HUP; exec '{}' {LONG}", env!("CARGO_BIN_EXE_smalti"));
    let mut shell = Command::new("sh");
    let (child, mut events) = start(shell.current_dir(folder.path()).args(["-c", &script]));
    send("-HUP", &child);
    send("-TERM", &child);
    let mut rest = String::new();
    events.read_to_string(&mut rest).unwrap();
    assert_eq!(child.wait_with_output().unwrap().status.code(), Some(143));
    assert!(rest.contains("interrupted by SIGTERM"), "{rest}");
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    let folder = folder();
    let mut child = command(folder.path(), "render room.toml --progress plain")
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop((child.stdout.take(), child.stderr.take()));
    assert_eq!(child.wait().unwrap().code(), Some(0));
    assert!(folder.path().join("room.png").is_file());
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_not_the_users_mistake() {
    let folder = folder();
    let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = command(folder.path(), "explain room.toml").stdout(full).stderr(Stdio::piped()).output().unwrap();
    assert_eq!(output.status.code(), Some(74), "{}", stderr(&output));
}
