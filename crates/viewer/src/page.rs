//! The files of the page, built into the program.

/// The page of one tube: its document, which names the style and the script.
pub const TUBE: &str = include_str!("../assets/tube.html");
/// The style of the page.
pub const STYLE: &str = include_str!("../assets/viewer.css");
/// The script of the page.
pub const SCRIPT: &str = include_str!("../assets/viewer.js");
/// The module by which a notebook shows the page (`viewer/source/widget.ts`).
pub const WIDGET: &str = include_str!("../assets/widget.js");
