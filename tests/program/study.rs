//! `yoro study`: from a plan to a log to a report. The ratings are made up by this test.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;

use serde_json::Value;

use crate::browser::{Browser, check_report};
use crate::program::{folder, run, succeed};

/// Returns the answer of a participant who likes both methods about equally.
fn rating(participant: usize, method: &str, scene: usize) -> f64 {
    let taste = 3.0 + 0.1 * (participant % 5) as f64;
    let whim = if method == "yoro" { 0.1 * ((participant * 7 + scene * 3) % 5) as f64 - 0.2 } else { 0.0 };
    taste + whim
}

#[test]
fn from_a_plan_to_a_report() {
    let at = &folder();
    let plan = "study plan --participants 6 --scenes street,atrium,talk --methods conventional,yoro --seed 4 --questions image-quality";
    succeed(at, &format!("{plan} --out plan.csv"));
    succeed(at, &format!("{plan} --out plan.json"));
    let csv = fs::read_to_string(at.join("plan.csv")).unwrap();
    let plan: Value = serde_json::from_slice(&fs::read(at.join("plan.json")).unwrap()).unwrap();
    let trials = plan["trials"].as_array().unwrap();
    assert_eq!((trials.len(), csv.lines().count()), (36, 37));

    // The log that a viewer would write, among other lines of a log.
    let mut log =
        String::from("--------- beginning of main\n11-21 10:00:00.000  1  1 I YORO    : v=2,t=1.0s\n");
    let scenes: BTreeMap<&str, usize> = [("street", 0), ("atrium", 1), ("talk", 2)].into();
    for (line, trial) in csv.lines().skip(1).zip(trials) {
        let cells: Vec<&str> = line.split(',').collect();
        let (participant, scene, method) = (cells[0], cells[2], cells[3]);
        assert_eq!(
            (trial["participant"].as_str(), trial["method"].as_str()),
            (Some(participant), Some(method))
        );
        assert!(
            cells[4].contains(&format!("method={method}")) && cells[4].contains(&format!("scene={scene}"))
        );
        let value = rating(participant[1..].parse().unwrap(), method, scenes[scene]);
        let _ = writeln!(
            log,
            "11-21 10:00:01.000  1  1 I YORO    : rating,v=2,participant={participant},trial={},method={method},\
             pipeline=na,scene={scene},question=image-quality,value={value:.1}",
            cells[1]
        );
    }
    // One answer is cut off, so its participant is incomplete.
    log.truncate(log.trim_end().len() - 1);
    fs::write(at.join("log.txt"), &log).unwrap();
    let collected = succeed(at, "study collect log.txt --plan plan.csv --out ratings.csv");
    assert!(
        collected.stdout.contains("35 ratings") && collected.stdout.contains("1 damaged"),
        "{}",
        collected.stdout
    );
    assert!(collected.stderr.contains("log.txt, line 38"), "{}", collected.stderr);

    let analysed = succeed(at, "study analyse ratings.csv --out out");
    assert!(analysed.stdout.contains("left out: P06 has not rated"), "{}", analysed.stdout);
    let study: Value = serde_json::from_slice(&fs::read(at.join("out/study.json")).unwrap()).unwrap();
    let question = &study["questions"][0];
    assert_eq!(question["difference"]["n"], 5);
    let expected =
        (1..=5).flat_map(|p| (0..3).map(move |s| rating(p, "yoro", s) - rating(p, "conventional", s)));
    let expected = expected.sum::<f64>() / 15.0;
    let mean = question["difference"]["mean"].as_f64().unwrap();
    assert!((mean - expected).abs() < 1e-9, "{mean} {expected}");
    let markdown = fs::read_to_string(at.join("out/study.md")).unwrap();
    assert!(
        markdown.contains("| image-quality | yoro | 5 |") && markdown.contains("the paper's"),
        "{markdown}"
    );
    if let Some(mut browser) = Browser::start() {
        check_report(&mut browser, &at.join("out/study.html"));
    }
    // The scale on the command line limits the ratings.
    run(at, "study analyse ratings.csv --scale 1..3 --out out")
        .refuses(&["ratings.csv, line 2", "from 1 to 3"]);
}

#[test]
fn mistakes() {
    let at = &folder();
    fs::write(at.join("empty.log"), "nothing of ours\n").unwrap();
    fs::write(at.join("one.csv"), "participant,method,scene,question,rating\nP1,yoro,street,q,3\n").unwrap();
    fs::write(at.join("plan.csv"), "made earlier").unwrap();
    for (line, naming) in [
        ("study plan --scenes nowhere", &["no scene nowhere", "yoro scenes"][..]),
        ("study plan --methods yoro", &["one method cannot be compared"]),
        ("study plan --methods yoro,mine", &["mine is not a stereo method", "--set mine:method=yoro"]),
        ("study plan --methods yoro,yoro", &["the method yoro is named twice"]),
        ("study plan --set yoro:pipeline=none", &["pipeline"]),
        ("study plan --set yoro", &["METHOD:KEY=VALUE"]),
        ("study plan --set other:method=mono", &["other is not among"]),
        ("study plan --participants 0", &["--participants"]),
        ("study collect empty.log", &["no rating in empty.log"]),
        ("study collect nowhere.log", &["nowhere.log does not exist"]),
        ("study collect empty.log --plan one.csv", &["one.csv, line 1", "not a row of a plan"]),
        ("study analyse nowhere.csv", &["nowhere.csv does not exist"]),
        ("study analyse one.csv", &["nobody has rated conventional", "yoro"]),
        ("study analyse one.csv --baseline yoro", &["only yoro was rated"]),
        ("study analyse one.csv --scale 5", &["1..5"]),
    ] {
        run(at, line).refuses(naming);
    }
    assert_eq!(fs::read(at.join("plan.csv")).unwrap(), b"made earlier");
    succeed(
        at,
        "study plan --methods conventional,mine --set mine:method=yoro --set mine:pipeline=paper --out plan.csv",
    );
    let plan = fs::read_to_string(at.join("plan.csv")).unwrap();
    assert!(plan.contains("method=yoro participant=P01 pipeline=paper "), "{plan}");
}
