//! A project is built again while somebody works at it.

use crate::common::desk::{BUILD, Desk};
use crate::common::pictures::page;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Stdio};
use std::thread::{sleep, spawn};
use std::time::Duration;

/// What the address answers.
fn fetch(address: &str, path: &str) -> String {
    let mut stream = TcpStream::connect(address).expect("a server");
    write!(stream, "GET {path} HTTP/1.1\r\nHost: {address}\r\n\r\n").expect("a request");
    let mut answer = String::new();
    stream.read_to_string(&mut answer).expect("an answer");
    answer
}

/// `khatt watch` in a folder.
struct Watched {
    child: Child,
    address: String,
}

impl Watched {
    fn new(desk: &Desk) -> Self {
        let mut command = desk.command(&["watch", "font.toml", "--port", "0"]);
        let mut child = command.stderr(Stdio::piped()).spawn().expect("khatt runs");
        let mut lines = BufReader::new(child.stderr.take().expect("its words")).lines();
        let first = lines.next().expect("a line").expect("text");
        let address = first.split('/').nth(2).expect("an address").to_owned();
        // it goes on talking
        spawn(move || lines.for_each(drop));
        Self { child, address }
    }

    /// Whether its page comes to hold that text.
    fn shows(&self, text: &str) -> bool {
        // a minute is enough on a machine that does much else
        (0..1200).any(|_| {
            sleep(Duration::from_millis(50));
            fetch(&self.address, "/").contains(text)
        })
    }
}

impl Drop for Watched {
    fn drop(&mut self) {
        self.child.kill().expect("it ends");
        self.child.wait().expect("it has ended");
    }
}

#[test]
fn a_watched_project_is_built_again_when_a_page_changes() {
    let desk = Desk::letters();
    let watched = Watched::new(&desk);
    assert!(watched.shows("Test Regular"), "the first build");
    assert!(desk.has("out/test.ttf"));
    desk.write("page.png", page(&[8]));
    assert!(watched.shows("cell 9"), "the empty cell is named");
    assert!(fetch(&watched.address, "/other").starts_with("HTTP/1.1 404"));
}

#[test]
fn a_watched_project_shows_the_proof_that_it_writes() {
    let desk = Desk::letters();
    desk.done(&BUILD);
    // the proof shows how far letters have moved since
    desk.edit(|text| format!("{text}[spacing.letters]\ntracking = 0.05\n"));
    let watched = Watched::new(&desk);
    assert!(watched.shows("Test Regular"), "the first build");
    let written = desk.text("out/test.html");
    let shown = fetch(&watched.address, "/");
    assert!(shown.contains(&written), "another one");
}

#[test]
fn a_watched_project_without_a_proof_shows_one() {
    let desk = Desk::letters();
    desk.edit(|text| text.replace("proof = \"out/test.html", "report = \"out/test.json"));
    // its outputs are made already, and then they are made anew
    desk.done(&BUILD);
    let watched = Watched::new(&desk);
    assert!(watched.shows("Test Regular"), "nothing to do");
    desk.edit(|text| text.replace("\"Test\"", "\"Other\""));
    assert!(watched.shows("Other Regular"), "a build");
}

#[test]
fn a_watched_project_is_built_when_what_was_missing_comes() {
    let desk = Desk::letters();
    let text = desk.text("font.toml");
    desk.write("font.toml", text.replace("page.png", "scans/new/page.png"));
    let watched = Watched::new(&desk);
    assert!(watched.shows("scans/new/page.png"), "the page is missed");
    desk.write("scans/new/page.png", page(&[]));
    assert!(watched.shows("Test Regular"), "a build of the picture");
    desk.remove("font.toml");
    assert!(watched.shows("font.toml"), "the project is missed");
    desk.write("font.toml", text.replace("page.png", "gone.png"));
    assert!(watched.shows("gone.png"), "the new project");
}
