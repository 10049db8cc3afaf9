// Receives a stream and decodes it, away from the page.

import init, { StreamReport } from './yoro_web.js';
import * as decoding from './decoding.js';

/** The kind of a frame's message. app/vr/stream/src/messages.rs describes what precedes its header. */
const FRAME = 2;
const PREFIX = 8;
/** The decoder takes H.264's constrained baseline profile up to this level (5.1), as the server encodes it. */
const CODEC = 'avc1.42c033';
/** The wait before a lost connection is tried again, in ms. */
const RETRY_DELAY = 1000;

/** What the page has sent: `hello`, the message to begin with; the `module`; and the `address` of the WebSocket. */
let begin;
/** The connection, also while it is being made. @type {WebSocket | null} */
let connection = null;
/** True once the server has answered. */
let answered = false;
/** What has become of this connection's frames. @type {StreamReport | null} */
let report = null;

onmessage = async ({ data }) => {
  if (data.begin) {
    begin = data.begin;
    await init({ module_or_path: begin.module });
    connect();
  } else if (data.end) {
    begin = null;
    connection?.close();
  } else if (data.send && answered) {
    send(data.send);
    send(report.message());
  }
};

function connect() {
  if (!begin || connection) return;
  report = new StreamReport();
  answered = false;
  connection = new WebSocket(begin.address);
  connection.binaryType = 'arraybuffer';
  connection.onopen = () => send(begin.hello);
  connection.onmessage = ({ data }) => receive(data);
  connection.onclose = ended;
}

/** Sends a message, unless the connection is being made or closed. @param {Uint8Array<ArrayBuffer>} message */
function send(message) {
  if (connection?.readyState === WebSocket.OPEN) connection.send(message);
}

/** Handles a message from the server. @param {ArrayBuffer} message */
function receive(message) {
  decoding.count(message.byteLength);
  if (new Uint8Array(message)[0] === FRAME) {
    decode(message);
    return;
  }
  answered = true;
  postMessage({ answer: new Uint8Array(message) });
}

/** Handles the end of the connection. */
function ended() {
  connection = null;
  answered = false;
  decoding.end();
  postMessage({ lost: true });
  setTimeout(connect, RETRY_DELAY);
}

/** Decodes a frame. @param {ArrayBuffer} message */
function decode(message) {
  const view = new DataView(message);
  const [intra, length, number] = [view.getUint8(1) === 1, view.getUint16(2, true), view.getUint32(4, true)];
  report.arrived(number, performance.now());
  send(report.message());
  if (!decoding.isStarted()) {
    const own = report;
    decoding.start({ codec: CODEC, optimizeForLatency: true }, () => connection?.close(), (done) => own.decoded(done));
  }
  decoding.decode(number, intra, new Uint8Array(message.slice(0, PREFIX + length)), new Uint8Array(message, PREFIX + length));
}
