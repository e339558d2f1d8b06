//! A study as it lies in a folder, checked: what is shown of it must be there.

use std::fs;
use std::io::ErrorKind;
use std::path::Path;

use serde_json::Value;
use smalti_report::{FORMAT, Study};

use crate::exit::Failure;

/// The file with everything in it.
const RECORD: &str = "study.json";

/// Reads the study in `folder`.
///
/// # Errors
/// There is none, or it is damaged or of another version.
pub fn read(folder: &Path) -> Result<Study, Failure> {
    let path = folder.join(RECORD);
    let text = fs::read_to_string(&path).map_err(|error| missing(folder, &path, &error))?;
    parse(&text).map_err(|what| Failure::user(format!("{}: {what}", path.display())))
}

fn missing(folder: &Path, path: &Path, error: &std::io::Error) -> Failure {
    let shown = folder.display();
    if folder.is_file() {
        return Failure::user(format!("{shown}: is a file; name the folder of a study"));
    }
    Failure::user(match error.kind() {
        ErrorKind::NotFound if !folder.exists() => format!("{shown}: there is no such folder"),
        ErrorKind::NotFound => format!("{shown}: there is no study in this folder ({RECORD} is missing)"),
        ErrorKind::InvalidData => format!("{}: is no study of smalti: it is not text", path.display()),
        _ => format!("{}: cannot be read: {error}", path.display()),
    })
}

fn parse(text: &str) -> Result<Study, String> {
    let value: Value = serde_json::from_str(text).map_err(|error| format!("is damaged: {error}"))?;
    let format = value.get("format").and_then(Value::as_u64).ok_or("is no study of smalti: it names no format")?;
    if format != u64::from(FORMAT) {
        return Err(format!("is of format {format}; this version of smalti reads format {FORMAT}"));
    }
    // From the text again, for the place of what is wrong.
    let study: Study = serde_json::from_str(text).map_err(|error| format!("is damaged: {error}"))?;
    if study.arms.is_empty() {
        return Err("this study was stopped before it knew what to render; start it again".into());
    }
    check(&study).map_err(|what| format!("is damaged: {what}"))?;
    Ok(study)
}

/// Indices must name arms, and what is divided by must be positive.
fn check(study: &Study) -> Result<(), String> {
    let arms = study.arms.len();
    if let Some(baseline) = study.baseline.filter(|&arm| arm >= arms) {
        return Err(format!("the baseline is arm {baseline} of {arms}"));
    }
    for (index, run) in study.runs.iter().enumerate() {
        if run.arm >= arms {
            return Err(format!("run {index} is of arm {} of {arms}", run.arm));
        }
        if run.seconds.is_nan() || run.seconds <= 0.0 {
            return Err(format!("run {index} took {} seconds", run.seconds));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const STUDY: &str = r#"{"format":1,"version":"0.1.0","preset":"sweep","command":"c","scene":"s","scene_hash":"h",
        "machine":{"cores":1,"simd":"scalar","system":"linux x86_64"},"references":[],"baseline":null,"runs":[],
        "arms":[{"name":"a","label":"a","group":"a","knobs":{},"varies":[],"command":"c","size":[8,8],"picture":null,
        "image":null,"biases":[]}]}"#;

    fn wrong(old: &str, new: &str) -> String {
        let text = STUDY.replacen(old, new, 1);
        assert_ne!(text, STUDY);
        parse(&text).unwrap_err()
    }

    #[test]
    fn what_an_older_version_did_not_know_is_not_missed() {
        let study = parse(STUDY).unwrap();
        assert_eq!((study.arms.len(), study.exposure), (1, 0.0));
    }

    #[test]
    fn what_is_wrong_is_named() {
        assert_eq!(wrong("\"format\":1", "\"format\":7"), "is of format 7; this version of smalti reads format 1");
        assert_eq!(wrong("\"format\":1,", ""), "is no study of smalti: it names no format");
        assert_eq!(wrong("\"baseline\":null", "\"baseline\":1"), "is damaged: the baseline is arm 1 of 1");
        assert!(wrong("\"scene\":\"s\",", "").contains("missing field `scene`"));
        assert!(wrong("]}", "").contains("is damaged: EOF"));
        let (before, _) = STUDY.split_once("\"arms\"").unwrap();
        assert!(parse(&format!("{before}\"arms\":[]}}")).unwrap_err().contains("start it again"));
    }

    #[test]
    fn runs_are_of_arms_and_took_time() {
        let run = |arm: usize, seconds: &str| {
            let run = format!(
                r#""runs":[{{"arm":{arm},"repetition":0,"seed":1,"seconds":{seconds},"photon_seconds":0,"spp":1,"rays":1,
                "relmse":0.1,"relmse_trimmed":0.1,"relative_error":0.3,"stated":null,"mean":[1,1,1],"hash":"0","tiles":[]}}]"#
            );
            parse(&STUDY.replace("\"runs\":[]", &run)).map(|study| study.runs.len())
        };
        assert_eq!(run(0, "0.5"), Ok(1));
        assert_eq!(run(1, "0.5"), Err("is damaged: run 0 is of arm 1 of 1".into()));
        assert_eq!(run(0, "0"), Err("is damaged: run 0 took 0 seconds".into()));
    }
}
