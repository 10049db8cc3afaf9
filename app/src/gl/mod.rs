//! Objects over glow.
