//! The files of the page, built into the program.

use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};

const HTML: &str = "text/html; charset=utf-8";
const SCRIPT: &str = "text/javascript; charset=utf-8";
const STYLE: &str = "text/css; charset=utf-8";

/// The file of this name, as an answer.
pub(crate) fn asset(name: &str) -> Response {
    let (content_type, bytes): (_, &'static [u8]) = match name {
        "tube.html" => (HTML, include_bytes!("../../assets/tube.html")),
        "study.html" => (HTML, include_bytes!("../../assets/study.html")),
        "viewer.js" => (SCRIPT, include_bytes!("../../assets/viewer.js")),
        "study.js" => (SCRIPT, include_bytes!("../../assets/study.js")),
        "viewer.css" => (STYLE, include_bytes!("../../assets/viewer.css")),
        "study.css" => (STYLE, include_bytes!("../../assets/study.css")),
        "icon.svg" => ("image/svg+xml", include_bytes!("../../assets/icon.svg")),
        _ => return StatusCode::NOT_FOUND.into_response(),
    };
    ([(header::CONTENT_TYPE, content_type)], bytes).into_response()
}
