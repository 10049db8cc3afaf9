// The page: its elements, and the loop that draws.

import init, { Page, builtinScenes } from './yoro_web.js';
import { listen } from './controls.js';
import { antiAliasing, defaults, format, parse } from './link.js';
import { offerMeasure } from './measure.js';
import { offerFiles } from './files.js';
import { offerPhone } from './phone.js';
import { offerHeadset } from './headset.js';

const element = (id) => document.getElementById(id);
const canvas = element('canvas');
/** Pixels of the canvas that are drawn at most. */
const MAX_PIXELS = 4e6;
/** The settings that have an element of their name. */
const choices = [
  'scene', 'viewpoint', 'method', 'renderer', 'anti-aliasing', 'dominant', 'display', 'scale', 'ipd',
];

/** What the parts of the page share. */
const app = {
  canvas,
  gl: null,
  /** The module's [Page], none while the context is lost. */
  page: null,
  module: null,
  settings: { ...defaults },
  /** What is shown: `{builtin}`, `{main, files}` or `{color, depth}`. */
  source: null,
  /** What the module says of the scene; none for pictures. */
  facts: null,
  /** Whoever draws instead of the loop: a measurement, a viewer, a headset. */
  busy: null,
  say, clear, changed, showSource, startLoop, apply, place, step,
};
// For the console, and for tests.
globalThis.yoro = app;

/** Tells an error or a hint in the page. */
function say(text) {
  const message = element('message');
  message.textContent = text;
  message.hidden = false;
}

function clear() {
  element('message').hidden = true;
}

/** A sentence for whatever was thrown. */
export function sentence(error) {
  if (error instanceof WebAssembly.RuntimeError) {
    return `The module has failed (${error.message}), perhaps for want of memory: reload the page, and choose a smaller scene.`;
  }
  return error.message ?? String(error);
}

/** What is being waited for; with `part`, from 0 to 1, and `count` where it is known how far that is. */
function loading(text, part = null, count = '') {
  element('loading').hidden = !text;
  if (element('loading-text').textContent !== text) element('loading-text').textContent = text ?? '';
  element('loading-count').textContent = count;
  if (part === null) element('progress').removeAttribute('value');
  else element('progress').value = part;
}

let drawn = false;
let scheduled = false;
let last = 0;
let shift = false;
let truth = false;
let controls = null;

/** Something is to be seen that is not on the canvas yet. */
function changed() {
  drawn = false;
  if (!scheduled && !app.busy && app.page) {
    scheduled = true;
    requestAnimationFrame(frame);
  }
}

function startLoop() {
  last = 0;
  changed();
}

function frame(now) {
  scheduled = false;
  if (!app.page || app.busy) return;
  const moving = controls.step(last ? (now - last) / 1000 : 1 / 60, shift);
  last = moving ? now : 0;
  if (moving) place();
  const flicker = app.settings.display === 'flicker';
  const real = flicker && now % 1000 < 500;
  try {
    if (moving || !drawn || real !== truth) {
      resize();
      app.page.draw(canvas.width, canvas.height, real);
      truth = real;
      drawn = true;
      legend();
      if (app.facts && !noted) noteFirst();
    }
    if (moving || flicker) changedLater();
  } catch (error) {
    say(sentence(error));
  }
}

let noted = false;

/** Notes when the first picture was there, in ms since the page was asked for. */
function noteFirst() {
  noted = true;
  const { gl } = app;
  const done = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
  gl.flush();
  const look = () => {
    const state = gl.clientWaitSync(done, 0, 0);
    if (state === gl.TIMEOUT_EXPIRED) {
      setTimeout(look);
      return;
    }
    gl.deleteSync(done);
    const { startTime } = performance.mark('first-picture');
    element('gpu').textContent += `; first picture after ${(startTime / 1000).toFixed(1)} s`;
  };
  setTimeout(look);
}

function changedLater() {
  if (!scheduled) {
    scheduled = true;
    requestAnimationFrame(frame);
  }
}

function resize() {
  const ratio = devicePixelRatio * app.settings.scale;
  const [width, height] = [canvas.clientWidth * ratio, canvas.clientHeight * ratio];
  const less = Math.min(1, Math.sqrt(MAX_PIXELS / Math.max(width * height, 1)));
  const size = [width, height].map((n) => Math.max(16, Math.round(n * less)));
  if (canvas.width !== size[0]) canvas.width = size[0];
  if (canvas.height !== size[1]) canvas.height = size[1];
}

function legend() {
  const { display, dominant } = app.settings;
  const other = dominant === 'right' ? 'Left' : 'Right';
  const texts = {
    difference: `${other} eye: black where it equals a real render, white where it differs by a quarter of the range or more`,
    flicker: `${other} eye: ${truth ? 'really rendered' : app.settings.method}`,
  };
  const text = app.facts ? texts[display] : undefined;
  element('legend').hidden = !text;
  element('legend').textContent = text ?? '';
}

/** Keeps the place in the link. */
function place() {
  app.settings.at = app.page.place ? Array.from(app.page.place) : null;
  keep();
}

