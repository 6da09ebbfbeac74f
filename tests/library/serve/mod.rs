//! The workbench from outside: the program started, asked over a socket, and seen in a browser.

mod browser;

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Stdio};

use serde_json::{Value, json};

use crate::common::cases::{self, folder};
use crate::common::{Folder, program, root};

const BUDGET: &str = "title = \"T\"\n[measurand.Y]\nmodel = \"a * b\"\nunit = \"V\"\n[input]\n\
    a = { value = 2, unit = \"V\", u = 0.1 }\nb = { value = 3, u = 0.01 }\n";

/// A workbench that runs until it is dropped.
struct Served {
    program: Child,
    /// `127.0.0.1:PORT`.
    host: String,
    /// `/TOKEN/`.
    base: String,
    folder: Folder,
}

impl Served {
    fn new(name: &str, files: &[(&str, &str)]) -> Served {
        let folder = folder(name);
        for (file, text) in files {
            std::fs::write(folder.join(file), text).expect("written");
        }
        let mut program = program()
            .arg("serve")
            .arg(folder.as_os_str())
            .stdout(Stdio::piped())
            .spawn()
            .expect("the program runs");
        let mut line = String::new();
        let out = program.stdout.take().expect("its output");
        BufReader::new(out).read_line(&mut line).expect("a line");
        let address = line.split("http://").nth(1).expect("an address").trim();
        let (host, base) = address.split_once('/').expect("a token");
        Served {
            program,
            host: host.into(),
            base: format!("/{base}"),
            folder,
        }
    }

    /// Status and body of what is answered to bytes.
    fn raw(&self, request: &[u8]) -> (u16, Vec<u8>) {
        let mut stream = TcpStream::connect(&self.host).expect("a connection");
        // A server that refuses may close before everything is sent.
        let _ = stream.write_all(request);
        let mut answer = Vec::new();
        let _ = stream.read_to_end(&mut answer);
        let end = answer.windows(4).position(|w| w == b"\r\n\r\n");
        let status = String::from_utf8_lossy(answer.get(9..12).unwrap_or_default()).parse();
        let body = end.map_or(Vec::new(), |end| answer[end + 4..].to_vec());
        (status.unwrap_or(0), body)
    }

    fn request(&self, method: &str, path: &str, more: &str, body: &[u8]) -> (u16, Vec<u8>) {
        let (host, length) = (&self.host, body.len());
        let head = format!(
            "{method} {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\nContent-Length: {length}\r\n{more}\r\n"
        );
        self.raw(&[head.as_bytes(), body].concat())
    }

    fn ask(&self, what: &str, mut head: Value, files: &[(&str, &str)]) -> (u16, Vec<u8>) {
        let list = files.iter();
        let list = list.map(|(path, text)| json!({ "path": path, "bytes": text.len() }));
        head["files"] = list.collect();
        head["page"] = json!("test");
        head["language"] = json!("en");
        let contents: String = files.iter().map(|(_, text)| *text).collect();
        let body = format!("{head}\n{contents}");
        let path = format!("{}api/{what}", self.base);
        self.request("POST", &path, "", body.as_bytes())
    }

    fn told(&self, what: &str, head: Value, files: &[(&str, &str)]) -> Value {
        let (status, body) = self.ask(what, head, files);
        assert_eq!(status, 200, "{}", String::from_utf8_lossy(&body));
        serde_json::from_slice(&body).expect("JSON")
    }

    fn text(&self, file: &str) -> String {
        std::fs::read_to_string(self.folder.join(file)).expect("a file")
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.program.kill();
        let _ = self.program.wait();
    }
}

