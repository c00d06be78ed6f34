//! Documents: a TOML text as a tree whose every value remembers where it was written.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::error::{Problem, ProblemKind, Problems};
use crate::source::{Origin, Source, SourceFile, SourceKind};

/// The keys of a table, each with its value.
pub type Table = BTreeMap<String, Entry>;

/// A key with its value and both their places.
#[derive(Clone, Debug)]
pub struct Entry {
    /// Where the key stands.
    pub key: Origin,
    /// The value.
    pub item: Item,
}

/// A value with its place.
#[derive(Clone, Debug)]
pub struct Item {
    /// Where it stands.
    pub origin: Origin,
    /// The value itself.
    pub node: Node,
}

/// A value.
#[derive(Clone, Debug)]
pub enum Node {
    /// A table.
    Table(Table),
    /// A list.
    Array(Vec<Item>),
    /// A text.
    Text(String),
    /// A whole number.
    Integer(i64),
    /// A number with a point or an exponent.
    Float(f64),
    /// True or false.
    Boolean(bool),
    /// A whole number beyond 64 bits, a float beyond the range of f64, a date: no key takes one.
    Other(&'static str),
}

impl Node {
    /// The kind of value in words.
    pub fn description(&self) -> &'static str {
        match self {
            Self::Table(_) => "a table",
            Self::Array(_) => "a list",
            Self::Text(_) => "a text",
            Self::Integer(_) => "a whole number",
            Self::Float(_) => "a number",
            Self::Boolean(_) => "true or false",
            Self::Other(description) => description,
        }
    }
}

/// Parses a file, to be checked and resolved by someone else; invalid TOML becomes a problem and an empty table.
pub fn parse_file(file: SourceFile<'_>, problems: &mut Problems) -> Table {
    let source = Source::new(SourceKind::File, file.name, file.text);
    parse(&source, problems)
}

/// Parses a whole source; invalid TOML becomes a problem and an empty table.
pub(crate) fn parse(source: &Arc<Source>, problems: &mut Problems) -> Table {
    match DeTable::parse(&source.text) {
        Ok(table) => convert_table(source, table.get_ref()),
        Err(error) => {
            let origin = Origin::new(source, error.span().unwrap_or_default());
            let message = format!("this is not TOML: {}", error.message().replace('\n', ", "));
            let problem = Problem::new(ProblemKind::Syntax, message)
                .at(&origin, "here")
                .help("one `key = value` a line, tables as `[drive]`, text in double quotes");
            problems.push(problem);
            Table::new()
        }
    }
}

/// Parses one override, `key=value`: the value is TOML, or a bare word that stands for a text.
pub(crate) fn parse_override(text: &str, problems: &mut Problems) -> Table {
    let source = Source::new(SourceKind::Override, Source::override_name(text), text);
    read_override(&source).unwrap_or_else(|message| {
        let whole = Origin::new(&source, 0..text.len());
        let problem = Problem::new(ProblemKind::Syntax, message)
            .at(&whole, "this override")
            .help("write key=value, for example drive.width=2.7 or initial.state=jammed");
        problems.push(problem);
        Table::new()
    })
}

/// The table with this one key, or the reason why the text is not KEY=VALUE.
fn read_override(source: &Arc<Source>) -> Result<Table, String> {
    let text = &*source.text;
    let Some((key, value)) = text.split_once('=') else {
        return Err(format!("an override needs a `=`: {text:?}"));
    };
    if text.contains(['\n', '\r']) || key.contains(['[', '#']) {
        return Err(format!("an override is one key and one value: {text:?}"));
    }
    let error = match DeTable::parse(text) {
        Ok(table) => return Ok(convert_table(source, table.get_ref())),
        Err(error) => error.message().replace('\n', ", "),
    };
    // The key alone is TOML with an empty text for value, which the word then replaces.
    let (word, with_empty_text) = (value.trim(), format!("{key}=\"\""));
    match DeTable::parse(&with_empty_text) {
        Ok(table) if is_bare_word(word) => {
            let mut table = convert_table(source, table.get_ref());
            let start = text.len() - value.trim_start().len();
            replace_leaf(&mut table, word, start..start + word.len());
            Ok(table)
        }
        _ if starts_with_number(word) => Err(format!(
            "{word} is no number: numbers have no unit behind them (lengths are in grain diameters d, times in t, keys of \
             units.* in SI units), and a text that begins like one needs quotation marks"
        )),
        _ => Err(format!("this override is not `key=value`: {error}")),
    }
}

