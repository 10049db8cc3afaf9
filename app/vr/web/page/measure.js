// Compares the methods' times, and makes a file that `yoro report` reads.

import { Bench } from './yoro_web.js';
import { app, element } from './app.js';
import { startLoop } from './drawing.js';
import { clear, isFree, say } from './messages.js';
import { sentence } from './sentence.js';
import { median, nextFrame, nextTask } from './timing.js';

/** The shortest batch of frames, in ms: browsers round their clocks to between 0.005 and 1 ms. */
const BATCH = 50;
/** The number of frames with timer queries in each turn. Their results arrive some frames late. */
const TIMED_FRAMES = 10;
const VIEWPOINTS = 3;

/** Measures the refresh rate of the display in Hz, from the callbacks within a third of a second. */
async function refreshRate() {
  const times = [];
  const start = await nextFrame();
  while (times.length < 3 || (times.at(-1) - start < 330 && times.length < 60)) times.push(await nextFrame());
  const steps = times.slice(1).map((time, i) => time - times[i]);
  return 1000 / median(steps);
}

/** Measures the smallest step of the page's clock in ms. */
function clockStep() {
  let smallest = Infinity;
  for (let i = 0, last = performance.now(); i < 2e4 && smallest > 0.001; i++) {
    const now = performance.now();
    if (now > last) smallest = Math.min(smallest, now - last);
    last = now;
  }
  return Number.isFinite(smallest) ? smallest : 1;
}

/**
 * Measures the methods. Returns null if the run is stopped.
 * @param {Bench} bench the methods, with images of the wanted size
 */
async function measure(bench, seconds, run) {
  const { page } = app;
  const rate = await refreshRate();
  const facts = JSON.parse(bench.facts);
  const { contenders } = facts;
  const count = Math.min(VIEWPOINTS, app.facts.viewpoints);
  const viewpoints = Array.from({ length: count }, (_, i) => Math.floor((i * app.facts.viewpoints) / count));
  const turn = async (contender, viewpoint, milliseconds) => {
    // Find the number of frames that makes a batch long enough. The first frame is not measured.
    let frames = 1;
    let best = [];
    const end = performance.now() + milliseconds;
    bench.frames(page, contender, viewpoint, 1);
    do {
      const start = performance.now();
      bench.frames(page, contender, viewpoint, frames);
      const taken = performance.now() - start;
      if (taken < BATCH && performance.now() < end) {
        frames = Math.min(1000, Math.max(frames + 1, Math.ceil((frames * BATCH * 1.2) / Math.max(taken, 0.5))));
        best = [];
      } else {
        best.push(taken / frames);
      }
      await nextTask();
      if (run.stopped) return null;
    } while (performance.now() < end || best.length === 0);
    return { ms: median(best), frames };
  };
  const timed = async (contender, viewpoint) => {
    if (!facts.timerQueries) return {};
    bench.startPasses();
    for (let i = 0; i < TIMED_FRAMES; i++) {
      bench.timedFrame(page, contender, viewpoint);
      await nextFrame();
      if (run.stopped) return {};
    }
    return JSON.parse(bench.takePasses());
  };
  const turns = contenders.length * viewpoints.length;
  const rounds = Math.max(2, Math.min(10, Math.round((seconds * 1000) / (turns * 300))));
  const share = (seconds * 1000) / (turns * rounds);
  const records = [];
  let done = 0;
  for (let round = -1; round < rounds; round++) {
    for (const [index, name] of contenders.entries()) {
      const values = { frame_ms: [] };
      for (const viewpoint of viewpoints) {
        // Round -1 warms up: it compiles the shaders and makes the targets.
        const result = await turn(index, viewpoint, round < 0 ? 0 : share);
        if (!result) return null;
        values.frame_ms.push(result.ms);
        run.frames = Math.max(run.frames ?? 0, result.frames);
        if (round >= 0) run.progress(++done / (turns * rounds));
      }
      if (round < 0) continue;
      const passes = await timed(index, viewpoints[0]);
      if (run.stopped) return null;
      const total = Object.values(passes).reduce((sum, ms) => sum + ms, 0);
      if (total > 0) values.gpu_ms = [total];
      for (const [pass, ms] of Object.entries(passes)) values[`pass_ms/${pass}`] = [ms];
      records.push({ contender: name, round, values });
    }
  }
  return { facts, records, rounds, viewpoints, rate, clock: clockStep() };
}

