//! The files of the page, built into the program.

/// A file of the page.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Asset {
    pub(crate) content_type: &'static str,
    pub(crate) bytes: &'static [u8],
}

/// The file of this name; the empty name is the page.
pub(crate) fn asset(name: &str) -> Option<Asset> {
    let (content_type, bytes): (_, &[u8]) = match name {
        "" => (
            "text/html; charset=utf-8",
            include_bytes!("../assets/index.html"),
        ),
        "viewer.js" => (
            "text/javascript; charset=utf-8",
            include_bytes!("../assets/viewer.js"),
        ),
        "viewer.css" => (
            "text/css; charset=utf-8",
            include_bytes!("../assets/viewer.css"),
        ),
        "icon.svg" => ("image/svg+xml", include_bytes!("../assets/icon.svg")),
        _ => return None,
    };
    Some(Asset {
        content_type,
        bytes,
    })
}