#[test]
fn nobody_else_is_let_in() {
    let served = Served::new("serve-door", &[("a.toml", BUDGET)]);
    let status = |method: &str, path: &str, more: &str| served.request(method, path, more, b"").0;
    let page = served.base.clone();
    assert_eq!(status("GET", &page, ""), 200);
    assert_eq!(status("GET", &format!("{page}workbench.js"), ""), 200);
    assert_eq!(status("GET", "/", ""), 403);
    assert_eq!(status("POST", "/api/files", ""), 403);
    assert_eq!(status("GET", &page, "Origin: http://evil.example\r\n"), 403);
    assert_eq!(status("GET", &page, "Sec-Fetch-Site: cross-site\r\n"), 403);
    let elsewhere =
        format!("GET {page} HTTP/1.1\r\nHost: evil.example\r\nConnection: close\r\n\r\n");
    assert_eq!(served.raw(elsewhere.as_bytes()).0, 403);
    for outside in ["../a.toml", "..%2fa.toml", "a.toml", "api/files"] {
        assert!(
            [404, 405].contains(&status("GET", &format!("{page}{outside}"), "")),
            "{outside}"
        );
    }
    for outside in [
        "../../etc/hostname",
        "/etc/hostname",
        "none.toml",
        "",
        ".",
        "a.toml\0",
    ] {
        let (status, _) = served.ask("open", json!({ "path": outside }), &[]);
        assert_eq!(status, 404, "{outside}");
    }
    let long = format!(
        "POST {page}api/work HTTP/1.1\r\nHost: {}\r\nContent-Length: 1000000000\r\n\r\n",
        served.host
    );
    assert_eq!(served.raw(long.as_bytes()).0, 413);
    let unsaid = format!(
        "POST {page}api/work HTTP/1.1\r\nHost: {}\r\nTransfer-Encoding: chunked\r\n\r\n",
        served.host
    );
    assert_eq!(served.raw(unsaid.as_bytes()).0, 411);
    assert_eq!(
        served
            .request("POST", &format!("{page}api/work"), "", b"{")
            .0,
        400
    );
}

#[test]
fn the_page_shows_what_the_command_line_prints() {
    let served = Served::new("serve-eval", &[("a.toml", BUDGET)]);
    let see = json!({ "task": "see", "path": "a.toml" });
    let mut handed = see.clone();
    handed["format"] = json!("json");
    let page: Value = serde_json::from_slice(&served.ask("work", handed, &[]).1).expect("JSON");
    let printed = cases::json(&served.folder, &["eval", "a.toml", "--json"]);
    assert_eq!(page, printed);
    let shown = served.told("work", see.clone(), &[]);
    let html = shown["html"].as_str().expect("a page");
    let (_, printed) = cases::gumption(&served.folder, &["eval", "a.toml", "--html"]);
    assert_eq!(html, printed);
    // What is typed, and not on the disk.
    let edited = BUDGET.replace("u = 0.01", "u = 0.1");
    let typed = served.told("work", see.clone(), &[("a.toml", &edited)]);
    assert_ne!(typed["beside"]["results"], shown["beside"]["results"]);
    // What if: the same as if the text said so.
    let mut what_if = see.clone();
    what_if["changes"] = json!([{ "input": "b", "factor": 10 }]);
    let moved = served.told("work", what_if, &[]);
    assert_eq!(moved["beside"]["results"], typed["beside"]["results"]);
    // A correlation and degrees of freedom, as if the text said so.
    let stated = BUDGET.replace("u = 0.01", "u = 0.01, dof = 5")
        + "[[correlation]]\nbetween = [\"a\", \"b\"]\nr = 0.25\n";
    let mut moved = see.clone();
    moved["changes"] = json!([
        { "path": ["correlation", 0, "r"], "typed": "-0.50" },
        { "path": ["input", "b", "dof"], "typed": "20" },
    ]);
    let moved = served.told("work", moved, &[("a.toml", &stated)]);
    let said = stated
        .replace("0.25", "-0.50")
        .replace("dof = 5", "dof = 20");
    let said = served.told("work", see.clone(), &[("a.toml", &said)]);
    assert_eq!(moved["beside"], said["beside"]);
    assert_eq!(said["beside"]["entries"][0]["name"], "ν(b)");
    // Twice as many readings of the same scatter.
    let stated = BUDGET.replace("value = 3, u = 0.01", "readings = [2.99, 3.01]");
    let mut moved = see.clone();
    moved["changes"] = json!([{ "readings": ["input", "b", "readings"], "n": 4 }]);
    let moved = served.told("work", moved, &[("a.toml", &stated)]);
    let b = |told: &Value| told["beside"]["inputs"][1]["u"].as_f64().expect("u");
    // s = 0.02/√2, u = s/√4.
    assert!((b(&moved) - 0.01 / f64::sqrt(2.0)).abs() < 1e-15, "{moved}");
    assert_eq!(moved["beside"]["entries"][0]["name"], "n(b)");
    assert_eq!(moved["beside"]["entries"][0]["value"], 4.0);
    let mut beyond = see.clone();
    beyond["changes"] = json!([{ "path": ["correlation", 0, "r"], "typed": "2" }]);
    let beyond = served.told("work", beyond, &[("a.toml", &stated)]);
    assert!(
        beyond["message"]
            .as_str()
            .is_some_and(|why| !why.is_empty()),
        "{beyond}"
    );
    // A fault, at its place in units of UTF-16.
    let broken = BUDGET
        .replace("title = \"T\"", "title = \"电压𝑈\"")
        .replace("u = 0.01", "uu = 0.01");
    let refused = served.told("work", see, &[("a.toml", &broken)]);
    let fault = &refused["faults"][0];
    let units: Vec<u16> = broken.encode_utf16().collect();
    let place = |key: &str| fault[key].as_u64().expect("a place") as usize;
    let marked = String::from_utf16_lossy(&units[place("from")..place("to")]);
    assert_eq!(
        (marked.as_str(), &fault["line"]),
        ("uu", &json!(7)),
        "{refused}"
    );
    assert_eq!(
        served.told("open", json!({ "path": "a.toml" }), &[])["draft"],
        broken
    );
}

