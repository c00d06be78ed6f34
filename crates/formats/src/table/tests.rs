use super::*;

fn reals(name: &str, values: &[f64]) -> Column {
    Column {
        name: name.into(),
        unit: "t".into(),
        description: "One.".into(),
        values: Values::Real(values.into()),
    }
}

#[test]
fn the_builder_refuses_what_is_not_a_table() {
    let build = |columns: Vec<Column>| Table::builder().columns(columns).build();
    assert!(matches!(build(vec![]), Err(FormatError::NoColumns)));
    assert_refused!(build(vec![reals("a", &[]), reals("", &[])]) => UnnamedColumn(1));
    assert!(matches!(
        build(vec![reals("a", &[1.0]), reals("b", &[1.0]), reals("a", &[1.0])]),
        Err(FormatError::DuplicateColumn(name)) if name == "a"
    ));
    assert!(matches!(
        build(vec![reals("a", &[1.0, 2.0]), reals("b", &[1.0])]),
        Err(FormatError::UnequalLength { name, found: 1, expected: 2 }) if name == "b"
    ));
    for taken in ["ARROW:schema", "peristalsis.columns"] {
        let reserved = Table::builder()
            .columns([reals("a", &[])])
            .metadata(taken, "x")
            .build();
        assert!(matches!(reserved, Err(FormatError::ReservedMetadata(key)) if key == taken));
    }
}

#[test]
fn columns_are_found_by_name_and_kind() {
    let table = Table::builder()
        .columns([reals("a", &[1.5])])
        .column("b", "", "Two.", Values::Integer(vec![7]))
        .column("c", "", "Three.", Values::Text(vec!["x".into()]))
        .column("d", "", "Four.", Values::Boolean(vec![true]))
        .build()
        .unwrap();
    assert_eq!(table.reals("a").unwrap(), [1.5]);
    assert_eq!(table.integers("b").unwrap(), [7]);
    assert_eq!(table.texts("c").unwrap(), ["x"]);
    assert_eq!(table.booleans("d").unwrap(), [true]);
    assert!(matches!(table.reals("z"), Err(FormatError::MissingColumn(name)) if name == "z"));
    assert_refused!(
        table.reals("b") =>
        OtherKind { expected: ValueKind::Real, found: ValueKind::Integer, .. }
    );
}

#[test]
fn equality_is_bitwise_and_all_missing_values_are_alike() {
    assert_ne!(Values::Real(vec![0.0]), Values::Real(vec![-0.0]));
    assert_ne!(Values::Real(vec![1.0]), Values::Real(vec![1.0, 1.0]));
    assert_ne!(Values::Real(vec![]), Values::Integer(vec![]));
    assert_eq!(Values::Real(vec![f64::NAN]), Values::Real(vec![-f64::NAN]));
    assert_ne!(
        Values::Real(vec![f64::NAN]),
        Values::Real(vec![f64::INFINITY])
    );
}

#[test]
fn appending_joins_rows_of_like_tables_only() {
    let table = |columns: Vec<Column>| Table::builder().columns(columns).build().unwrap();
    let mut upper = table(vec![reals("a", &[1.0]), reals("b", &[2.0])]);
    upper
        .append(table(vec![reals("a", &[3.0]), reals("b", &[4.0])]))
        .unwrap();
    assert_eq!(
        upper,
        table(vec![reals("a", &[1.0, 3.0]), reals("b", &[2.0, 4.0])])
    );

    let unit = Column {
        unit: "d".into(),
        ..reals("b", &[5.0])
    };
    let kind = Column {
        values: Values::Integer(vec![5]),
        ..reals("b", &[])
    };
    let before = upper.clone();
    for (other, culprit) in [
        (vec![reals("a", &[5.0]), unit], "b"),
        (vec![reals("a", &[5.0]), kind], "b"),
        (vec![reals("a", &[5.0])], "b"),
        (
            vec![reals("a", &[5.0]), reals("b", &[5.0]), reals("c", &[5.0])],
            "c",
        ),
    ] {
        let refused = upper.append(table(other));
        assert!(matches!(refused, Err(FormatError::DifferentColumns(name)) if name == culprit));
        assert_eq!(upper, before);
    }
}
