//! Tables as spreadsheets and instruments write them.

/// How the rows of a table are cut into fields.
#[derive(Clone, Debug)]
pub(in crate::fabric) struct Columns {
    separator: char,
    names: Vec<String>,
}

impl Columns {
    /// Of a table with that first row: it is cut at semicolons if it has any, else at tabs, else at commas. So a comma
    /// in a number is never taken for the end of a field where fields end otherwise.
    pub(in crate::fabric) fn new(header: &str) -> Self {
        let separator = [';', '\t'].into_iter().find(|s| header.contains(*s)).unwrap_or(',');
        // `recovery cm2` is the column `recovery`.
        let name = |field: &str| field.split_whitespace().next().unwrap_or_default().to_lowercase();
        Self { separator, names: header.split(separator).map(name).collect() }
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
        let fields: Vec<&str> = row.split(self.separator).map(str::trim).collect();
        let (found, named) = (fields.len(), self.names.len());
        if fields[named.min(found)..].iter().all(|f| f.is_empty()) {
            return Ok(fields);
        }
        Err(format!("{found} fields, where the first row names {named}; write decimal points, not commas"))
    }
}

/// The number above 0 in a field.
pub(in crate::fabric) fn above_zero(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value > 0.0 => Ok(value),
        _ if text.contains(',') => Err(format!("'{text}' is no number; write a decimal point")),
        _ => Err(format!("'{text}' is no number above 0")),
    }
}

/// The rows of a text that are neither empty nor comments, with their lines from 1.
pub(in crate::fabric) fn rows(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let says = |l: &str| !l.trim().is_empty() && !l.trim_start().starts_with('#');
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
    fn a_column_is_found_once() {
        let columns = Columns::new("a\tb\tb");
        assert_eq!(columns.find("a"), Ok(Some(0)));
        assert_eq!(columns.find("c"), Ok(None));
        assert!(columns.find("b").is_err());
    }
}
