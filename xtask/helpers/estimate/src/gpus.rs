//! The GPUs of the estimate.

/// A GPU, and the size of an eye on a device with it. The rates are assumptions from public figures: one issue slot per
/// lane and clock cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Device {
    /// The name in tables.
    pub name: &'static str,
    /// The GPU's name in the table of costs.
    pub gpu: &'static str,
    /// The size of an eye in pixels.
    pub size: [u32; 2],
    /// Issue slots per second: lanes times clock.
    pub slots: f64,
    /// Texture instructions per second.
    pub fetches: f64,
    /// Bytes of memory traffic per second.
    pub bytes: f64,
}

impl Device {
    /// Returns the milliseconds that a frame with this much for each pixel of an eye takes at least: that of the slots
    /// alone, of the fetches alone or of the bytes alone, whichever is longer.
    pub fn milliseconds(&self, slots: f64, fetches: f64, bytes: f64) -> f64 {
        let seconds = (slots / self.slots).max(fetches / self.fetches).max(bytes / self.bytes);
        1e3 * f64::from(self.size[0]) * f64::from(self.size[1]) * seconds
    }
}

/// The GPUs.
pub const GPUS: [Device; 6] = [
    // Adreno 650: 768 lanes at 0.5 GHz.
    Device { name: "quest-2", gpu: "a650", size: [1832, 1920], slots: 0.384e12, fetches: 12e9, bytes: 40e9 },
    // Adreno 740.
    Device { name: "quest-3", gpu: "a740", size: [1680, 1760], slots: 1.0e12, fetches: 28.8e9, bytes: 60e9 },
    // Adreno 750: 1536 lanes and 48 texels at 0.9 GHz, and 64-bit LPDDR5X. Its driver is Mesa's turnip.
    Device {
        name: "steam-frame",
        gpu: "a750",
        size: [2160, 2160],
        slots: 1.38e12,
        fetches: 43e9,
        bytes: 77e9,
    },
    // Two cores with 24 lanes each at 0.85 GHz, and 32-bit LPDDR4X.
    Device { name: "mali-g52", gpu: "g52", size: [1200, 1080], slots: 0.041e12, fetches: 3.4e9, bytes: 13e9 },
    // Mali-G57 MC2 at 0.95 GHz: two cores with 32 lanes and 4 texels each.
    Device { name: "mali-g57", gpu: "g57", size: [1200, 1080], slots: 0.061e12, fetches: 7.6e9, bytes: 17e9 },
    // Six cores with 64 lanes each at 0.86 GHz, and 64-bit LPDDR5.
    Device { name: "mali-g610", gpu: "g610", size: [1200, 1080], slots: 0.33e12, fetches: 41e9, bytes: 51e9 },
];
