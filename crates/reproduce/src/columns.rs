//! Rows as a table for programs.

use peristalsis_formats::{Column, FormatError, Table, Values};

/// The columns of a table, each read off the same rows.
pub(crate) struct Columns<'a, R> {
    rows: &'a [R],
    columns: Vec<Column>,
}

impl<'a, R> Columns<'a, R> {
    pub(crate) fn of(rows: &'a [R]) -> Self {
        let columns = Vec::new();
        Self { rows, columns }
    }

    /// A column of numbers.
    pub(crate) fn number(
        self,
        name: &str,
        unit: &str,
        description: &str,
        of: impl Fn(&R) -> f64,
    ) -> Self {
        let values = Values::Real(self.rows.iter().map(of).collect());
        self.column(name, unit, description, values)
    }

    /// A column of words.
    pub(crate) fn word(self, name: &str, description: &str, of: impl Fn(&R) -> String) -> Self {
        let values = Values::Text(self.rows.iter().map(of).collect());
        self.column(name, "", description, values)
    }

    fn column(mut self, name: &str, unit: &str, description: &str, values: Values) -> Self {
        self.columns.push(Column {
            name: name.to_owned(),
            unit: unit.to_owned(),
            description: description.to_owned(),
            values,
        });
        self
    }

    /// The table.
    ///
    /// # Errors
    /// Two columns of one name.
    pub(crate) fn table(self) -> Result<Table, FormatError> {
        Table::builder().columns(self.columns).build()
    }

    /// The table as what a finding holds for programs.
    ///
    /// # Errors
    /// As [`Self::table`].
    pub(crate) fn data(self) -> Result<Option<Table>, FormatError> {
        self.table().map(Some)
    }
}
