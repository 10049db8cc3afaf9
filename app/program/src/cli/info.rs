//! `yoro info`: the GL drivers of this machine.

use crate::cli::Subcommand;
use crate::cli::args::GlArgs;
use yoro_context::{Backend, Headless};

/// Show the GL drivers of this machine and what they offer
#[derive(clap::Args, Clone, Debug)]
pub struct InfoArgs {
    #[command(flatten)]
    gl: GlArgs,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

impl Subcommand for InfoArgs {
    /// Prints one block per backend. Fails only if no backend works.
    fn run(&self) -> anyhow::Result<()> {
        let backends = match self.gl.backend {
            Backend::Auto => vec![("egl", Backend::Egl), ("osmesa", Backend::Osmesa)],
            Backend::Egl => vec![("egl", Backend::Egl)],
            Backend::Osmesa => vec![("osmesa", Backend::Osmesa)],
        };
        let mut found = serde_json::Map::new();
        let mut failures = Vec::new();
        for (name, backend) in backends {
            match Headless::open(backend) {
                Ok(headless) => {
                    let capabilities = headless.gl().capabilities();
                    if !self.json {
                        println!("{name}: {}", capabilities.summary());
                        println!(
                            "  vendor {}, textures up to {} pixels",
                            capabilities.vendor, capabilities.max_texture_size
                        );
                        println!(
                            "  {} KiB of shared memory per workgroup",
                            capabilities.max_compute_shared_memory / 1024
                        );
                    }
                    found.insert(name.into(), serde_json::to_value(capabilities)?);
                }
                Err(error) => {
                    if !self.json {
                        println!("{name}: {error}");
                    }
                    failures.push(error);
                }
            }
        }
        if found.is_empty()
            && let Some(error) = failures.pop()
        {
            return Err(error.into());
        }
        if self.json {
            println!("{}", serde_json::to_string_pretty(&found)?);
        }
        Ok(())
    }
}
