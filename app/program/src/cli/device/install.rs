//! `yoro device install`.

use std::path::{Path, PathBuf};

use anyhow::ensure;

use super::which::{WhichArgs, each};
use crate::cli::Subcommand;

/// The APKs that `cargo xtask apk` makes, with the release first.
const BUILT: [&str; 2] = ["target/apk/yoro.apk", "target/apk/yoro-debug.apk"];

/// Install the application, over an earlier one
#[derive(clap::Args, Clone, Debug)]
pub struct InstallArgs {
    /// The APK [default: what cargo xtask apk has made]
    #[arg(long, value_name = "FILE")]
    apk: Option<PathBuf>,
    #[command(flatten)]
    which: WhichArgs,
}

impl Subcommand for InstallArgs {
    /// Installs the APK on each device.
    fn run(&self) -> anyhow::Result<()> {
        let built = || BUILT.iter().map(Path::new).find(|path| path.is_file()).unwrap_or(Path::new(BUILT[0]));
        let apk = self.apk.as_deref().unwrap_or_else(built);
        ensure!(
            apk.is_file(),
            "there is no APK at {}: make one by cargo xtask apk --release, or give --apk FILE",
            apk.display()
        );
        each(self.which.choose()?, |device, bar| {
            bar.set_message("installing");
            device.install(apk)?;
            Ok(format!("installed {}", apk.display()))
        })
    }
}
