//! A server of static files for local use.

use std::fs::File;
use std::path::{Component, Path, PathBuf};

use anyhow::{Result, anyhow};
use tiny_http::{Header, Response, Server};

/// Serves a folder until the process ends. Calls `started` with the address.
///
/// # Errors
/// If the port is taken.
pub(super) fn serve(folder: &Path, port: u16, started: impl FnOnce(&str)) -> Result<()> {
    let server = Server::http(("127.0.0.1", port)).map_err(|error| anyhow!("port {port}: {error}"))?;
    let port = server.server_addr().to_ip().map_or(port, |address| address.port());
    started(&format!("http://localhost:{port}/"));
    for request in server.incoming_requests() {
        let file = file_of(request.url()).map(|path| folder.join(path));
        let found = file.and_then(|path| Some((File::open(&path).ok()?, mime_type(&path))));
        // Ignore errors of clients that have disconnected.
        let _ = match found {
            Some((file, mime_type)) => request.respond(Response::from_file(file).with_header(header(mime_type))),
            None => request.respond(Response::from_string("not found").with_status_code(404)),
        };
    }
    Ok(())
}

/// Returns the file of an address, relative to the folder, or `None` if it is outside the folder.
fn file_of(url: &str) -> Option<PathBuf> {
    let path = url.split(['?', '#']).next()?.trim_start_matches('/');
    let path = Path::new(if path.is_empty() { "index.html" } else { path });
    path.components().all(|part| matches!(part, Component::Normal(_))).then(|| path.to_owned())
}

/// Returns the MIME type of a file. Browsers compile WebAssembly while it loads only if the type is right.
fn mime_type(file: &Path) -> &'static str {
    match file.extension().and_then(|extension| extension.to_str()) {
        Some("html") => "text/html; charset=utf-8",
        Some("css") => "text/css; charset=utf-8",
        Some("js") => "text/javascript; charset=utf-8",
        Some("wasm") => "application/wasm",
        Some("svg") => "image/svg+xml",
        Some("jpg") => "image/jpeg",
        _ => "application/octet-stream",
    }
}

fn header(mime_type: &str) -> Header {
    Header { field: "Content-Type".parse().expect("a name of letters"), value: mime_type.parse().expect("plain text") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_files_of_the_folder_alone() {
        assert_eq!(file_of("/"), Some("index.html".into()));
        assert_eq!(file_of("/?api=webgl2#scene=forest"), Some("index.html".into()));
        assert_eq!(file_of("/webgpu/shadowfit_viewer.js"), Some("webgpu/shadowfit_viewer.js".into()));
        for outside in ["/../Cargo.toml", "//etc/passwd/..", "/a/../../b"] {
            assert_eq!(file_of(outside), None, "{outside}");
        }
    }

    #[test]
    fn every_file_of_the_page_has_its_type() {
        for (file, wanted) in [("page.js", "text/javascript"), ("a.wasm", "application/wasm"), ("page.css", "text/css")]
        {
            assert!(mime_type(Path::new(file)).starts_with(wanted), "{file}");
        }
    }
}
