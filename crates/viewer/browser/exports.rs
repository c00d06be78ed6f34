//! The viewer's run as WebAssembly: the functions that JavaScript calls, which pass numbers of bytes only.
//!
//! The page's worker writes a text of `length` bytes at `input(length)` before it calls `open` or `command`. `frame` and
//! `notice` answer with a number of bytes, 0 where there is nothing; the bytes lie at `output()` until the next call.

#![allow(
    unsafe_code,
    reason = "the names of what is exported and imported are for the linker to check, not the compiler; no memory is touched"
)]

use std::cell::RefCell;

use peristalsis_viewer::PageViewer;

thread_local! {
    static VIEWER: RefCell<PageViewer> = RefCell::default();
    static INPUT: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static OUTPUT: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
}

#[cfg(target_family = "wasm")]
#[link(wasm_import_module = "page")]
unsafe extern "C" {
    /// Seconds since any instant.
    safe fn seconds() -> f64;
}

#[cfg(target_family = "wasm")]
fn clock() -> f64 {
    seconds()
}

/// Elsewhere there is no page that could be asked, and no time passes.
#[cfg(not(target_family = "wasm"))]
fn clock() -> f64 {
    0.0
}

/// Where a text of so many bytes is to be written.
#[unsafe(no_mangle)]
extern "C" fn input(length: usize) -> *mut u8 {
    INPUT.with_borrow_mut(|input| {
        input.clear();
        input.resize(length, 0);
        input.as_mut_ptr()
    })
}

/// Begins the tube that the text asks for.
#[unsafe(no_mangle)]
extern "C" fn open() {
    with_text(|viewer, text| viewer.open(text, clock));
}

/// Does what the text says.
#[unsafe(no_mangle)]
extern "C" fn command() {
    with_text(PageViewer::command);
}

/// Advances by a frame; 0 where there is nothing to compute.
#[unsafe(no_mangle)]
extern "C" fn advance() -> u32 {
    VIEWER.with_borrow_mut(|viewer| viewer.advance().into())
}

/// Bytes of the frame.
#[unsafe(no_mangle)]
extern "C" fn frame() -> usize {
    answer(VIEWER.with_borrow(PageViewer::frame))
}

/// Bytes of the next notice.
#[unsafe(no_mangle)]
extern "C" fn notice() -> usize {
    answer(
        VIEWER
            .with_borrow_mut(PageViewer::notice)
            .map(String::into_bytes),
    )
}

/// Where the bytes of the last answer lie.
#[unsafe(no_mangle)]
extern "C" fn output() -> *const u8 {
    OUTPUT.with_borrow(|output| output.as_ptr())
}

fn with_text(act: impl FnOnce(&mut PageViewer, &str)) {
    INPUT.with_borrow(|input| {
        let text = String::from_utf8_lossy(input);
        VIEWER.with_borrow_mut(|viewer| act(viewer, &text));
    });
}

fn answer(bytes: Option<Vec<u8>>) -> usize {
    let bytes = bytes.unwrap_or_default();
    let length = bytes.len();
    OUTPUT.set(bytes);
    length
}
