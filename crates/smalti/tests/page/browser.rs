//! A headless browser, driven through ChromeDriver by the WebDriver protocol.

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};

use serde_json::{Value, json};
use tempfile::TempDir;

/// Where no browser is found, tests pass unless this variable says `required`.
const REQUIRED: &str = "SMALTI_BROWSER";

/// Drivers that are started at most until one listens.
const STARTS: usize = 8;

/// What WebDriver calls a reference to an element.
const ELEMENT: &str = "element-6066-11e4-a52e-4f735466cecf";

/// A browser with one window; it ends with this value.
pub struct Browser {
    driver: Child,
    session: String,
    /// Its profile, empty at first, and what it saves.
    pub folder: TempDir,
}

impl Browser {
    /// Starts a browser; `None` if there is none and none is required.
    pub fn start() -> Option<Self> {
        let Some((mut driver, port)) = driver() else { return missing("there is no chromedriver") };
        let folder = tempfile::tempdir().unwrap();
        let address = format!("http://127.0.0.1:{port}/session");
        let session = match send(&address, &capabilities(folder.path())) {
            Ok(answer) => format!("{address}/{}", answer["sessionId"].as_str().expect("a session")),
            Err(answer) if answer.to_string().contains("cannot find") => {
                end(&mut driver);
                return missing("there is a chromedriver, but no browser");
            }
            Err(answer) => panic!("no session: {answer}"),
        };
        Some(Self { driver, session, folder })
    }

    /// Opens a file and waits until it is loaded.
    pub fn open(&self, page: &Path) {
        self.post("url", &json!({ "url": format!("file://{}", page.display()) }));
    }

    /// The value of an expression in the page.
    pub fn value(&self, expression: &str) -> Value {
        self.post("execute/sync", &json!({ "script": format!("return {expression}"), "args": [] }))
    }

    /// The value of an expression that is a number.
    pub fn number(&self, expression: &str) -> f64 {
        self.value(expression).as_f64().unwrap_or_else(|| panic!("{expression} is no number"))
    }

    /// The text of every element that `selector` names.
    pub fn texts(&self, selector: &str) -> Vec<String> {
        let texts = self.value(&format!("[...document.querySelectorAll('{selector}')].map(e => e.textContent)"));
        serde_json::from_value(texts).unwrap()
    }

    /// How many elements that `selector` names are to be seen.
    pub fn visible(&self, selector: &str) -> f64 {
        self.number(&format!("[...document.querySelectorAll('{selector}')].filter(e => e.checkVisibility()).length"))
    }

    /// Clicks on the middle of an element, as a user does.
    pub fn click(&self, selector: &str) {
        self.post(&format!("element/{}/click", self.find(selector)), &json!({}));
    }

    /// Presses keys while an element has the focus.
    pub fn press(&self, selector: &str, keys: &str) {
        self.post(&format!("element/{}/value", self.find(selector)), &json!({ "text": keys }));
    }

    /// Presses the pointer on the middle of an element, moves it and lets go.
    pub fn drag(&self, selector: &str, [x, y]: [i32; 2]) {
        let origin = json!({ ELEMENT: self.find(selector) });
        let actions = json!([
            { "type": "pointerMove", "duration": 0, "x": 0, "y": 0, "origin": origin },
            { "type": "pointerDown", "button": 0 },
            { "type": "pointerMove", "duration": 50, "x": x, "y": y, "origin": "pointer" },
            { "type": "pointerUp", "button": 0 },
        ]);
        let pointer =
            json!({ "type": "pointer", "id": "mouse", "parameters": { "pointerType": "mouse" }, "actions": actions });
        self.post("actions", &json!({ "actions": [pointer] }));
    }

    /// A command of the DevTools protocol.
    pub fn devtools(&self, command: &str, parameters: &Value) {
        self.post("goog/cdp/execute", &json!({ "cmd": command, "params": parameters }));
    }

    /// What the browser had to complain about since it was last asked.
    pub fn complaints(&self) -> Vec<String> {
        let log = self.post("se/log", &json!({ "type": "browser" }));
        let message = |entry: &Value| entry["message"].as_str().unwrap_or_default().to_owned();
        log.as_array().into_iter().flatten().map(message).collect()
    }

