//! What remains after frames, sessions and instances.

use yoro_openxr_stub::script::Script;

use crate::checks::assert_sessions;
use crate::client::{Client, DEPTH, Layer};
use crate::drawing::{Drawing, with_gles};
use crate::habits::{Chains, Habits, begin_rendered, begin_session, frames, run, watched_session};
use crate::harness::Gpu;
use crate::world::{allocations, script, uncounted, watched, with_gpu, with_unwatched_gpu};

/// Some programs look for a headset with one instance, and then create another.
#[test]
fn the_log_outlives_an_instance_but_not_its_descriptor() {
    with_gpu(|gpu| {
        let path = yoro_openxr_layer::log::path().unwrap();
        let lines = || {
            let text = std::fs::read_to_string(&path).unwrap_or_default();
            text.matches("renders one view").count()
        };
        let before = lines();
        for _ in 0..2 {
            watched(script(), || drop(run(gpu, &Habits { frames: 1, ..Habits::PLAIN }).unwrap()));
            let open = std::fs::read_dir("/proc/self/fd").unwrap();
            let open = open.filter_map(|entry| std::fs::read_link(entry.unwrap().path()).ok());
            assert_eq!(open.filter(|file| *file == path).count(), 0);
        }
        assert_eq!(lines(), before + 2);
    });
}

/// The recommended size must not change during an instance, but the fields of view that it depends on are known only in
/// a running session. So the first start uses an estimate, and the next start the exact size.
#[test]
fn the_recommended_size_stays_in_an_instance_and_is_right_in_the_next() {
    with_gpu(|gpu| {
        let habits = Habits { frames: 1, ..Habits::PLAIN };
        let forget = || std::fs::remove_file(yoro_openxr_layer::sizes::path().unwrap()).ok();
        let asked = |script: Script| {
            let mut sizes = Vec::new();
            watched(script, || {
                let mut client = Client::new(gpu, habits.name, &[DEPTH]).unwrap();
                sizes.push(client.sizes().unwrap());
                client.start_session().unwrap();
                sizes.push(client.sizes().unwrap());
                let chains = Chains::new(&client, &habits).unwrap();
                frames(&mut client, &chains, &habits, 1).unwrap();
                sizes.push(client.sizes().unwrap());
                client.destroy_session().unwrap();
                client.create_session().unwrap();
                sizes.push(client.sizes().unwrap());
            });
            assert!(sizes.iter().all(|size| *size == sizes[0]), "{sizes:?}");
            sizes[0][0]
        };
        forget();
        let mut exact = [0; 2];
        let seen = watched(script(), || {
            let mut client = Client::new(gpu, habits.name, &[DEPTH]).unwrap();
            client.start_session().unwrap();
            let frame = client.begin_frame().unwrap();
            client.locate(frame).unwrap();
            exact = client.sizes().unwrap()[0];
        });
        assert_ne!(exact, [160, 128]);
        // The layer itself locates nothing: only conformant runtimes would notice before the session begins.
        assert_eq!(seen.calls().get("xrLocateViews"), Some(&1));
        forget();
        assert_eq!(asked(script()), [160, 128], "1.25 times an eye's width");
        assert_eq!(asked(script()), exact);
        // An application that renders the other eye renders another view.
        assert_eq!(watched_size(gpu, script(), "left"), [160, 128], "another view");
        forget();
    });
}

fn watched_size(gpu: &Gpu, script: Script, name: &str) -> [u32; 2] {
    let mut size = [0; 2];
    watched(script, || size = Client::new(gpu, name, &[DEPTH]).unwrap().sizes().unwrap()[0]);
    size
}

#[test]
fn one_session_follows_another() {
    with_gpu(|gpu| {
        let habits = Habits::PLAIN;
        let seen = watched(script(), || {
            let mut client = Client::new(gpu, habits.name, &[DEPTH]).unwrap();
            for _ in 0..2 {
                let chains = begin_session(&mut client, &habits).unwrap();
                frames(&mut client, &chains, &habits, 2).unwrap();
                client.destroy_session().unwrap();
            }
        });
        assert_sessions(&seen, &habits, &[[2, 0]; 2], "the second session");
    });
}

/// Returns this process's number of open files, its number of threads, and its memory in bytes.
fn resources() -> [usize; 3] {
    let count = |folder: &str| std::fs::read_dir(folder).unwrap().count();
    let pages = std::fs::read_to_string("/proc/self/statm").unwrap();
    let resident: usize = pages.split(' ').nth(1).unwrap().parse().unwrap();
    [count("/proc/self/fd"), count("/proc/self/task"), resident * 4096]
}

/// The number of frames that [`steady`] watches, after a hundred others.
const FRAMES: u32 = 300;

/// Checks that frames leave nothing behind, and that the layer allocates nothing.
fn steady(drawing: Drawing, script: Script, habits: &Habits) {
    let (mut largest, mut grown) = (0, 0);
    let seen =
        watched_session(drawing, Script { pictures: None, log: None, ..script }, habits, |client, chains| {
            frames(client, chains, habits, 100)?;
            let (before, objects) = (resources(), drawing.objects());
            for _ in 0..FRAMES {
                let first = allocations();
                client.poll()?;
                let (frame, submitted) = begin_rendered(client, chains, habits)?;
                let layers = uncounted(|| [Layer::Projection(vec![submitted])]);
                client.end_frame(frame, &layers)?;
                largest = largest.max(allocations() - first);
            }
            let after = resources();
            assert_eq!((before[0], before[1]), (after[0], after[1]), "open files and threads");
            assert_eq!(objects, drawing.objects(), "objects of OpenGL");
            grown = after[2].saturating_sub(before[2]);
            Ok(())
        });
    assert_eq!(seen.counts(), [[u64::from(FRAMES) + 100, 0]], "{}", seen.layer_log);
    println!("{FRAMES} frames: {largest} allocations in the layer in one of them, {grown} bytes more");
    assert_eq!(largest, 0, "the layer allocates in a frame");
    // Less than an image, or a line per frame.
    assert!(grown < 1 << 20, "{grown} bytes more");
}

#[test]
fn frames_allocate_nothing_and_leave_nothing_behind() {
    with_unwatched_gpu(|gpu| steady(gpu.into(), script(), &Habits::PLAIN));
}

/// On OpenGL ES, whole images are read in place, while a part of an image in an array is copied first.
#[test]
fn frames_on_opengl_es_leave_nothing_behind() {
    with_gles(|gles| {
        let part = Habits { margin: [13, 7], layers: [2, 1], ..Habits::PLAIN };
        for (what, habits) in [("whole", Habits::PLAIN), ("part", part)] {
            let script = Script { formats: Script::default().formats, ..script() };
            let seen = watched(script.clone(), || drop(run(gles, &habits).unwrap()));
            assert_sessions(&seen, &habits, &[[3, 0]], what);
            steady(gles.into(), script, &habits);
        }
    });
}