#[test]
fn what_others_have_changed_is_not_overwritten() {
    let served = Served::new("serve-save", &[("a.toml", BUDGET)]);
    let save = |text: &str, base: Option<&str>, path: &str| {
        let head = json!({ "path": path, "new": base.is_none() });
        let base = base.map(|base| ("base", base));
        let files: Vec<_> = [("text", text)].into_iter().chain(base).collect();
        served.ask("save", head, &files)
    };
    assert_eq!(save("one", Some(BUDGET), "a.toml").0, 200);
    assert_eq!(served.text("a.toml"), "one");
    let (status, conflict) = save("two", Some(BUDGET), "a.toml");
    let conflict: Value = serde_json::from_slice(&conflict).expect("JSON");
    assert_eq!((status, &conflict["there"]), (409, &json!("one")));
    assert_eq!(save("two", None, "a.toml").0, 409);
    assert_eq!(served.text("a.toml"), "one");
    assert_eq!(save("new", None, "b.toml").0, 200);
    for outside in ["../b.toml", "/tmp/b.toml", "b.sh", "none/b.toml"] {
        assert_eq!(save("new", None, outside).0, 403, "{outside}");
    }
}

/// A program that is ended while it saves leaves the old text or the new one, whole, and nothing beside it.
#[test]
fn a_kill_while_saving_tears_no_file() {
    let old = BUDGET.to_owned() + &"# old\n".repeat(200_000);
    let new = BUDGET.to_owned() + &"# new\n".repeat(200_000);
    let mut saved = 0;
    for attempt in 0..12u32 {
        let mut served = Served::new("serve-killed", &[("a.toml", &old)]);
        let head = json!({ "path": "a.toml", "new": false, "page": "test", "language": "en",
            "files": [{ "path": "text", "bytes": new.len() }, { "path": "base", "bytes": old.len() }] });
        let body = format!("{head}\n{new}{old}");
        let (host, base) = (served.host.clone(), served.base.clone());
        let request = format!(
            "POST {base}api/save HTTP/1.1\r\nHost: {host}\r\nContent-Length: {}\r\n\r\n{body}",
            body.len()
        );
        let mut stream = TcpStream::connect(&host).expect("a connection");
        let sending = std::thread::spawn(move || {
            let _ = stream.write_all(request.as_bytes());
            let _ = stream.read(&mut [0; 1]);
        });
        std::thread::sleep(std::time::Duration::from_millis(u64::from(attempt)));
        served.program.kill().expect("it runs");
        served.program.wait().expect("it ends");
        sending.join().expect("sent");
        let there = served.text("a.toml");
        assert!(there == old || there == new, "{} bytes", there.len());
        saved += u32::from(there == new);
    }
    println!("{saved} of 12 were saved");
}