let keeping = 0;
function keep() {
  clearTimeout(keeping);
  keeping = setTimeout(() => history.replaceState(null, '', format(app.settings)), 300);
}

const methods = {};
let offered = null;

/** Offers what there is with a renderer. */
function offerRenderer(renderer) {
  offered = renderer;
  element('method').replaceChildren(...methods[renderer].map(({ name, reason }) => {
    const option = new Option(reason ? `${name} (not here)` : name, name);
    option.disabled = Boolean(reason);
    option.title = reason ?? '';
    return option;
  }));
  for (const option of element('anti-aliasing').options) option.disabled = !antiAliasing[renderer].includes(option.value);
}

/** Gives the module the settings, and the elements their values. */
function apply() {
  const { settings } = app;
  if (offered !== settings.renderer) offerRenderer(settings.renderer);
  for (const key of choices) element(key).value = String(settings[key]);
  element('ipd-value').textContent = settings.ipd;
  if (!app.page) return;
  const smoothing = settings['anti-aliasing'];
  app.page.configure(JSON.stringify({
    method: settings.method, renderer: settings.renderer, ipd: settings.ipd / 1000, dominant: settings.dominant,
    display: settings.display,
    ...(smoothing === 'msaa' ? { msaa: 4 } : { 'anti-aliasing': smoothing, msaa: 1 }),
  }));
  keep();
  changed();
}

/** The next method (1) or viewpoint, for controllers. */
function step(what) {
  const options = [...element(what).options].filter((option) => !option.disabled);
  const at = options.findIndex((option) => option.selected);
  const next = options[(at + 1) % options.length];
  if (!next) return;
  element(what).value = next.value;
  element(what).dispatchEvent(new Event('change'));
}

let job = null;

/** How far a scene is: at first textures, then triangles, of which it is known how many there will be. */
function generating(doing, name, { textures, triangles }) {
  const { kiloTriangles } = scenes.find((scene) => scene.name === name);
  const kilo = Math.round(triangles / 1000);
  if (kilo) loading(doing, Math.min(kilo / kiloTriangles, 1), `${kilo} of ${kiloTriangles} thousand triangles`);
  else loading(doing, null, `${textures} textures`);
}

/** Loads and shows a source, from its viewpoint of the settings; what was shown stays until then. */
async function showSource(source, { keepPlace = false } = {}) {
  clear();
  job?.terminate();
  if (source.color) {
    loading('Decoding');
    try {
      app.page.setPictures(
        source.color.name, new Uint8Array(source.color.bytes), source.depth.name, new Uint8Array(source.depth.bytes),
        source.options());
      Object.assign(app, { source, facts: null });
      described();
    } catch (error) {
      say(sentence(error));
    }
    loading(null);
    changed();
    return;
  }
  const doing = source.builtin ? `Generating ${source.builtin}` : `Loading ${source.main}`;
  loading(doing);
  const worker = new Worker('worker.js', { type: 'module' });
  job = worker;
  const answer = await new Promise((resolve) => {
    worker.onmessage = ({ data }) => {
      if (data.bytes || data.error) resolve(data);
      else if (job === worker) generating(doing, source.builtin, data);
    };
    worker.onerror = (event) => resolve({ error: `The scene could not be made (${event.message ?? 'the worker did not start'}).` });
    worker.postMessage({ ...source, module: app.module });
  });
  worker.terminate();
  if (job !== worker) return;
  job = null;
  if (answer.error || !app.page) {
    loading(null);
    if (answer.error) say(answer.error);
    return;
  }
  loading('Compiling shaders');
  // So that the line above is seen.
  await new Promise((resolve) => requestAnimationFrame(() => setTimeout(resolve)));
  try {
    app.facts = JSON.parse(app.page.setScene(answer.bytes));
    app.source = source;
    const count = app.facts.viewpoints;
    element('viewpoint').replaceChildren(...Array.from({ length: count }, (_, i) => new Option(i + 1, i)));
    const { settings } = app;
    if (!keepPlace) Object.assign(settings, { viewpoint: 0, at: null });
    settings.viewpoint = Math.min(settings.viewpoint, count - 1);
    settings.scene = source.builtin ?? settings.scene;
    app.page.goTo(settings.viewpoint);
    if (settings.at) app.page.putAt(new Float32Array(settings.at));
    described();
    apply();
    if (answer.warnings.length) say(answer.warnings.map((text) => `${text}.`).join(' '));
  } catch (error) {
    app.facts = null;
    say(sentence(error));
  }
  loading(null);
  startLoop();
}

function described() {
  const { facts, source } = app;
  element('picture-options').hidden = !source.color;
  element('facts').textContent = facts
    ? `${source.builtin ?? source.main}: ${facts.triangles.toLocaleString('en')} triangles, ${facts.style}`
    : `${source.color.name} with ${source.depth.name}`;
}

