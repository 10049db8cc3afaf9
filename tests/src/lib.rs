//! End-to-end tests of the library and of the program.
