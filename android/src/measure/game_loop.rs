//! Game loops of Firebase Test Lab: scenarios that play by themselves, write their log lines to a file, and end. The
//! scenarios' labels are in the manifest.

use yoro_settings::Pipeline;

use crate::settings::Pair;

/// Duration in seconds of a step of scenarios 1, 2 and 3. The first five seconds of a step are its warm-up.
const SECONDS: [f32; 3] = [5.0, 65.0, 605.0];
/// The extra that sets another duration per step, for trying out a scenario.
const SECONDS_EXTRA: &str = "seconds";

/// A scenario that is being played: a sequence of settings in one session.
#[derive(Clone, Debug, PartialEq)]
pub struct GameLoop {
    scenario: i32,
    /// Method and pipeline of each step.
    steps: Vec<(&'static str, Pipeline)>,
    seconds: f32,
    step: usize,
    extras: Vec<Pair>,
}

impl GameLoop {
    /// Creates a scenario, with the extras of the intent that requests it; `None` if it does not exist.
    pub fn new(scenario: i32, mut extras: Vec<Pair>) -> Option<GameLoop> {
        let default = Pipeline::default();
        let steps = match scenario {
            1 => Pipeline::ALL.iter().map(|pipeline| ("yoro", *pipeline)).collect(),
            2 => vec![("conventional", default), ("yoro", default), ("mono", default)],
            3 => vec![("yoro", default)],
            _ => return None,
        };
        let given =
            extras.iter().find(|(key, _)| key == SECONDS_EXTRA).and_then(|(_, text)| text.parse().ok());
        let seconds = given.unwrap_or(SECONDS[scenario as usize - 1]);
        extras.retain(|(key, _)| key != SECONDS_EXTRA && key != "scenario");
        Some(GameLoop { scenario, steps, seconds, step: 0, extras })
    }

    /// Returns the settings of the present step. All steps share one session, whose duration grows with them.
    pub fn settings(&self) -> Vec<Pair> {
        let (method, pipeline) = self.steps[self.step];
        let name = if self.scenario == 1 { pipeline.name() } else { method };
        let own = [
            ("scene", "street".to_owned()),
            ("hud", "false".to_owned()),
            ("method", method.to_owned()),
            ("pipeline", pipeline.name().to_owned()),
            ("run", format!("loop-{}-{name}", self.scenario)),
            ("duration", (self.seconds * (self.step + 1) as f32).to_string()),
        ];
        own.map(|(key, value)| (key.to_owned(), value)).into_iter().chain(self.extras.clone()).collect()
    }

    /// True if the scenario compares pictures.
    pub fn checks_pictures(&self) -> bool {
        self.scenario == 1
    }

    /// Goes to the next step; returns false after the last.
    pub fn advance(&mut self) -> bool {
        let has_next = self.step + 1 < self.steps.len();
        self.step += usize::from(has_next);
        has_next
    }
}

#[cfg(test)]
mod tests {
    use yoro_settings::Settings;

    use super::*;

    #[test]
    fn each_scenario_is_one_session_of_settings_that_exist() {
        for (scenario, steps) in [(1, Pipeline::ALL.len()), (2, 3), (3, 1)] {
            let extras = [("scenario", "2"), ("seconds", "4"), ("msaa", "1")];
            let extras = extras.map(|(key, value)| (key.to_owned(), value.to_owned())).to_vec();
            let mut game_loop = GameLoop::new(scenario, extras).unwrap();
            let mut runs = Vec::new();
            assert_eq!(game_loop.checks_pictures(), scenario == 1);
            loop {
                let pairs = game_loop.settings();
                let pairs = pairs.iter().map(|(key, value)| format!("{key}={value}"));
                let settings = Settings::resolve(None, pairs).unwrap();
                runs.push(settings.run.unwrap());
                assert_eq!(settings.duration, Some(4.0 * runs.len() as f32));
                if !game_loop.advance() {
                    break;
                }
            }
            runs.sort();
            runs.dedup();
            assert_eq!(runs.len(), steps, "{runs:?}");
        }
        assert_eq!(GameLoop::new(4, Vec::new()), None);
        assert_eq!(GameLoop::new(0, Vec::new()), None);
    }
}