/// Whether a number begins a text that goes on with a letter, such as 3mm.
fn starts_with_number(word: &str) -> bool {
    let rest =
        word.trim_start_matches(|letter: char| letter.is_ascii_digit() || "+-._".contains(letter));
    let number = &word[..word.len() - rest.len()];
    number.contains(|letter: char| letter.is_ascii_digit()) && rest.starts_with(char::is_alphabetic)
}

/// Letters, digits and `_-./`, beginning with a letter, `/`, `./` or `../`: a name, of a file too, that needs no quotes on the
/// command line.
fn is_bare_word(word: &str) -> bool {
    let is_path = ["/", "./", "../"].iter().any(|it| word.starts_with(it));
    (is_path || word.starts_with(|first: char| first.is_ascii_alphabetic()))
        && word
            .chars()
            .all(|letter| letter.is_ascii_alphanumeric() || "_-./".contains(letter))
}

/// Replaces the value at the end of a chain of tables with one key each.
fn replace_leaf(table: &mut Table, word: &str, span: Range<usize>) {
    let Some(entry) = table.values_mut().next() else {
        return;
    };
    if let Node::Table(inner) = &mut entry.item.node {
        return replace_leaf(inner, word, span);
    }
    entry.item.node = Node::Text(word.to_owned());
    entry.item.origin.span = span;
}

fn convert_table(source: &Arc<Source>, table: &DeTable<'_>) -> Table {
    let entries = table.iter().map(|(key, value)| {
        let entry = Entry {
            key: Origin::new(source, key.span()),
            item: convert(source, value),
        };
        (key.get_ref().to_string(), entry)
    });
    entries.collect()
}

fn convert(source: &Arc<Source>, value: &Spanned<DeValue<'_>>) -> Item {
    let node = match value.get_ref() {
        DeValue::String(text) => Node::Text(text.to_string()),
        DeValue::Integer(integer) => {
            let (digits, radix) = (integer.as_str(), integer.radix());
            // What is beyond an integer may still be a real number.
            let real = || match radix {
                10 => digits.parse().ok(),
                _ => u128::from_str_radix(digits, radix).ok().map(|it| it as f64),
            };
            i64::from_str_radix(digits, radix).map_or_else(
                |_| Node::Float(real().unwrap_or(f64::INFINITY)),
                Node::Integer,
            )
        }
        DeValue::Float(float) => match float.as_str().parse::<f64>() {
            // A literal too large for f64 reads as infinite; no key takes either.
            Ok(number) => Node::Float(number),
            Err(_) => Node::Other("a number that cannot be read"),
        },
        DeValue::Boolean(boolean) => Node::Boolean(*boolean),
        DeValue::Datetime(_) => Node::Other("a date"),
        DeValue::Array(items) => {
            Node::Array(items.iter().map(|item| convert(source, item)).collect())
        }
        DeValue::Table(table) => Node::Table(convert_table(source, table)),
    };
    Item {
        origin: Origin::new(source, value.span()),
        node,
    }
}

/// The entry at a dotted path.
pub fn entry<'a>(table: &'a Table, path: &str) -> Option<&'a Entry> {
    match path.split_once('.') {
        None => table.get(path),
        Some((first, rest)) => match &table.get(first)?.item.node {
            Node::Table(inner) => entry(inner, rest),
            _ => None,
        },
    }
}

/// The longest beginning of a path such as `drive.schedule[1].values[0]` that was written, and its place.
pub(crate) fn written<'t, 'p>(table: &'t Table, path: &'p str) -> (&'p str, Option<&'t Origin>) {
    let (mut found, mut place, mut node) = ("", None, None::<&Node>);
    let mut start = 0;
    let ends = path.match_indices(['.', '[']).map(|(end, _)| end);
    for end in ends.chain([path.len()]) {
        let name = path[start..end].trim_end_matches(']');
        let item = match node {
            None => table.get(name).map(|entry| &entry.item),
            Some(Node::Table(inner)) => inner.get(name).map(|entry| &entry.item),
            Some(Node::Array(items)) => name.parse().ok().and_then(|it: usize| items.get(it)),
            Some(_) => None,
        };
        let Some(item) = item else { break };
        (found, place, node) = (&path[..end], Some(&item.origin), Some(&item.node));
        start = end + 1;
    }
    (found, place)
}

/// Takes the entry at a dotted path out; tables left empty stay.
pub(crate) fn remove(table: &mut Table, path: &str) -> Option<Entry> {
    match path.split_once('.') {
        None => table.remove(path),
        Some((first, rest)) => match &mut table.get_mut(first)?.item.node {
            Node::Table(inner) => remove(inner, rest),
            _ => None,
        },
    }
}

