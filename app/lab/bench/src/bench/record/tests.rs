use super::file::lines;
use super::*;
use std::fs;

fn header() -> Header {
    Header {
        yoro_bench: VERSION,
        suites: vec!["ipd".into()],
        quick: true,
        machine: Machine { gl_renderer: "llvmpipe".into(), ..Machine::default() },
        pass_clock: PassClock::Finish,
        parameters: vec![Parameter { name: "rounds".into(), value: "2".into() }],
    }
}

fn conditions(point: f64) -> Conditions {
    Conditions { suite: "ipd".into(), scene: "talk".into(), label: None, point: Some(point) }
}

fn round(point: f64, round: u32) -> (Vec<Record>, RoundEnd) {
    let mut measurement = Measurement {
        conditions: conditions(point),
        contender: "mono".into(),
        round,
        values: BTreeMap::new(),
    };
    measurement.push(metric::PSNR, f64::INFINITY);
    measurement.push(metric::PSNR, 31.5);
    measurement.push(metric::SSIM, 0.95);
    let reason = "no GL_OVR_multiview2".into();
    let unsupported = Unsupported { conditions: conditions(point), contender: "multiview".into(), reason };
    let records = vec![Record::Unsupported(unsupported), Record::Measurement(measurement)];
    (records, RoundEnd { conditions: conditions(point), round })
}

fn append(writer: &mut Writer, point: f64, number: u32) {
    let (records, end) = round(point, number);
    writer.append(records, end).unwrap();
}

#[test]
fn rounds_come_back_as_they_were_written() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("new/run.jsonl");
    let (mut writer, before) = Writer::open(&path, &header()).unwrap();
    assert!(before.records.is_empty());
    append(&mut writer, 62.5, 0);
    append(&mut writer, 62.5, 1);
    drop(writer);
    let results = Results::read(&path).unwrap();
    assert_eq!(results.header, header());
    assert_eq!((results.rounds(&conditions(62.5)), results.rounds(&conditions(63.0))), (2, 0));
    let measurement = results.measurements().next().unwrap();
    assert_eq!(measurement.values[metric::PSNR], [None, Some(31.5)]);
    assert_eq!(measurement.finite(metric::PSNR).collect::<Vec<_>>(), [31.5]);
    assert_eq!(results.unsupported().count(), 2);
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.starts_with(r#"{"record":"header","yoro_bench":1,"#), "{text}");
}

#[test]
fn a_run_cut_off_anywhere_resumes() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("run.jsonl");
    let (mut writer, _) = Writer::open(&path, &header()).unwrap();
    append(&mut writer, 50.0, 0);
    let finished = fs::metadata(&path).unwrap().len() as usize;
    append(&mut writer, 55.0, 0);
    drop(writer);
    let whole = fs::read(&path).unwrap();
    for length in finished..whole.len() {
        fs::write(&path, &whole[..length]).unwrap();
        let (mut writer, results) = Writer::open(&path, &header()).unwrap();
        assert_eq!(
            (results.rounds(&conditions(50.0)), results.rounds(&conditions(55.0))),
            (1, 0),
            "{length}"
        );
        append(&mut writer, 55.0, 0);
        assert_eq!(fs::read(&path).unwrap(), whole, "{length}");
    }
}

#[test]
fn other_parameters_are_refused_and_the_file_stays() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("run.jsonl");
    Writer::open(&path, &header()).unwrap();
    let before = fs::read(&path).unwrap();
    let mut later = header();
    later.machine.date = "2026-01-02T00:00:00Z".into();
    later.machine.command = "yoro bench ipd --out run.jsonl".into();
    Writer::open(&path, &later).unwrap();
    let refused = |change: fn(&mut Header)| {
        let mut other = header();
        change(&mut other);
        Writer::open(&path, &other).unwrap_err().to_string()
    };
    let error = refused(|h| h.parameters[0].value = "5".into());
    assert!(error.contains("run.jsonl holds results with rounds = 2, and this run has 5"), "{error}");
    let error = refused(|h| h.parameters.clear());
    assert!(error.contains("rounds = 2, and this run has nothing"), "{error}");
    let error = refused(|h| h.machine.gl_renderer = "a GPU".into());
    assert!(error.contains("GL renderer = llvmpipe"), "{error}");
    assert_eq!(fs::read(&path).unwrap(), before);
}

#[test]
fn foreign_and_damaged_files_are_named() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("run.jsonl");
    let says = |bytes: &[u8]| {
        fs::write(&path, bytes).unwrap();
        let read = Results::read(&path).unwrap_err().to_string();
        let opened = Writer::open(&path, &header()).unwrap_err().to_string();
        assert_eq!(read, opened);
        assert_eq!(fs::read(&path).unwrap(), bytes, "it was changed");
        read
    };
    for foreign in [&b"a letter\n"[..], b"{\"name\":1}\n", b"\x89PNG\r\n\x1a\n", b"[1]"] {
        assert!(says(foreign).contains("run.jsonl is not a result of yoro bench"));
    }
    assert!(says(b"{\"record\":\"header\",\"yoro_bench\":7}\n").contains("version 7"));
    assert!(says(b"{\"record\":\"header\",\"yoro_bench\":1}\n").contains("line 1 is damaged"));
    let mut bytes = lines(&[Record::Header(header())]);
    bytes.extend_from_slice(b"{\"record\":\"meas\n");
    let (records, end) = round(50.0, 0);
    bytes.extend(lines(&records));
    bytes.extend(lines(&[Record::Round(end)]));
    let error = says(&bytes);
    assert!(error.contains("run.jsonl, line 2 is damaged"), "{error}");
    fs::remove_file(&path).unwrap();
    assert!(Results::read(&path).unwrap_err().to_string().contains("does not exist"));
}

/// A run that is killed before it writes its first line leaves such a file.
#[test]
fn an_empty_file_is_begun() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("run.jsonl");
    fs::write(&path, b"").unwrap();
    assert!(Results::read(&path).unwrap_err().to_string().contains("is not a result of yoro bench"));
    let (_, results) = Writer::open(&path, &header()).unwrap();
    assert!(results.records.is_empty());
    assert_eq!(Results::read(&path).unwrap().header, header());
}
