//! Tables as spreadsheets and instruments write them.

/// Separation of the rows of a table into fields.
#[derive(Clone, Debug)]
pub(in crate::fabric) struct Columns {
    separator: char,
    names: Vec<String>,
}

impl Columns {
    /// Separator of a table with this first row: semicolons if it has any, else tabs, else commas. So a comma in a
    /// number is never taken for the end of a field if fields end otherwise.
    pub(in crate::fabric) fn new(header: &str) -> Self {
        let separator = [';', '\t'].into_iter().find(|s| header.contains(*s)).unwrap_or(',');
        // `recovery cm2` and `recovery(cm2)` are the column `recovery`.
        let ends = |c: char| c.is_whitespace() || matches!(c, '(' | '[' | ',' | '/');
        let name = |field: &str| field.split(ends).next().unwrap_or_default().to_lowercase();
        Self { separator, names: fields(header, separator).into_iter().map(name).collect() }
    }

    /// Names of the columns, as far as they are words.
    pub(in crate::fabric) fn names(&self) -> &[String] {
        &self.names
    }

    /// The place of a column.
    ///
    /// # Errors
    /// Where two have that name.
    pub(in crate::fabric) fn find(&self, name: &str) -> Result<Option<usize>, String> {
        let mut places = (0..self.names.len()).filter(|k| self.names[*k] == name);
        let first = places.next();
        if places.next().is_some() { Err(format!("two columns are named {name}; leave one out")) } else { Ok(first) }
    }

    /// The fields of a row.
    ///
    /// # Errors
    /// Where it has more than the table has columns.
    pub(in crate::fabric) fn cut<'a>(&self, row: &'a str) -> Result<Vec<&'a str>, String> {
        let fields = fields(row, self.separator);
        let (found, named) = (fields.len(), self.names.len());
        if fields[named.min(found)..].iter().all(|f| f.is_empty()) {
            return Ok(fields);
        }
        Err(format!("{found} fields, where the first row names {named}; write decimal points, not commas"))
    }
}

/// The fields of a row, without the quotation marks that a spreadsheet may set.
fn fields(row: &str, separator: char) -> Vec<&str> {
    let mut quoted = false;
    let is_end = |c: char| {
        quoted ^= c == '"';
        c == separator && !quoted
    };
    row.split(is_end).map(|field| bare(field.trim())).collect()
}

fn bare(field: &str) -> &str {
    field.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')).map_or(field, str::trim)
}

/// The number above 0 in a field.
pub(in crate::fabric) fn above_zero(text: &str) -> Result<f64, String> {
    number(text, |value| value > 0.0, "number above 0")
}

/// The finite number in a field.
pub(in crate::fabric) fn finite(text: &str) -> Result<f64, String> {
    number(text, |_| true, "finite number")
}

fn number(text: &str, is_fit: impl Fn(f64) -> bool, expected: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && is_fit(value) => Ok(value),
        _ if text.contains(',') => Err(format!("'{text}' is no number; write a decimal point")),
        _ => Err(format!("'{text}' is no {expected}")),
    }
}

/// The rows of a text that are neither empty, be it between separators, nor comments, with their lines from 1.
pub(in crate::fabric) fn rows(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let is_blank = |c: char| c.is_whitespace() || matches!(c, ',' | ';' | '"');
    let says = move |l: &str| !l.chars().all(is_blank) && !l.trim_start().starts_with('#');
    text.lines().enumerate().filter(move |(_, l)| says(l)).map(|(k, l)| (k + 1, l))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_cut_where_its_first_row_is() {
        let german = Columns::new("repeat;recovery cm2;stretch;bend");
        assert_eq!(german.names(), ["repeat", "recovery", "stretch", "bend"]);
        assert_eq!(german.cut("1;1674;628,1;30,5").expect("fields"), ["1", "1674", "628,1", "30,5"]);
        assert!(above_zero("628,1").expect_err("a comma").contains("decimal point"));
        let plain = Columns::new("repeat, recovery, stretch, bend");
        assert!(plain.cut("1,1674,628,1,30,5").expect_err("six").contains("6 fields, where the first row names 4"));
        assert_eq!(plain.cut("1,1674,,").expect("fields").len(), 4);
        assert_eq!(plain.cut("1,2,3,4,,").expect("idle separators").len(), 6);
    }

    #[test]
    fn a_table_may_be_as_spreadsheets_write_it() {
        let table = Columns::new("\"repeat\",\"recovery(cm2)\",\"stretch [mm]\",bend");
        assert_eq!(table.names(), ["repeat", "recovery", "stretch", "bend"]);
        assert_eq!(table.cut("\"1\", \"1,674\" ,628.1,").expect("fields"), ["1", "1,674", "628.1", ""]);
        let lines: Vec<usize> = rows("a,b\n,,\n\n;;\n1,2\n\"\",\"\"\n").map(|r| r.0).collect();
        assert_eq!(lines, [1, 5]);
    }

    #[test]
    fn a_column_is_found_once() {
        let columns = Columns::new("a\tb\tb");
        assert_eq!(columns.find("a"), Ok(Some(0)));
        assert_eq!(columns.find("c"), Ok(None));
        assert!(columns.find("b").is_err());
    }
}
