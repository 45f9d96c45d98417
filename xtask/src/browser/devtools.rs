//! A browser by the DevTools protocol over a pipe: JSON that ends with a zero byte, to file descriptor 3 and from 4.

use serde_json::{Value, json};
use std::io::{self, BufRead, BufReader, PipeWriter, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// No answer takes longer.
const PATIENCE: Duration = Duration::from_secs(60);

pub struct Browser {
    child: Child,
    to: PipeWriter,
    from: Receiver<Value>,
    number: u64,
    session: Option<String>,
    /// What the page said and asked for: errors, warnings, and requests.
    pub said: Vec<String>,
    pub asked: Vec<String>,
}

fn failed(what: &str) -> impl Fn(io::Error) -> String + '_ {
    move |error| format!("{what}: {error}")
}

impl Browser {
    /// Starts a browser with one empty page.
    pub fn start(program: &Path, profile: &Path, flags: &[&str]) -> Result<Self, String> {
        let (their_in, to) = io::pipe().map_err(failed("pipe"))?;
        let (from, their_out) = io::pipe().map_err(failed("pipe"))?;
        // A shell moves the pipes to the file descriptors that the protocol names: standard input and output arrive as
        // 0 and 1.
        let child = Command::new("sh")
            .args(["-c", "exec 3<&0 4>&1; exec \"$0\" \"$@\" </dev/null >/dev/null 2>&1"])
            .arg(program)
            .args([
                "--headless=new",
                "--no-sandbox",
                "--remote-debugging-pipe",
                "--no-first-run",
                "--hide-scrollbars",
            ])
            .args([
                "--enable-unsafe-swiftshader",
                "--disable-background-networking",
                "--disable-component-update",
            ])
            .args(flags)
            .arg(format!("--user-data-dir={}", profile.display()))
            .arg("about:blank")
            .stdin(Stdio::from(their_in))
            .stdout(Stdio::from(their_out))
            .spawn()
            .map_err(failed("Chromium"))?;
        let (sender, receiver) = channel();
        std::thread::spawn(move || {
            let mut reader = BufReader::new(from);
            let mut message = Vec::new();
            while reader.read_until(0, &mut message).is_ok_and(|read| read > 0) {
                message.pop();
                if let Ok(value) = serde_json::from_slice(&message)
                    && sender.send(value).is_err()
                {
                    break;
                }
                message.clear();
            }
        });
        let mut browser = Self {
            child,
            to,
            from: receiver,
            number: 0,
            session: None,
            said: Vec::new(),
            asked: Vec::new(),
        };
        let targets = browser.call("Target.getTargets", json!({}))?;
        let page = targets["targetInfos"]
            .as_array()
            .into_iter()
            .flatten()
            .find(|t| t["type"] == "page");
        let target = page.ok_or("Chromium opened no page")?["targetId"].clone();
        let attached = browser.call("Target.attachToTarget", json!({"targetId": target, "flatten": true}))?;
        browser.session = attached["sessionId"].as_str().map(str::to_owned);
        for domain in ["Page", "Runtime", "Log", "Network"] {
            browser.call(&format!("{domain}.enable"), json!({}))?;
        }
        Ok(browser)
    }

    /// Calls a method and waits for its answer.
    pub fn call(&mut self, method: &str, parameters: Value) -> Result<Value, String> {
        self.number += 1;
        let mut message = json!({"id": self.number, "method": method, "params": parameters});
        if let Some(session) = &self.session {
            message["sessionId"] = json!(session);
        }
        let mut bytes = message.to_string().into_bytes();
        bytes.push(0);
        self.to.write_all(&bytes).map_err(failed(method))?;
        let end = Instant::now() + PATIENCE;
        loop {
            let left = end.saturating_duration_since(Instant::now());
            let mut answer = self.from.recv_timeout(left).map_err(|error| match error {
                RecvTimeoutError::Timeout => format!("{method}: no answer"),
                RecvTimeoutError::Disconnected => format!("{method}: Chromium ended"),
            })?;
            if answer["id"] == self.number {
                return match answer.get("error") {
                    Some(error) => Err(format!("{method}: {error}")),
                    None => Ok(answer["result"].take()),
                };
            }
            self.heard(&answer);
        }
    }