/** Takes the canvas's context; whether it can render. */
function attach() {
  app.gl = canvas.getContext('webgl2', {
    alpha: false, antialias: false, depth: false, stencil: false, powerPreference: 'high-performance',
  });
  if (!app.gl) {
    say('This browser has no WebGL 2: update it, allow hardware acceleration in its settings, or use another one.');
    loading(null);
    return false;
  }
  try {
    app.page = new Page(app.gl);
  } catch (error) {
    say(sentence(error));
    loading(null);
    return false;
  }
  return true;
}

function listenToElements() {
  const numbers = ['viewpoint', 'scale', 'ipd'];
  for (const key of choices) {
    element(key).addEventListener(key === 'ipd' ? 'input' : 'change', ({ target }) => {
      const before = { ...app.settings };
      const value = numbers.includes(key) ? Number(target.value) : target.value;
      if (!app.page) return;
      clear();
      if (key === 'scene') {
        showSource({ builtin: value });
        return;
      }
      app.settings[key] = value;
      if (key === 'renderer') [app.settings['anti-aliasing']] = antiAliasing[value];
      if (key === 'viewpoint') {
        app.settings.at = null;
        app.page.goTo(value);
      }
      try {
        apply();
      } catch (error) {
        app.settings = before;
        apply();
        say(sentence(error));
      }
    });
  }
  element('share').addEventListener('click', async () => {
    history.replaceState(null, '', format(app.settings));
    try {
      await navigator.clipboard.writeText(location.href);
      element('facts').textContent = 'The link is in the clipboard.';
    } catch {
      element('facts').textContent = location.href;
    }
  });
  element('fullscreen').addEventListener('click', () => {
    element('stage').requestFullscreen?.().catch((error) => say(`Full screen is not allowed: ${error.message}.`));
  });
  element('fullscreen').hidden = !document.fullscreenEnabled;
  addEventListener('keydown', (event) => { shift = event.shiftKey; });
  addEventListener('keyup', (event) => { shift = event.shiftKey; });
  new ResizeObserver(changed).observe(canvas);
  addEventListener('hashchange', () => {
    const before = app.settings.scene;
    readLink();
    if (app.settings.scene !== before) showSource({ builtin: app.settings.scene }, { keepPlace: true });
    else if (app.page) {
      app.page.goTo(app.settings.viewpoint);
      if (app.settings.at) app.page.putAt(new Float32Array(app.settings.at));
      apply();
    }
  });
  canvas.addEventListener('webglcontextlost', (event) => {
    event.preventDefault();
    app.busy?.stop?.();
    app.page?.free();
    Object.assign(app, { page: null, busy: null });
    say('The GPU has lost the picture. It comes back by itself as soon as the browser gives the GPU back; if it does not, reload the page.');
  });
  canvas.addEventListener('webglcontextrestored', () => {
    if (!attach()) return;
    clear();
    apply();
    if (app.source) showSource(app.source, { keepPlace: true });
  });
}

let scenes = [];

function readLink() {
  const here = (list) => list.filter(({ reason }) => !reason).map(({ name }) => name);
  const { settings, faults } = parse(location.hash, {
    scenes: here(scenes),
    methods: Object.fromEntries(Object.entries(methods).map(([renderer, list]) => [renderer, here(list)])),
  });
  app.settings = settings;
  if (faults.length) say(faults.join(' '));
}

async function start() {
  listenToElements();
  const url = new URL('yoro_web_bg.wasm', import.meta.url);
  try {
    app.module = await WebAssembly.compileStreaming(fetch(url));
    await init({ module_or_path: app.module });
  } catch (error) {
    loading(null);
    say(`The page's module could not be loaded (${error.message}): reload the page, or update the browser.`);
    return;
  }
  if (!attach()) return;
  scenes = JSON.parse(builtinScenes());
  element('scene').replaceChildren(...scenes.map(({ name, title, kiloTriangles }) => {
    const option = new Option(`${name} (${kiloTriangles}k)`, name);
    option.title = title;
    return option;
  }));
  for (const renderer of Object.keys(antiAliasing)) {
    methods[renderer] = JSON.parse(app.page.methods(JSON.stringify({ renderer })));
  }
  element('gpu').textContent = `${app.page.gpu}; ${app.page.glVersion}`;
  controls = listen(canvas, {
    turn: (left, up) => { app.page?.turn(left, up); },
    walk: (right, up, ahead) => { app.page?.walk(right, up, ahead); },
  }, () => { if (app.page) { place(); changed(); } });
  readLink();
  const faults = element('message').hidden ? null : element('message').textContent;
  apply();
  offerMeasure(app);
  offerFiles(app);
  offerPhone(app);
  offerHeadset(app);
  await showSource({ builtin: app.settings.scene }, { keepPlace: true });
  if (faults) say(faults);
  app.ready = true;
  // Loaded once, the page works without a network, where browsers allow that: over https and on this machine. What is kept
  // for that is fetched once more, which is not to delay the first picture.
  if ('serviceWorker' in navigator) navigator.serviceWorker.register('offline.js').catch(() => {});
}

start();
