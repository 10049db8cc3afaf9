//! The rules of stores, beyond those of Android.

use anyhow::bail;
use xtask::ndk::target::{ARCHITECTURES, QUEST_TARGET_API, TARGET_API};

/// Whom an APK or a bundle is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Store {
    /// No store: everybody.
    None,
    /// Meta Horizon Store, as of 5 March 2026: an immersive application has a target API level of 32 to 34, libraries for
    /// arm64 alone, head tracking required, and the headsets by name
    /// (<https://developers.meta.com/horizon/resources/publish-mobile-manifest>), a signature of scheme 2, and no
    /// permission that it does not use (<https://github.com/meta-quest/agentic-tools>, hz-store-submit, 17 June 2026).
    Quest,
    /// Google Play, as of 24 November 2026: target API level 36, libraries for 64 bits, pages of 16 KiB, a bundle
    /// (<https://developer.android.com/google/play/requirements/target-sdk>).
    Play,
}

impl Store {
    /// Returns the store with this name; `-` is none.
    ///
    /// # Errors
    /// Fails if there is no such store.
    pub fn named(name: &str) -> anyhow::Result<Self> {
        Ok(match name {
            "-" => Self::None,
            "quest" => Self::Quest,
            "play" => Self::Play,
            _ => bail!("no store is called {name}: quest or play"),
        })
    }

    /// Returns the target API level.
    pub fn target_api(self) -> u32 {
        if self == Self::Quest { QUEST_TARGET_API } else { TARGET_API }
    }

    /// Returns the names of the processors that there are libraries for.
    pub fn abis(self) -> Vec<&'static str> {
        let count = if self == Self::Quest { 1 } else { ARCHITECTURES.len() };
        ARCHITECTURES[..count].iter().map(|architecture| architecture.abi).collect()
    }
}
