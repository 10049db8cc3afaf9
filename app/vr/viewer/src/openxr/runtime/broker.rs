//! The runtime broker of Android: a content provider that knows the active runtime.

use std::collections::HashMap;
use std::path::Path;

use super::error::Failure;
use super::library::Candidate;

/// The rows of a table. Each row has one value per requested column, in the order of the request.
pub type Rows = Vec<Vec<Option<String>>>;

/// Queries content providers, which on Android requires Java: `ContentResolver.query`.
pub trait Broker {
    /// Returns all rows of the table at `uri`, with `columns` as texts (`Cursor.getString`). A value is `None` if it is
    /// null or if the table does not have the column. Returns `None` if no provider answers (a null cursor).
    ///
    /// # Errors
    /// The system's message, for instance an exception.
    fn query(&self, uri: &str, columns: &[&str]) -> Result<Option<Rows>, String>;
}

/// A system without content providers.
pub struct NoBroker;

impl Broker for NoBroker {
    fn query(&self, _: &str, _: &[&str]) -> Result<Option<Rows>, String> {
        Ok(None)
    }
}

/// The name of this architecture in the broker's tables.
const ABI: &str = match std::env::consts::ARCH.as_bytes() {
    b"aarch64" => "arm64-v8a",
    b"arm" => "armeabi-v7l",
    b"x86" => "x86",
    _ => "x86_64",
};

const PACKAGE: &str = "package_name";
const FOLDER: &str = "native_lib_dir";
const FILE: &str = "so_filename";
const HAS_FUNCTIONS: &str = "has_functions";

/// Returns the libraries that the broker at `authority` offers, the preferred one first.
pub(super) fn ask(broker: &dyn Broker, authority: &str) -> Result<Vec<Result<Candidate, Failure>>, Failure> {
    let table = |path: &str, columns: &[&str]| {
        broker
            .query(&format!("content://{authority}/openxr/1/abi/{ABI}/runtimes/{path}/"), columns)
            .map_err(|reason| Failure::Unusable(format!("the broker {authority} cannot be asked ({reason})")))
    };
    let rows = table("active", &[PACKAGE, FOLDER, FILE, HAS_FUNCTIONS])?
        .ok_or_else(|| Failure::Absent(format!("no broker at {authority}")))?;
    if rows.is_empty() {
        return Err(Failure::Absent(format!("the broker {authority} has no active runtime")));
    }
    let candidate = |row: Vec<Option<String>>| {
        let mut cells = row.into_iter();
        let mut text = |column| {
            let cell = cells.next().flatten().filter(|text| !text.is_empty());
            let missing = || format!("the broker {authority} names a runtime without {column}");
            cell.ok_or_else(|| Failure::Unusable(missing()))
        };
        let (package, folder, file) = (text(PACKAGE), text(FOLDER)?, text(FILE)?);
        // What Cursor.getString returns for a number and for a truth value.
        let renamed = matches!(text(HAS_FUNCTIONS).as_deref(), Ok("1" | "true"));
        let mut functions = HashMap::new();
        if renamed {
            let package = package?;
            let rows = table(&format!("{package}/functions"), &["function_name", "symbol_name"])?;
            for row in rows.unwrap_or_default() {
                if let [Some(function), Some(symbol)] = <[_; 2]>::try_from(row).unwrap_or_default() {
                    functions.insert(function, symbol);
                }
            }
            if functions.is_empty() {
                let what = format!("the broker {authority} does not tell the function names of {package}");
                return Err(Failure::Unusable(what));
            }
        }
        Ok(Candidate { library: Path::new(&folder).join(file), functions })
    };
    Ok(rows.into_iter().map(candidate).collect())
}
