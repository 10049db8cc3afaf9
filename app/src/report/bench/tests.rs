//! Synthetic results, whose figures are known, through data, tables and page.