function machine() {
  const platform = navigator.userAgentData?.platform || navigator.platform || 'not told';
  return {
    cpu: 'a processor that browsers do not name', cores: navigator.hardwareConcurrency ?? 0, os: platform, gl_renderer: app.page.gpu,
    gl_version: app.page.glVersion, yoro: app.page.version, date: `${new Date().toISOString().slice(0, 19)}Z`,
    command: `the page, ${location.hash || '#'}`,
  };
}

/** Returns the result as JSON lines, as `yoro bench` writes them. `settings` are those at the start of the run. */
function lines(settings, size, seconds, result) {
  const setting = { suite: 'scenes', scene: app.facts.name };
  const { facts, records, rounds, rate, clock } = result;
  const parameters = {
    'size per eye, pixels': size.join('x'),
    'IPD, mm': String(settings.ipd),
    'dominant eye': settings.dominant,
    'samples per pixel': String(settings.msaa),
    'seconds': String(seconds),
    'browser': navigator.userAgent,
    'refresh rate of the display, Hz': rate.toFixed(1),
    'step of the clock, ms': clock.toFixed(4),
    'frame time': 'several stereo frames without waiting, up to reading back a pixel',
    'GPU time by pass': facts.timerQueries ? 'EXT_disjoint_timer_query_webgl2' : 'not told',
  };
  /** @type {object[]} */
  const out = [{
    record: 'header', yoro_bench: 1, suites: ['scenes'], quick: seconds < 30, machine: machine(),
    pass_clock: facts.timerQueries ? 'timer-queries' : 'none',
    parameters: Object.entries(parameters).map(([name, value]) => ({ name, value })),
  }, {
    record: 'scene', ...setting, stands_for: app.facts.standsFor, style: app.facts.style, triangles: app.facts.triangles,
    lights: app.facts.lights, frames: result.viewpoints.map((index) => `viewpoint ${index}`),
  }];
  for (const [contender, reason] of facts.unsupported) out.push({ record: 'unsupported', ...setting, contender, reason });
  for (let round = 0; round < rounds; round++) {
    for (const record of records) if (record.round === round) out.push({ record: 'measurement', ...setting, ...record });
    out.push({ record: 'round', ...setting, round });
  }
  return `${out.map((record) => JSON.stringify(record)).join('\n')}\n`;
}

function cell(kind, text, scope) {
  const made = document.createElement(kind);
  made.textContent = text;
  if (scope) made.scope = scope;
  return made;
}

