//! A server for this machine alone: files of one folder, nothing else.

use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::Path;

use anyhow::{Context, Result};

/// Serves a folder until the program is stopped.
#[expect(clippy::print_stdout, reason = "a developer's command, and its tests read the address")]
pub(crate) fn serve(folder: &Path, port: u16) -> Result<()> {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).with_context(|| format!("port {port}"))?;
    println!("http://{}/", listener.local_addr()?);
    std::io::stdout().flush()?;
    for stream in listener.incoming() {
        let (Ok(stream), folder) = (stream, folder.to_owned()) else { continue };
        // A browser that goes away in the middle is no matter.
        std::thread::spawn(move || answer(&stream, &folder).unwrap_or_default());
    }
    Ok(())
}

fn answer(mut stream: &TcpStream, folder: &Path) -> Result<()> {
    let mut request = String::new();
    let mut reader = BufReader::new(stream);
    reader.read_line(&mut request)?;
    let mut header = String::new();
    while reader.read_line(&mut header)? > 2 {
        header.clear();
    }
    let (status, kind, body) = match wanted(&request).map(|name| (name, fs::read(folder.join(name)))) {
        Some((name, Ok(body))) => ("200 OK", kind_of(name), body),
        _ => ("404 Not Found", "text/plain", b"no such file".to_vec()),
    };
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nCache-Control: no-store\r\nConnection: close\r\n\r\n",
        body.len()
    )?;
    stream.write_all(&body)?;
    Ok(())
}

/// The file that is asked for; only names, no paths.
fn wanted(request: &str) -> Option<&str> {
    let address = request.strip_prefix("GET /")?.split_whitespace().next().unwrap_or_default();
    let name = address.split(['?', '#']).next().unwrap_or_default();
    let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '.' | '_' | '-');
    match name {
        "" | "HTTP/1.1" => Some("index.html"),
        name if name.chars().all(plain) && !name.starts_with('.') => Some(name),
        _ => None,
    }
}

fn kind_of(name: &str) -> &'static str {
    match name.rsplit('.').next() {
        Some("html") => "text/html; charset=utf-8",
        Some("js") => "text/javascript",
        Some("wasm") => "application/wasm",
        _ => "application/octet-stream",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_files_of_the_folder() {
        let asked = |what: &str| wanted(&format!("GET {what} HTTP/1.1\r\n")).map(str::to_owned);
        assert_eq!(asked("/").as_deref(), Some("index.html"));
        assert_eq!(asked("/?cpu").as_deref(), Some("index.html"));
        assert_eq!(asked("/page.js?x=1").as_deref(), Some("page.js"));
        for bad in ["/../secret", "/a/b", "/.git", "/%2e%2e"] {
            assert_eq!(asked(bad), None, "{bad}");
        }
        assert_eq!(wanted("POST / HTTP/1.1"), None);
    }
}