/// A body of a gigabyte is refused as it is announced; whoever sends it all the same fills no memory.
#[cfg(target_os = "linux")]
#[test]
fn a_gigabyte_is_not_kept() {
    let served = Served::new("serve-gigabyte", &[]);
    let mut stream = TcpStream::connect(&served.host).expect("a connection");
    let head = format!(
        "POST {}api/work HTTP/1.1\r\nHost: {}\r\nContent-Length: 1000000000\r\n\r\n",
        served.base, served.host
    );
    stream.write_all(head.as_bytes()).expect("sent");
    let part = vec![b'x'; 1_000_000];
    let sent = (0..1000).take_while(|_| stream.write_all(&part).is_ok());
    let sent = sent.count();
    assert!(sent < 1000, "all of it was taken");
    let status = std::fs::read_to_string(format!("/proc/{}/status", served.program.id()));
    let status = status.expect("a program");
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kilobytes = peak.and_then(|peak| peak.trim().strip_suffix(" kB"));
    let kilobytes: u64 = kilobytes
        .and_then(|peak| peak.parse().ok())
        .expect("a size");
    // Less than the gigabyte by far, and more than the largest body that is taken (64 MiB) cannot be needed for one that is not.
    assert!(kilobytes < 64 * 1024, "{kilobytes} kB");
}

/// Twenty pages that ask at once, of which each is answered; and a long run that a newer wish of its page ends.
#[test]
fn the_newest_wish_of_a_page_wins() {
    let slow = BUDGET.replace("a * b", "a * sin(exp(b)) * tan(b / 3)");
    let long = format!("{slow}[monte_carlo]\ntrials = 100_000_000\n");
    let served = Served::new("serve-many", &[("a.toml", BUDGET), ("long.toml", &long)]);
    std::thread::scope(|scope| {
        let first =
            scope.spawn(|| served.told("work", json!({ "task": "see", "path": "long.toml" }), &[]));
        std::thread::sleep(std::time::Duration::from_millis(100));
        let second = served.told("work", json!({ "task": "see", "path": "a.toml" }), &[]);
        assert!(second["html"].is_string());
        assert_eq!(first.join().expect("an answer"), json!({ "stopped": true }));
    });
    let path = format!("{}api/work", served.base);
    let ask = |page: usize| {
        let head =
            json!({ "task": "see", "path": "a.toml", "page": page.to_string(), "language": "zh" });
        served.request("POST", &path, "", head.to_string().as_bytes())
    };
    std::thread::scope(|scope| {
        let pages: Vec<_> = (0..20)
            .map(|page| scope.spawn(move || ask(page).0))
            .collect();
        let answers: Vec<u16> = pages
            .into_iter()
            .map(|page| page.join().expect("an answer"))
            .collect();
        assert_eq!(answers, [200; 20]);
    });
}

#[test]
fn sheets_are_audited_and_recordings_calibrated() {
    let served = Served::new("serve-files", &[]);
    let sheet =
        std::fs::read_to_string(root().join("docs/examples/claimed-budget.csv")).expect("a sheet");
    let audit = json!({ "task": "audit", "path": "sheet.csv" });
    let audited = served.told("work", audit, &[("sheet.csv", &sheet)]);
    assert!(
        audited["html"]
            .as_str()
            .is_some_and(|html| html.contains("cert-undivided")),
        "{audited}"
    );
    let experiment =
        "recording = { file = \"run.csv\", average = \"none\" }\nequations = \"U = K*omega + b\"\n";
    let run = "omega [deg/s],U [V]\n-20,-0.1999\n-10,-0.0999\n0,0.0002\n10,0.1001\n20,0.2003\n";
    let files = [("gyro.toml", experiment), ("run.csv", run)];
    let see = json!({ "task": "see", "path": "gyro.toml" });
    let calibrated = served.told("work", see.clone(), &files);
    assert!(
        calibrated["html"].is_string() && calibrated["beside"]["experiment"] == true,
        "{calibrated}"
    );
    let missing = served.told("work", see, &files[..1]);
    assert!(missing["faults"].is_array(), "{missing}");
    assert!(!Path::new(&served.folder.join("run.csv")).exists());
}

