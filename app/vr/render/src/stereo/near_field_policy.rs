//! The switch from synthesis to two renders while most of the view is too near.

/// How the two eyes of a frame are made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum FrameMode {
    /// The second eye is synthesized.
    #[default]
    Synthesized,
    /// Both eyes are rendered.
    BothRendered,
}

/// Switches whole frames to two renders while much of the view is too near, with hysteresis so that the mode does not
/// flicker.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct NearFieldPolicy {
    /// Surfaces nearer than this, in metres, are too near.
    pub distance: f32,
    /// Both eyes are rendered once at least this fraction of the view is too near.
    pub switch_on: f32,
    /// Synthesis resumes once less than this fraction is too near.
    pub switch_off: f32,
}

impl Default for NearFieldPolicy {
    fn default() -> NearFieldPolicy {
        NearFieldPolicy { distance: 0.4, switch_on: 0.5, switch_off: 0.35 }
    }
}

impl NearFieldPolicy {
    /// Returns the mode of the next frame, from this frame's mode and the fraction of its view that is too near.
    pub fn next(&self, mode: FrameMode, near_fraction: f32) -> FrameMode {
        match mode {
            FrameMode::Synthesized if near_fraction >= self.switch_on => FrameMode::BothRendered,
            FrameMode::BothRendered if near_fraction < self.switch_off => FrameMode::Synthesized,
            mode => mode,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_switch_has_hysteresis() {
        let policy = NearFieldPolicy::default();
        let mut mode = FrameMode::default();
        let mut modes = Vec::new();
        for fraction in [0.3, 0.45, 0.5, 0.45, 0.36, 0.34, 0.45, 0.6] {
            mode = policy.next(mode, fraction);
            modes.push(mode == FrameMode::BothRendered);
        }
        assert_eq!(modes, [false, false, true, true, true, false, false, true]);
    }
}
