//! The messages between program and page in TypeScript, `viewer/source/messages.ts`, from the types here; and the numbers by
//! which both draw.
//!
//! `UPDATE_EXPECT=1 cargo test -p peristalsis-viewer --lib typescript` writes it anew; then `just viewer-bundle`.

use expect_test::expect_file;
use peristalsis_run::drawn;
use ts_rs::{Config, TS};

use crate::frame::{Head, Shown};
use crate::message::{Command, Notice, Steered, Turn};
use crate::server::Figure;
use crate::server::gallery::{List, Listed};
use crate::server::study;
use crate::timeline::{Row, Sliders};
use crate::welcome::{Recorded, Welcome};
use crate::within::{Sibling, Within};

const HEAD: &str = "\
// What program and page say to each other, from the types in crates/viewer/src; made by
// UPDATE_EXPECT=1 cargo test -p peristalsis-viewer --lib typescript
// A number that is not finite is sent as null.
";

/// A type with its comments, a line for each field.
fn declared<Message: TS>() -> String {
    // JSON has one kind of number.
    let declaration = Message::decl(&Config::new().with_large_int("number"));
    let declaration = Message::docs().unwrap_or_default() + "export " + &declaration;
    let (mut text, mut open) = (String::new(), String::new());
    for line in declaration.lines() {
        let is_comment = line.starts_with("/**") || line.starts_with(" *");
        for letter in line.chars().filter(|_| !is_comment) {
            match letter {
                '{' | '[' | '<' => open.push(letter),
                '}' | ']' | '>' => drop(open.pop()),
                _ => {}
            }
            text.extend((letter == '}' && open.is_empty()).then_some('\n'));
            text.push(letter);
            text.extend(("{,".contains(letter) && open == "{").then_some('\n'));
        }
        text.extend(is_comment.then_some(line));
        text.push('\n');
    }
    let text = text.replace("\n */", " */").replace("\n * ", " ");
    let mut inside = false;
    let lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
    let indented = lines.map(|line| {
        inside &= !line.starts_with('}');
        let indent = if inside { "  " } else { "" };
        inside |= line.ends_with('{');
        format!("{indent}{line}\n")
    });
    indented.collect()
}

fn file() -> String {
    let types = [
        declared::<Welcome>(),
        declared::<Sliders<f64>>(),
        declared::<Steered>(),
        declared::<Row>(),
        declared::<Recorded>(),
        declared::<Within>(),
        declared::<Sibling>(),
        declared::<Head>(),
        declared::<Shown>(),
        declared::<Notice>(),
        declared::<Turn>(),
        declared::<Command>(),
        declared::<List<'static>>(),
        declared::<Listed>(),
        declared::<Figure>(),
        declared::<study::Shown<'static>>(),
        declared::<study::ShownColumn<'static>>(),
    ];
    format!("{HEAD}\n{}\n{}", types.join("\n"), constants())
}

/// The colours and sizes that pictures and page share.
fn constants() -> String {
    let lines = [
        ("STONE", format!("{:?}", drawn::STONE)),
        ("SHRUNK", drawn::SHRUNK.to_string()),
        ("ROD", format!("{:?}", drawn::ROD)),
        ("FORCES_COVERED", drawn::FORCES_COVERED.to_string()),
        ("GRAINS_COVERED", drawn::GRAINS_COVERED.to_string()),
        ("MOST_CONTACTS", drawn::MOST_CONTACTS.to_string()),
    ]
    .map(|(name, value)| format!("export const {name} = {value};\n"));
    let palettes = drawn::palettes()
        .map(|(name, colours)| format!("export const {name}: Colour[] = {colours:?};\n"));
    format!(
        "// What crates/run/src/scene/drawn.rs says of each.\n{}",
        lines.concat() + "export type Colour = [number, number, number];\n" + &palettes.concat()
    )
}

#[test]
fn the_page_knows_the_messages() {
    expect_file!["../../../viewer/source/messages.ts"].assert_eq(&file());
}
