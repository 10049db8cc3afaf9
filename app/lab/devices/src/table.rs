//! CSV and TOML, and descriptions of mistakes in such files.

/// Formats rows of cells as CSV.
pub fn csv_text<Row>(rows: impl IntoIterator<Item = Row>) -> String
where
    Row: IntoIterator,
    Row::Item: AsRef<[u8]>,
{
    let mut table = csv::Writer::from_writer(Vec::new());
    rows.into_iter().for_each(|row| table.write_record(row).expect("memory takes it"));
    String::from_utf8(table.into_inner().expect("memory takes it")).expect("all cells are text")
}

/// Returns the line number, from 1, and what is wrong there.
pub fn csv_mistake(error: &csv::Error) -> (u64, String) {
    let line = error.position().map_or(1, csv::Position::line);
    let what = match error.kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            format!("{len} cells where the header has {expected_len}")
        }
        _ => "this is no row of a CSV table in UTF-8".into(),
    };
    (line, what)
}

/// Returns a sentence with the line number, from 1, and what is wrong there.
pub fn toml_mistake(text: &str, error: &toml::de::Error) -> String {
    let line = error.span().map_or(1, |span| text[..span.start.min(text.len())].matches('\n').count() + 1);
    format!("line {line}: {}", error.message().trim().replace('\n', " "))
}