    fn heard(&mut self, event: &Value) {
        let parameters = &event["params"];
        match event["method"].as_str() {
            Some("Runtime.exceptionThrown") => self.said.push(parameters["exceptionDetails"].to_string()),
            Some("Runtime.consoleAPICalled") if parameters["type"] != "info" => {
                self.said.push(parameters["args"].to_string())
            }
            Some("Log.entryAdded") if parameters["entry"]["level"] == "error" => {
                self.said.push(parameters["entry"]["text"].to_string())
            }
            Some("Network.requestWillBeSent") => {
                self.asked
                    .extend(parameters["request"]["url"].as_str().map(str::to_owned));
            }
            _ => {}
        }
    }

    /// The value of an expression; waits for promises.
    pub fn value(&mut self, expression: &str) -> Result<Value, String> {
        let parameters =
            json!({"expression": expression, "awaitPromise": true, "returnByValue": true, "userGesture": true});
        let mut answer = self.call("Runtime.evaluate", parameters)?;
        match answer.get("exceptionDetails") {
            Some(error) => Err(format!("{expression}: {}", error["exception"]["description"])),
            None => Ok(answer["result"]["value"].take()),
        }
    }

    /// Waits until an expression is true.
    pub fn wait(&mut self, expression: &str) -> Result<(), String> {
        let end = Instant::now() + PATIENCE;
        while self.value(&format!("!!({expression})"))? != true {
            if Instant::now() > end {
                return Err(format!("never true: {expression}"));
            }
            std::thread::sleep(Duration::from_millis(30));
        }
        Ok(())
    }

    /// The size of the page in pixels; narrow ones are phones.
    pub fn resize(&mut self, [width, height]: [u32; 2]) -> Result<(), String> {
        let metrics = json!({"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 600});
        self.call("Emulation.setDeviceMetricsOverride", metrics).map(drop)
    }

    /// Opens a file, and waits until it is whole.
    pub fn open(&mut self, file: &Path) -> Result<(), String> {
        self.call("Page.navigate", json!({"url": format!("file://{}", file.display())}))?;
        self.wait("document.readyState === 'complete' && document.documentElement.dataset.viewer")
    }

    /// Presses a key.
    pub fn key(&mut self, key: &str) -> Result<(), String> {
        let text = if key.chars().count() == 1 { key } else { "" };
        for kind in ["keyDown", "keyUp"] {
            let mut event = json!({"type": kind, "key": key});
            if kind == "keyDown" {
                event["text"] = json!(text);
            }
            self.call("Input.dispatchKeyEvent", event)?;
        }
        Ok(())
    }

    /// Presses, moves and lifts the mouse; a press and no way between is a click.
    pub fn drag(&mut self, places: &[[f64; 2]]) -> Result<(), String> {
        for (n, [x, y]) in places.iter().enumerate() {
            let mut send = |kind: &str| {
                let buttons = u8::from(kind != "mouseReleased");
                self.call(
                    "Input.dispatchMouseEvent",
                    json!({"type": kind, "x": x, "y": y, "button": "left", "buttons": buttons, "clickCount": 1}),
                )
            };
            send(if n == 0 { "mousePressed" } else { "mouseMoved" })?;
            if n + 1 == places.len() {
                send("mouseReleased")?;
            }
        }
        Ok(())
    }

    /// Moves the mouse without a press.
    pub fn hover(&mut self, [x, y]: [f64; 2]) -> Result<(), String> {
        let event = json!({"type": "mouseMoved", "x": x, "y": y, "button": "none", "buttons": 0});
        self.call("Input.dispatchMouseEvent", event).map(drop)
    }

    /// Puts fingers down, moves them step by step, and lifts them: each step has a place for each finger.
    pub fn touch(&mut self, steps: &[Vec<[f64; 2]>]) -> Result<(), String> {
        for (n, fingers) in steps.iter().enumerate() {
            let point = |(id, [x, y]): (usize, &[f64; 2])| json!({"x": x, "y": y, "id": id});
            let points: Vec<Value> = fingers.iter().enumerate().map(point).collect();
            let kind = if n == 0 { "touchStart" } else { "touchMove" };
            self.call("Input.dispatchTouchEvent", json!({"type": kind, "touchPoints": points}))?;
        }
        let lifted = json!({"type": "touchEnd", "touchPoints": []});
        self.call("Input.dispatchTouchEvent", lifted).map(drop)
    }

    /// The page as it is seen, as a PNG in base64.
    pub fn screenshot(&mut self) -> Result<Value, String> {
        Ok(self.call("Page.captureScreenshot", json!({"format": "png"}))?["data"].take())
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        self.session = None;
        let _ = self.call("Browser.close", json!({}));
        let end = Instant::now() + Duration::from_secs(5);
        while matches!(self.child.try_wait(), Ok(None)) && Instant::now() < end {
            std::thread::sleep(Duration::from_millis(20));
        }
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
