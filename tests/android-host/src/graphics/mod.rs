//! libEGL.so and libGLESv2.so: those of Mesa, with pbuffers as window surfaces, and with records of objects and errors.

pub mod egl;
pub mod gl;

use std::collections::{BTreeMap, HashMap, HashSet};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use anyhow::{Context, Result};

use crate::host::{host, lock};
use crate::script::GlesVersion;
use crate::summary::GlFacts;

/// The state of EGL and its objects.
pub struct Graphics {
    pub(crate) real: egl::Real,
    pub(crate) newest: GlesVersion,
    pub(crate) surfaces: Mutex<HashMap<usize, egl::Surface>>,
    pub(crate) contexts: Mutex<HashMap<usize, egl::ContextState>>,
    pub(crate) last_handle: AtomicU64,
    pub(crate) loss_asked: AtomicBool,
    objects: Mutex<HashMap<usize, BTreeMap<&'static str, HashSet<usize>>>>,
    facts: Mutex<GlFacts>,
}

impl Graphics {
    /// Opens Mesa's libraries.
    ///
    /// # Errors
    /// Fails if they are missing.
    pub fn new(newest: GlesVersion) -> Result<Self> {
        if newest < GlesVersion::Es32 {
            let (major, minor) = newest.numbers();
            // SAFETY: the host has no other threads yet, and Mesa is not loaded.
            unsafe { std::env::set_var("MESA_GLES_VERSION_OVERRIDE", format!("{major}.{minor}")) };
        }
        Ok(Self {
            real: egl::Real::load().context("the simulated Android host draws with Mesa: apt install libegl1 libegl-mesa0 libgles2 libgl1-mesa-dri")?,
            newest,
            surfaces: Mutex::default(),
            contexts: Mutex::default(),
            last_handle: AtomicU64::new(0),
            loss_asked: AtomicBool::new(false),
            objects: Mutex::default(),
            facts: Mutex::default(),
        })
    }

    /// Makes the context of the next swap lost.
    pub fn lose_context(&self) {
        self.loss_asked.store(true, Ordering::Release);
    }

    /// Returns the number of live objects in all contexts, by kind.
    pub fn live_objects(&self) -> BTreeMap<String, u64> {
        let mut sums = BTreeMap::new();
        for (kind, names) in lock(&self.objects).values().flatten() {
            if !names.is_empty() {
                *sums.entry((*kind).to_owned()).or_default() += names.len() as u64;
            }
        }
        sums
    }

    /// Returns the number of contexts that have not been destroyed.
    pub fn live_contexts(&self) -> u64 {
        lock(&self.contexts).len() as u64
    }

    /// Returns the number of surfaces that have not been destroyed.
    pub fn live_surfaces(&self) -> u64 {
        lock(&self.surfaces).len() as u64
    }

    /// Returns the number of window surfaces that have not been destroyed.
    pub fn live_window_surfaces(&self) -> usize {
        lock(&self.surfaces).values().filter(|surface| surface.is_window).count()
    }

    /// Returns the facts for the summary.
    pub fn facts(&self) -> GlFacts {
        lock(&self.facts).clone()
    }

    fn waited(&self) {
        lock(&self.facts).waits += 1;
    }

    fn error(&self, text: &str) {
        let frame = host().frames.shown();
        let mut facts = lock(&self.facts);
        facts.error_count += 1;
        if facts.errors.len() < 50 {
            facts.errors.push(format!("frame {frame}: {text}"));
        }
    }

    fn describe(&self, version: String, renderer: String) {
        let mut facts = lock(&self.facts);
        facts.version = version;
        facts.renderer = renderer;
        facts.contexts += 1;
    }

    fn object_made(&self, group: usize, kind: &'static str, name: usize) {
        if group == 0 {
            host().violation(format!("a GL {kind} was made without a context"));
        }
        lock(&self.objects).entry(group).or_default().entry(kind).or_default().insert(name);
    }

    fn object_deleted(&self, group: usize, kind: &'static str, name: usize) {
        let known = lock(&self.objects)
            .get_mut(&group)
            .and_then(|kinds| kinds.get_mut(kind))
            .is_some_and(|names| names.remove(&name));
        if !known {
            host().violation(format!("a GL {kind} was deleted that does not exist in this context"));
        }
    }

    fn group_gone(&self, group: usize) {
        lock(&self.objects).remove(&group);
    }
}