    /// The addresses that the page asked for since this was last asked.
    pub fn requests(&self) -> Vec<String> {
        let log = self.post("se/log", &json!({ "type": "performance" }));
        let events = log.as_array().into_iter().flatten().filter_map(|entry| entry["message"].as_str());
        let events = events.map(|text| serde_json::from_str::<Value>(text).expect("JSON"));
        let sent = events.filter(|event| event["message"]["method"] == "Network.requestWillBeSent");
        sent.map(|event| event["message"]["params"]["request"]["url"].as_str().unwrap_or_default().to_owned()).collect()
    }

    /// An element, brought into view.
    fn find(&self, selector: &str) -> String {
        let found = self.post("element", &json!({ "using": "css selector", "value": selector }));
        let script = "arguments[0].scrollIntoView({ block: 'center' })";
        self.post("execute/sync", &json!({ "script": script, "args": [found] }));
        found[ELEMENT].as_str().unwrap_or_else(|| panic!("{selector} is not in the page")).to_owned()
    }

    fn post(&self, command: &str, body: &Value) -> Value {
        let answer = send(&format!("{}/{command}", self.session), body);
        answer.unwrap_or_else(|error| panic!("{command} {body}: {error}"))
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        // The driver ends the browser; if it cannot, its own end does.
        let _ = ureq::delete(&self.session).call();
        end(&mut self.driver);
    }
}

/// A driver that listens, and its port; `None` if there is none on this machine.
///
/// A driver chooses a free port for the one version of the internet protocol and needs the same one for the other: where
/// another program was quicker it ends without a word, and the next one chooses anew.
fn driver() -> Option<(Child, u16)> {
    for _ in 0..STARTS {
        let driver = Command::new("chromedriver").arg("--port=0").stdout(Stdio::piped()).stderr(Stdio::null()).spawn();
        let mut driver = driver.ok()?;
        match port(&mut driver) {
            Some(port) => return Some((driver, port)),
            None => end(&mut driver),
        }
    }
    panic!("none of {STARTS} chromedrivers says on which port it listens");
}

fn end(driver: &mut Child) {
    let _ = driver.kill();
    let _ = driver.wait();
}

/// The port on which a driver that was just started listens; `None` if it ends before it says so.
fn port(driver: &mut Child) -> Option<u16> {
    let lines = BufReader::new(driver.stdout.take().expect("its output")).lines();
    lines.map_while(Result::ok).find_map(|line| {
        line.strip_prefix("ChromeDriver was started successfully on port ")?.trim_end_matches('.').parse().ok()
    })
}

fn capabilities(folder: &Path) -> Value {
    let arguments = [
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        "--disable-quic",
        "--disable-dev-shm-usage",
        "--no-first-run",
        "--disable-background-networking",
        "--disable-component-update",
        "--disable-sync",
        "--window-size=1280,900",
    ];
    let profile = format!("--user-data-dir={}", folder.join("profile").display());
    let arguments: Vec<&str> = arguments.into_iter().chain([profile.as_str()]).collect();
    json!({ "capabilities": { "alwaysMatch": {
        "browserName": "chrome",
        "goog:loggingPrefs": { "browser": "ALL", "performance": "ALL" },
        "goog:chromeOptions": {
            "args": arguments,
            "prefs": { "download.default_directory": folder.display().to_string() },
        },
    } } })
}

/// Without a browser nothing can be tested, which must not go unseen where one is required.
fn missing(what: &str) -> Option<Browser> {
    let required = std::env::var(REQUIRED).is_ok_and(|value| value == "required");
    assert!(!required, "{REQUIRED}=required, but {what}");
    eprintln!("{what}: nothing is tested");
    None
}

/// Sends a command and returns what it answers; an error as the driver tells it.
fn send(address: &str, body: &Value) -> Result<Value, Value> {
    let agent: ureq::Agent = ureq::Agent::config_builder().http_status_as_error(false).build().into();
    let mut answer = agent.post(address).send_json(body).expect("the driver answers");
    let success = answer.status().is_success();
    let value = answer.body_mut().read_json::<Value>().expect("JSON")["value"].take();
    if success { Ok(value) } else { Err(value) }
}
