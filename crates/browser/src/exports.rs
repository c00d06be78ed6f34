//! What JavaScript calls: numbers and bytes only.
//!
//! The page's worker writes a text of `length` bytes at `input(length)` before it calls `open` or `command`. What `frame` and
//! `told` answer is a number of bytes, 0 where there is nothing, that lie at `output()` until the next call.

#![allow(
    unsafe_code,
    reason = "the names of what is exported and imported are for the linker to check, not the compiler; no memory is touched"
)]

use std::cell::RefCell;

use crate::Cabin;

thread_local! {
    static CABIN: RefCell<Cabin> = RefCell::default();
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
    with_text(|cabin, text| cabin.open(text, clock));
}

/// Does what the text says.
#[unsafe(no_mangle)]
extern "C" fn command() {
    with_text(Cabin::command);
}

/// Advances by a frame; 0 where there is nothing to compute.
#[unsafe(no_mangle)]
extern "C" fn advance() -> u32 {
    CABIN.with_borrow_mut(|cabin| cabin.advance().into())
}

/// Bytes of the frame.
#[unsafe(no_mangle)]
extern "C" fn frame() -> usize {
    give(CABIN.with_borrow(Cabin::frame))
}

/// Bytes of the next thing that is told.
#[unsafe(no_mangle)]
extern "C" fn told() -> usize {
    give(CABIN.with_borrow_mut(Cabin::told).map(String::into_bytes))
}

/// Where what was answered lies.
#[unsafe(no_mangle)]
extern "C" fn output() -> *const u8 {
    OUTPUT.with_borrow(|output| output.as_ptr())
}

fn with_text(act: impl FnOnce(&mut Cabin, &str)) {
    INPUT.with_borrow(|input| {
        let text = String::from_utf8_lossy(input);
        CABIN.with_borrow_mut(|cabin| act(cabin, &text));
    });
}

fn give(bytes: Option<Vec<u8>>) -> usize {
    let bytes = bytes.unwrap_or_default();
    let length = bytes.len();
    OUTPUT.set(bytes);
    length
}
