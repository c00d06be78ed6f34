//! The files of the pages, as answers.

use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};

use crate::page;

const HTML: &str = "text/html; charset=utf-8";
const JAVASCRIPT: &str = "text/javascript; charset=utf-8";
const CSS: &str = "text/css; charset=utf-8";

/// The file of this name, as an answer.
pub(crate) fn asset(name: &str) -> Response {
    let (content_type, bytes): (_, &'static [u8]) = match name {
        "tube.html" => (HTML, page::TUBE.as_bytes()),
        "study.html" => (HTML, include_bytes!("../../assets/study.html")),
        "viewer.js" => (JAVASCRIPT, page::SCRIPT.as_bytes()),
        "study.js" => (JAVASCRIPT, include_bytes!("../../assets/study.js")),
        "viewer.css" => (CSS, page::STYLE.as_bytes()),
        "study.css" => (CSS, include_bytes!("../../assets/study.css")),
        "icon.svg" => ("image/svg+xml", include_bytes!("../../assets/icon.svg")),
        _ => return StatusCode::NOT_FOUND.into_response(),
    };
    ([(header::CONTENT_TYPE, content_type)], bytes).into_response()
}