/// Of dwells the readings are shown by their lines; one that lies apart is left out, and its dwell stays.
#[test]
fn readings_of_dwells_can_be_left_out() {
    let served = Served::new("serve-dwells", &[]);
    let experiment = "recording = { file = \"run.csv\", dwells = [\"position\"] }\nequations = \"U = K*omega + b\"\n\
        [columns]\nposition = \"position\"\n";
    let mut run = String::from("position,omega [deg/s],U [V]\n");
    for position in 0..6 {
        for n in 0..10 {
            let omega = 10 * position - 20;
            let glitch = if (position, n) == (2, 4) { 0.05 } else { 0.0 };
            let noise = f64::from((n * 7 + position * 3) % 10 - 4) * 1e-4;
            let reading = 0.01 * f64::from(omega) + noise + glitch;
            run += &format!("p{position},{omega},{reading:.4}\n");
        }
    }
    let see = json!({ "task": "see", "path": "gyro.toml" });
    let brushed = |text: &str| -> Vec<(u64, String, f64)> {
        let found = served.told(
            "work",
            see.clone(),
            &[("gyro.toml", text), ("run.csv", &run)],
        );
        assert_eq!(found["beside"]["dwells"], true, "{found}");
        serde_json::from_value(found["beside"]["residuals"].clone()).expect("rows")
    };
    let all = brushed(experiment);
    assert_eq!(all.len(), 60);
    // The largest of ten readings of which nine are alike, (n − 1)/√n standard deviations from their average.
    let far = all.iter().max_by(|a, b| a.2.abs().total_cmp(&b.2.abs()));
    let (line, response, size) = far.expect("a reading");
    assert_eq!((*line, response.as_str()), (26, "U"));
    assert!((size - 9.0 / 10.0f64.sqrt()).abs() < 0.05, "{size}");
    let left_out = format!("{experiment}[[left_out]]\nlines = [26]\nreason = \"a knock\"\n");
    let rest = brushed(&left_out);
    assert_eq!(rest.len(), 59);
    assert!(rest.iter().all(|one| one.0 != 26 && one.2.abs() < 2.0));
}

/// A hundred intervals of which some miss, the same for the same seed.
#[test]
fn lessons_draw_their_samples() {
    let served = Served::new("serve-lesson", &[]);
    let draw = |seed: u64| {
        let lesson = json!({ "name": "coverage", "n": 4, "seed": seed });
        served.told(
            "work",
            json!({ "task": "lesson", "path": "", "lesson": lesson }),
            &[],
        )
    };
    assert!(
        draw(1)["html"]
            .as_str()
            .is_some_and(|html| html.contains("<svg"))
    );
    assert_eq!(draw(1), draw(1));
    assert_ne!(draw(1), draw(2));
}

/// From a recording to an experiment, and its plan.
#[test]
fn a_recording_becomes_an_experiment() {
    let served = Served::new("serve-propose", &[("a.toml", BUDGET)]);
    let run = "omega [deg/s],U [mV]\n-10,-20.1\n0,0.2\n10,20.3\n-10,-20.2\n0,0.3\n10,20.2\n";
    let proposed = served.told("propose", json!({}), &[("run.csv", run)]);
    let text = proposed["text"].as_str().expect("a text").to_owned();
    assert!(text.contains("U = a + b*omega"), "{text}");
    let files = [("run.toml", text.as_str()), ("run.csv", run)];
    let see = json!({ "task": "see", "path": "run.toml" });
    assert_eq!(
        served.told("work", see, &files)["beside"]["experiment"],
        true
    );
    let plan = json!({ "task": "plan", "path": "run.toml" });
    let plan = served.told("work", plan, &files);
    assert!(
        plan["html"]
            .as_str()
            .is_some_and(|html| html.contains("<h1>")),
        "{plan}"
    );
    let by = json!({ "procedure": "gyro-scale-factor" });
    let by = served.told("propose", by, &[("run.csv", run)]);
    assert!(
        by["text"]
            .as_str()
            .is_some_and(|text| text.contains("procedure = ")),
        "{by}"
    );
    let torn = json!({ "path": "", "page": "test", "language": "en" });
    assert_eq!(served.ask("propose", torn, &[("run.csv", "U\n")]).0, 422);
}

