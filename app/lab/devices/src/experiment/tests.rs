use std::collections::BTreeSet;
use std::fs;

use super::*;

fn read(text: &str) -> Result<Experiment, String> {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("e.toml");
    fs::write(&path, text).unwrap();
    Experiment::read(&path).map_err(|error| error.to_string())
}

const SMALL: &str = "name = \"small\"\nseconds = 10\nscenes = [\"talk\", \"stage\"]\n";

fn with_methods(n: usize) -> Experiment {
    let methods: String = (0..n)
        .map(|i| format!("[[method]]\nname = \"m{i}\"\nsettings = {{ method = \"mono\" }}\n"))
        .collect();
    read(&format!("{SMALL}repetitions = 4\n{methods}")).unwrap()
}

#[test]
fn plans_are_complete_and_the_same_again() {
    let mut experiment = with_methods(3);
    for order in [Order::Balanced, Order::Random, Order::Listed] {
        experiment.order = order;
        let plan = experiment.plan("S1");
        assert_eq!(plan, experiment.plan("S1"));
        assert_eq!(plan.len(), 24);
        assert!(plan.iter().enumerate().all(|(i, p)| p.plan.order as usize == i + 1));
        let of = |p: &Planned| (p.plan.repetition, p.plan.settings.scene.clone(), p.plan.method.clone());
        assert_eq!(plan.iter().map(of).collect::<BTreeSet<_>>().len(), 24);
        let repetitions: Vec<u32> = plan.iter().map(|p| p.plan.repetition).collect();
        assert!(repetitions.is_sorted(), "a repetition is over before the next one");
        let same = experiment.plan("S2") == plan;
        assert_eq!(same, order == Order::Listed, "devices have orders of their own");
    }
    assert_eq!(experiment.plan("S1")[0].folder, "001-talk-m0-1");
    assert_eq!(experiment.length(24), [1080.0, 1080.0]);
    assert_eq!(
        (length(40.0 * 60.0), length(3900.0), length(12.0)),
        ("40 min".into(), "1 h 5 min".into(), "12 s".into())
    );
}

#[test]
fn methods_are_settings_with_a_name() {
    let text = format!(
        "{SMALL}[settings]\nhud = false\n[[method]]\nname = \"hybrid\"\n[[method]]\nname = \"paper\"\nsettings = {{ method = \"yoro\", pipeline = \"paper\", imbuffer = 2 }}\n"
    );
    let experiment = Experiment { order: Order::Listed, ..read(&text).unwrap() };
    let plan = experiment.plan("S1");
    assert_eq!(plan[0].plan.settings.method, Method::Hybrid.into());
    assert_eq!(method_name(&plan[1].plan), "yoro, paper");
    let own = plan[1].plan.own_settings();
    let own: Vec<_> = own.iter().map(|(k, v)| format!("{k}={v}")).collect();
    assert_eq!(own, ["hud=false", "imbuffer=2", "pipeline=paper"]);
    let written: Experiment = toml::from_str(&toml::to_string(&experiment).unwrap()).unwrap();
    assert_eq!(written, experiment);
}

#[test]
fn mistakes_are_one_sentence() {
    let method = "[[method]]\nname = \"yoro\"\n";
    for (text, word) in [
        (format!("{SMALL}{method}colour = 1\n"), "colour"),
        (SMALL.to_owned(), "method"),
        (format!("{SMALL}{method}{method}"), "two methods"),
        (format!("{SMALL}[[method]]\nname = \"magic\"\n"), "magic"),
        (format!("{SMALL}{method}settings = {{ speed = 1 }}\n"), "speed"),
        (format!("{SMALL}{method}settings = {{ duration = 1 }}\n"), "duration"),
        (format!("{SMALL}repetitions = 0\n{method}"), "repetitions"),
        (format!("{SMALL}repetitions = 1000000000\n{method}"), "fewer repetitions"),
        (format!("{SMALL}[cool-down]\nmax-seconds = 3\n{method}"), "celsius"),
        (SMALL.replace("stage", "talk") + method, "twice"),
        (SMALL.replace("10", "-1") + method, "seconds"),
    ] {
        let error = read(&text).unwrap_err();
        assert!(error.contains(word) && error.contains("e.toml") && !error.contains('\n'), "{word}: {error}");
    }
}

#[test]
fn the_repositorys_experiments_are_valid() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments");
    for (name, hours) in [("paper.toml", 24.0), ("five-minutes.toml", 1.0)] {
        let experiment = Experiment::read(&folder.join(name)).unwrap();
        let runs = experiment.plan("S1").len();
        assert!(experiment.length(runs)[0] < hours * 3600.0, "{name}");
    }
    let paper = Experiment::read(&folder.join("paper.toml")).unwrap();
    assert_eq!((paper.seconds, paper.scenes.len()), (600.0, 8));
}