function show(size, result, run) {
  const { facts, records, rate, clock } = result;
  const of = (name) => records.filter((record) => record.contender === name);
  const ratio = (name, metric) => {
    const base = of('conventional');
    const ratios = of(name).flatMap(({ values }, i) =>
      (values[metric] ?? []).map((ms, frame) => ms / base[i]?.values[metric]?.[frame]));
    return ratios.filter(Number.isFinite);
  };
  const figure = (values, digits, unit = '') => (values.length ? `${median(values).toFixed(digits)}${unit}` : 'not told');
  const table = document.createElement('table');
  const caption = table.createCaption();
  caption.textContent = `${app.page.gpu}: ${app.facts.name}, ${size.join('x')} pixels of each eye, ${app.settings.msaa} samples a pixel, ${records.length / facts.contenders.length} rounds`;
  const head = table.createTHead().insertRow();
  for (const text of ['Method', 'Of two renders', 'Frame, ms', 'GPU, ms']) head.append(cell('th', text, 'col'));
  const body = table.createTBody();
  for (const name of facts.contenders) {
    const row = body.insertRow();
    row.append(
      cell('th', name, 'row'),
      cell('td', figure(ratio(name, 'frame_ms').map((r) => r * 100), 0, ' %')),
      cell('td', figure(of(name).flatMap(({ values }) => values.frame_ms), 2)),
      cell('td', figure(of(name).flatMap(({ values }) => values.gpu_ms ?? []), 2)));
  }
  const passes = document.createElement('details');
  passes.append(cell('summary', 'GPU time by pass'));
  for (const name of facts.contenders) {
    const names = new Set(of(name).flatMap(({ values }) => Object.keys(values).filter((key) => key.startsWith('pass_ms/'))));
    const parts = [...names].map((key) =>
      `${key.slice(8)} ${median(of(name).flatMap(({ values }) => values[key] ?? [])).toFixed(3)} ms`);
    passes.append(cell('p', `${name}: ${parts.join(', ') || 'not told'}`));
  }
  const notes = [
    `Frame: wall clock of up to ${run.frames} stereo frames one after the other, up to reading back a pixel, so that frames faster than the display’s ${rate.toFixed(0)} Hz can be told apart. The clock's step is ${clock.toFixed(3)} ms; a batch is ${BATCH} ms or longer.`,
    facts.timerQueries
      ? 'GPU: timer queries around each pass, in frames of their own. Browsers round them, some to a tenth of a millisecond.'
      : 'GPU: not told. This browser hides timer queries (EXT_disjoint_timer_query_webgl2), or the CPU renders.',
    'A phone slows down as it warms up; the methods take turns, so that their ratio changes less than their times.',
  ];
  element('measure-result').replaceChildren(table, ...(facts.timerQueries ? [passes] : []), ...notes.map((text) => {
    const note = cell('p', text);
    note.className = 'note';
    return note;
  }));
}

/** Locks the controls that a measurement depends on. @param {boolean} locked */
function lock(locked) {
  for (const id of ['look', 'own', 'measure-fields']) element(id).disabled = locked;
}

/** Sets up the panel. */
export function offerMeasure() {
  const [button, save, bar] = ['measure', 'measure-save', 'measure-progress'].map(element);
  let file = null;
  button.addEventListener('click', async () => {
    if (app.busy?.name === 'measure') {
      app.busy.stop();
      return;
    }
    if (!isFree('A measurement needs')) return;
    clear();
    const size = element('measure-size').value.split('x').map(Number);
    const seconds = Number(element('measure-seconds').value);
    const run = {
      name: 'measure', end: 'A measurement is running: stop it first.', stopped: false,
      progress: (part) => { bar.value = part; }, stop() { this.stopped = true; },
    };
    const settings = { ...app.settings };
    app.busy = run;
    lock(true);
    Object.assign(bar, { hidden: false, value: 0 });
    button.textContent = 'Stop';
    save.disabled = true;
    await nextFrame();
    let bench = null;
    try {
      bench = new Bench(app.page, ...size);
      const result = await measure(bench, seconds, run);
      if (result) {
        show(size, result, run);
        file = lines(settings, size, seconds, result);
        app.measured = file;
      }
    } catch (error) {
      say(sentence(error));
    }
    bench?.free();
    bar.hidden = true;
    button.textContent = 'Measure';
    // The figures of an earlier run stay available.
    Object.assign(save, { hidden: !file, disabled: false });
    lock(false);
    if (app.busy === run) app.busy = null;
    startLoop();
  });
  save.addEventListener('click', () => {
    const link = document.createElement('a');
    link.href = URL.createObjectURL(new Blob([file], { type: 'application/jsonl' }));
    link.download = `yoro-${app.page.gpu.replace(/[^\w]+/g, '-').slice(0, 60)}.jsonl`;
    link.click();
    URL.revokeObjectURL(link.href);
  });
}