#[test]
fn a_wish_for_u_is_answered() {
    let served = Served::new("serve-require", &[("a.toml", BUDGET)]);
    let wish = |expanded: f64| {
        let target = json!({ "measurand": "Y", "expanded": expanded });
        let head =
            json!({ "task": "require", "path": "a.toml", "target": target, "format": "json" });
        let (status, body) = served.ask("work", head, &[]);
        (
            status,
            serde_json::from_slice::<Value>(&body).expect("JSON"),
        )
    };
    let (status, found) = wish(0.3);
    assert_eq!((status, &found["inputs"][0]["input"]), (200, &json!("a")));
    assert!(
        found["inputs"][0]["needed"].is_number() && found["inputs"][1]["floor"].is_number(),
        "{found}"
    );
    assert_eq!(wish(-1.0).0, 422);
    // Y = a b with a = 2 V, u = 0.1 V, and b = 3, u = 0.01: where b stays, a has all the cost.
    let target = json!({ "measurand": "Y", "expanded": 0.3, "costs": { "a": 10, "b": null } });
    let head = json!({ "task": "require", "path": "a.toml", "target": target, "format": "json" });
    let (_, body) = served.ask("work", head, &[]);
    let found: Value = serde_json::from_slice(&body).expect("JSON");
    let [only] = found["together"].as_array().expect("a list").as_slice() else {
        panic!("{found}")
    };
    let needed = only["needed"].as_f64().expect("u");
    let alone = found["inputs"][0]["needed"].as_f64().expect("u");
    let cost = only["cost"].as_f64().expect("a cost");
    assert!((needed / alone - 1.0).abs() < 1e-8, "{found}");
    assert!(
        (cost / (10.0 * (0.1 / needed - 1.0)) - 1.0).abs() < 1e-8,
        "{found}"
    );
}

/// What is handed out says nothing of what is concealed; answers that are none, and exercises that there are not, are told.
#[test]
fn an_exercise_tells_nothing_before_it_is_answered() {
    let served = Served::new("serve-exercise", &[]);
    let asked = |exercise: Value| {
        let head = json!({ "task": "exercise", "path": "", "exercise": exercise });
        served.ask("work", head, &[])
    };
    let budget = |number: u64, wanted: Value| {
        let (status, body) =
            asked(json!({ "kind": "budget", "seed": 7, "number": number, "wanted": wanted }));
        assert_eq!(status, 200);
        String::from_utf8(body).expect("a text")
    };
    for number in 1..=6 {
        let truth = gumption::challenge::budget::sheet(7, number).truth;
        let mut task: Value = serde_json::from_str(&budget(number, json!("task"))).expect("JSON");
        // The kinds are those of the program, all of them.
        assert!(
            task["beside"]["kinds"]
                .as_array()
                .is_some_and(|all| all.len() > 40)
        );
        task["beside"]["kinds"] = Value::Null;
        for slip in &truth.slips {
            assert!(!task.to_string().contains(slip.as_str()), "{slip}");
        }
        let graded = budget(
            number,
            json!({ "grade": { "file": "", "verdict": truth.verdict, "candidates": [truth.slips] } }),
        );
        assert!(graded.contains("1 of 1 named first"), "{graded}");
    }
    assert!(budget(1, json!({ "grade": 3 })).contains("this is no answer"));
    assert!(budget(0, json!("task")).contains("no. 1"));
    let far = json!({ "kind": "recording", "seed": u64::MAX, "number": 99, "wanted": "task" });
    assert_eq!(asked(far).0, 200);
    let drawn = json!({ "kind": "budget", "seed": null, "number": 1, "wanted": "task" });
    assert_eq!(asked(drawn).0, 200);
    for broken in [
        json!({ "kind": "certificate", "seed": 1, "number": 1, "wanted": "task" }),
        json!({ "kind": "budget", "seed": -1, "number": 1, "wanted": "task" }),
        json!({ "kind": "budget", "seed": 1, "number": 1, "wanted": "truth" }),
    ] {
        assert_eq!(asked(broken.clone()).0, 400, "{broken}");
    }
}
