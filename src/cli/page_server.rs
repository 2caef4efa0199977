//! One page at an address of this machine, which shows itself anew when it changes.

use super::failure::Failure;
use std::io::{self, BufRead, BufReader, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

/// What a page asks ever again: the number of its version. It loads itself anew when that has changed.
const RELOAD: &str = "<script>let shown;setInterval(async()=>{try{const now=await(await fetch('/version')).text();\
                      if(shown===undefined)shown=now;else if(shown!==now)location.reload()}catch{}},500)</script>";

/// A browser that says nothing for so long is not listened to.
const PATIENCE: Duration = Duration::from_secs(2);

/// Longest request line that is read, bytes.
const LONGEST: u64 = 8192;

/// What is to be seen.
#[derive(Debug)]
pub(crate) enum Page {
    /// A whole page of HTML.
    Proof(String),
    /// What went wrong.
    Failure(String),
}

/// Serves the page to browsers of this machine.
#[derive(Debug)]
pub(crate) struct PageServer {
    address: SocketAddr,
    shown: Arc<Mutex<(u64, String)>>,
}

impl PageServer {
    /// Listens on a port of this machine, or on a free one for 0.
    pub(crate) fn start(port: u16) -> Result<Self, Failure> {
        let fail = |e: io::Error| {
            Failure::new(format!("port {port}: {e}")).help("give another port with --port")
        };
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(fail)?;
        let address = listener.local_addr().map_err(fail)?;
        let shown = Arc::new(Mutex::new((0, String::new())));
        let state = Arc::clone(&shown);
        thread::spawn(move || {
            for stream in listener.incoming().flatten() {
                // a browser that has gone away needs no answer
                answer(stream, address, &state).unwrap_or_default();
            }
        });
        Ok(Self { address, shown })
    }

    /// Where the page is.
    pub(crate) fn address(&self) -> String {
        format!("http://{}/", self.address)
    }

    /// Shows another page.
    pub(crate) fn show(&self, page: Page) {
        let html = match page {
            Page::Proof(html) => html + RELOAD,
            Page::Failure(text) => {
                let text = text.replace('&', "&amp;").replace('<', "&lt;");
                format!(
                    "<!doctype html><meta charset=utf-8><title>khatt</title><pre>{text}</pre>{RELOAD}"
                )
            }
        };
        let mut shown = self.shown.lock().unwrap_or_else(PoisonError::into_inner);
        *shown = (shown.0 + 1, html);
    }
}

/// Answers one request. Only requests to this very address are answered, so that no page from elsewhere reads the
/// proof.
fn answer(stream: TcpStream, address: SocketAddr, shown: &Mutex<(u64, String)>) -> io::Result<()> {
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    let mut lines = BufReader::new(io::Read::take(&stream, LONGEST)).lines();
    let request = lines.next().transpose()?.unwrap_or_default();
    let head = lines.map_while(Result::ok).take_while(|l| !l.is_empty());
    let host = head.filter_map(|l| {
        let (name, value) = l.split_once(':')?;
        name.eq_ignore_ascii_case("host")
            .then(|| value.trim().to_owned())
    });
    let port = address.port();
    let ours = [format!("127.0.0.1:{port}"), format!("localhost:{port}")];
    let asked_here = host.last().is_some_and(|h| ours.contains(&h));
    let (version, page) = shown.lock().unwrap_or_else(PoisonError::into_inner).clone();
    let (status, kind, body) = match request.split(' ').nth(1) {
        Some("/") if asked_here => ("200 OK", "text/html", page),
        Some("/version") if asked_here => ("200 OK", "text/plain", version.to_string()),
        _ => ("404 Not Found", "text/plain", "not here".to_owned()),
    };
    let length = body.len();
    let mut stream = &stream;
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: {kind}; charset=utf-8\r\nContent-Length: {length}\r\n\
         Cache-Control: no-store\r\nConnection: close\r\n\r\n{body}"
    )
}