/// The table at a dotted path, if it is one.
pub(crate) fn table_mut<'a>(table: &'a mut Table, path: &str) -> Option<&'a mut Table> {
    path.split('.').try_fold(table, |table, key| {
        match &mut table.get_mut(key)?.item.node {
            Node::Table(inner) => Some(inner),
            _ => None,
        }
    })
}

/// The text at a dotted path, if it is one.
pub(crate) fn text<'a>(table: &'a Table, path: &str) -> Option<&'a str> {
    match &entry(table, path)?.item.node {
        Node::Text(text) => Some(text),
        _ => None,
    }
}

/// A table that holds one value at the end of a dotted path: a layer that sets one key. `key` is where the path stands.
pub fn setting(path: &str, key: &Origin, item: Item) -> Table {
    let (name, item) = match path.split_once('.') {
        None => (path, item),
        Some((first, rest)) => {
            let inner = Item {
                origin: item.origin.clone(),
                node: Node::Table(setting(rest, key, item)),
            };
            (first, inner)
        }
    };
    let entry = Entry {
        key: key.clone(),
        item,
    };
    Table::from([(name.to_owned(), entry)])
}

/// The tree as a plain TOML table, for serde.
pub fn to_toml(table: &Table) -> toml::Table {
    table
        .iter()
        .map(|(key, entry)| (key.clone(), to_value(&entry.item.node)))
        .collect()
}

fn to_value(node: &Node) -> toml::Value {
    match node {
        Node::Table(table) => toml::Value::Table(to_toml(table)),
        Node::Array(items) => {
            toml::Value::Array(items.iter().map(|item| to_value(&item.node)).collect())
        }
        Node::Text(text) => toml::Value::String(text.clone()),
        Node::Integer(integer) => toml::Value::Integer(*integer),
        Node::Float(number) => toml::Value::Float(*number),
        Node::Boolean(boolean) => toml::Value::Boolean(*boolean),
        // Refused before serde sees it.
        Node::Other(description) => toml::Value::String((*description).to_owned()),
    }
}

/// Tables are merged key by key, all other values replaced.
pub(crate) fn merge(base: &mut Table, layer: Table) {
    for (key, mut entry) in layer {
        if let Node::Table(above) = &mut entry.item.node
            && let Some(below) = base.get_mut(&key)
            && let Node::Table(table) = &mut below.item.node
        {
            merge(table, std::mem::take(above));
            below.key = entry.key;
            below.item.origin = entry.item.origin;
            continue;
        }
        base.insert(key, entry);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn override_table(text: &str) -> Result<Table, String> {
        let mut problems = Problems::default();
        let table = parse_override(text, &mut problems);
        problems
            .check()
            .map(|()| table)
            .map_err(|error| error.to_string())
    }

    #[test]
    fn overrides_read_toml_and_bare_words() {
        let table = override_table("initial.state = jammed").unwrap();
        let state = entry(&table, "initial.state").unwrap();
        assert!(matches!(&state.item.node, Node::Text(text) if text == "jammed"));
        assert_eq!(state.item.origin.text(), "jammed");
        let table = override_table("tube.file=../walls/helix.csv").unwrap();
        let file = entry(&table, "tube.file").unwrap();
        assert!(matches!(&file.item.node, Node::Text(text) if text == "../walls/helix.csv"));
        let table = override_table("drive.width=2.5").unwrap();
        let width = entry(&table, "drive.width").unwrap();
        assert!(matches!(width.item.node, Node::Float(2.5)));
        assert_eq!(width.item.origin.text(), "2.5");
        let table = override_table("wall.keep.balance=true").unwrap();
        let balance = entry(&table, "wall.keep.balance").unwrap();
        assert!(matches!(balance.item.node, Node::Boolean(true)));
    }

    #[test]
    fn what_is_no_override_is_refused() {
        for text in [
            "drive.width",
            "=3",
            "[drive]\nwidth=3",
            "#a=b",
            "a=",
            "a=1 2",
            "a=b c",
            "",
        ] {
            let message = override_table(text).unwrap_err();
            assert!(message.contains("key=value"), "{text:?}: {message}");
        }
    }

    #[test]
    fn places_are_kept_through_tables_and_dots() {
        let mut problems = Problems::default();
        let text = "a.b = 1\n[c]\nd = [2, 3]\n";
        let source = Source::new(SourceKind::File, "x.toml", text);
        let table = parse(&source, &mut problems);
        assert_eq!(entry(&table, "a.b").unwrap().item.origin.span, 6..7);
        assert_eq!(entry(&table, "a.b").unwrap().key.text(), "b");
        let list = &entry(&table, "c.d").unwrap().item;
        let Node::Array(items) = &list.node else {
            panic!("a list")
        };
        assert_eq!(items[1].origin.text(), "3");
    }
}
