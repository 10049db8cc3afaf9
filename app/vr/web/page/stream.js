// Moving pictures of one eye with its depth: a stream from a server, or an RGBD video. Passes frames to the module,
// tells the server where the head is, and shows figures.

import { app, element } from './app.js';
import { apply, offerOrbit } from './choices.js';
import { changed, startLoop } from './drawing.js';
import { clear, loading, say } from './messages.js';
import { sentence } from './sentence.js';

/** The longest time between two requests to a server, in ms. Requests are also sent while nothing is drawn. */
const REQUEST_INTERVAL = 100;
/** The time from one line of figures to the next, in ms. */
const FIGURES_INTERVAL = 1000;
/** The answer of a server that serves another page. app/vr/stream/src/messages.rs lists all answers. */
const BUSY = [1, 1];

let worker = null;
/** The file that the worker plays, if any. @type {File | null} */
let playing = null;
let isThere = false;
/** Sums since the last line of figures. */
let sums = { frames: 0, bytes: 0, skipped: 0, latency: 0 };
let last = null;
let timers = [];
/** When the last request was sent to the server. */
let asked = 0;

/** Returns true if this browser can decode. Otherwise says why not. */
function canDecode() {
  const can = 'VideoDecoder' in globalThis;
  if (!can) {
    say(isSecureContext
      ? 'This browser has no WebCodecs, which decode videos for pages: update it, or use another one.'
      : 'Browsers decode videos for a page only over https, or from an address on this machine (localhost).');
  }
  return can;
}

/** Starts a worker that decodes. @param {URL} script */
function start(script) {
  worker = new Worker(script, { type: 'module' });
  worker.onmessage = ({ data }) => {
    try {
      receive(data);
    } catch (error) {
      say(sentence(error));
    }
  };
}

/** Plays an RGBD video in a loop, unless it is paused. @param {File} file */
export function play(file) {
  if (!canDecode()) return;
  if (worker) stop();
  loading(`Reading ${file.name}`);
  start(new URL('video-worker.js', import.meta.url));
  playing = file;
  element('play').checked = true;
  worker.postMessage({ file });
}

/** Pauses or resumes a video. */
function pause() {
  if (playing) worker?.postMessage({ playing: element('play').checked && !document.hidden });
}

/**
 * Follows the stream of the server that the page comes from.
 * @param {string} token
 */
export function follow(token) {
  const hello = app.page.streamHello(token);
  if (!hello) {
    loading(null);
    say('The link’s token is not whole: open the link that the server prints.');
    return;
  }
  if (!canDecode()) return;
  loading('Waiting for the stream');
  element('where').textContent = 'The eye comes from the server, which gets to know where your head is.';
  const begin = { hello, module: app.module, address: `${location.origin.replace(/^http/, 'ws')}/stream` };
  start(new URL('stream-worker.js', import.meta.url));
  worker.postMessage({ begin });
  const keepAlive = () => { if (performance.now() - asked > REQUEST_INTERVAL) request(); };
  timers = [setInterval(keepAlive, REQUEST_INTERVAL), setInterval(figures, FIGURES_INTERVAL)];
  requestAnimationFrame(refresh);
  // A hidden page gives up the stream, so that another page can have it.
  document.addEventListener('visibilitychange', () => {
    if (!playing) worker?.postMessage(document.hidden ? { end: true } : { begin });
  });
}

/** Ends the connection for good. */
function end() {
  worker?.terminate();
  timers.forEach(clearInterval);
  timers = [];
  worker = null;
  playing = null;
  isThere = false;
  if (app.stream) app.stream.there = false;
  loading(null);
}

/** Ends the stream, since something else is shown. */
function stop() {
  end();
  app.stream = null;
  app.settings.stream = null;
}

function receive({ answer, lost, fault, head, way, planes, frame, ms, isTimed, bytes, skipped }) {
  if (!app.page) {
    frame?.close();
    return;
  }
  if (answer) welcome(answer);
  if (fault) {
    end();
    say(fault);
  }
  if (lost && isThere) {
    isThere = false;
    Object.assign(app.stream, { there: false, losses: app.stream.losses + 1 });
    say('The connection to the server is lost; it is tried again each second.');
  } else if (lost && !app.stream && element('message').hidden) {
    say('The server does not answer; it is tried again each second.');
  }
  if (!head) return;
  const start = performance.now();
  let took = null;
  try {
    const facts = app.page.streamFrame(head, frame ?? planes, frame?.displayWidth ?? 0, frame?.displayHeight ?? 0);
    if (!facts.length) return;
    const [time, render, code, quantizer, width, height] = facts;
    if (isTimed) {
      // Wait for the GPU.
      app.gl.readPixels(0, 0, 1, 1, app.gl.RGBA, app.gl.UNSIGNED_BYTE, new Uint8Array(4));
      took = { way, ms: ms + performance.now() - start };
    }
    const latency = performance.now() - time;
    sums.frames += 1;
    sums.bytes += bytes;
    sums.skipped += skipped;
    sums.latency += latency;
    last = { render, code, quantizer, width, height };
    app.stream.frames += 1;
    app.stream.way = way;
    if (!app.busy) changed();
  } finally {
    frame?.close();
    worker?.postMessage({ free: true, took });
  }
}

function welcome(answer) {
  try {
    app.settings.dominant = app.page.streamBegin(answer) ?? app.settings.dominant;
  } catch (error) {
    // Another page may end soon. Every other refusal would be repeated.
    if (BUSY.some((byte, i) => answer[i] !== byte)) end();
    loading(null);
    say(sentence(error));
    return;
  }
  clear();
  loading(null);
  isThere = true;
  app.stream ??= { frames: 0, there: true, losses: 0, ask: request, way: '', choose: (way) => worker?.postMessage({ way }), stop, again: () => { if (playing) play(playing); else location.reload(); } };
  Object.assign(app.stream, { there: true, video: Boolean(playing) });
  Object.assign(app, { source: null, facts: null });
  app.settings.scene = null;
  offerOrbit();
  apply();
  if (playing) element('facts').textContent = playing.name;
  startLoop();
}

document.addEventListener('visibilitychange', pause);
element('play').addEventListener('change', pause);

/** Sends a request at each refresh of the display, after the eyes are drawn, since their pose is newest then. */
function refresh() {
  if (!timers.length) return;
  setTimeout(request);
  requestAnimationFrame(refresh);
}

/** Requests a picture for the eyes' latest pose. During a headset's session, that sends the requests: the page has no
 * refreshes then. */
function request() {
  if (!isThere || !app.page || app.source) return;
  asked = performance.now();
  const message = app.page.streamRequest(asked);
  if (message) worker.postMessage({ send: message });
}

function figures() {
  if (!isThere || !last || !app.page) return;
  const { frames, bytes, skipped, latency } = sums;
  sums = { frames: 0, bytes: 0, skipped: 0, latency: 0 };
  const [cm, degrees] = app.page.streamCorrection() ?? [0, 0];
  element('facts').textContent = frames
    ? `Stream: ${frames} frames/s, ${((bytes * 8) / 1e6).toFixed(2)} Mbit/s, ${(latency / frames).toFixed(0)} ms from the pose to its picture `
      + `(rendered in ${last.render.toFixed(0)}, encoded in ${last.code.toFixed(0)}), corrected by ${cm.toFixed(1)} cm and ${degrees.toFixed(1)}°, ${skipped} skipped, ${last.width}x${last.height}, quantizer ${last.quantizer}.`
    : 'Stream: no frames.';
}
