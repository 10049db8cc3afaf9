// Receives a stream and decodes it, away from the page.

import init, { StreamOrder } from './yoro_web.js';
import * as decoding from './decoding.js';

/** The kind of a frame's message; what stands before its header is described in app/stream/src/messages.rs. */
const FRAME = 2;
const PREFIX = 8;
/** The decoder takes H.264's constrained baseline profile up to this level (5.1), as the server encodes it. */
const CODEC = 'avc1.42c033';
/** After a connection was lost it is tried again after so long, in ms. */
const AGAIN = 1000;

/** What the page has said: the server's address, and the message with which to begin. */
let begin;
let socket = null;
/** Puts this connection's frames into their order. @type {StreamOrder | null} */
let order = null;
/** Frames of this connection that are lost. */
let lost = 0;

onmessage = async ({ data }) => {
  if (data.begin) {
    begin = data.begin;
    await init({ module_or_path: begin.module });
    connect();
  } else if (data.end) {
    begin = null;
    socket?.close();
  } else if (data.send && socket?.readyState === WebSocket.OPEN) {
    socket.send(data.send);
    miss();
  }
};

function connect() {
  if (!begin || socket) return;
  socket = new WebSocket(begin.address);
  socket.binaryType = 'arraybuffer';
  order = new StreamOrder();
  lost = 0;
  socket.onopen = () => socket.send(begin.hello);
  socket.onmessage = ({ data }) => {
    decoding.count(data.byteLength);
    if (new Uint8Array(data)[0] === FRAME) take(data);
    else postMessage({ answer: new Uint8Array(data) });
  };
  socket.onclose = () => {
    socket = null;
    decoding.end();
    postMessage({ lost: true });
    setTimeout(connect, AGAIN);
  };
}

/** Takes a frame, and decodes those whose turn it is. @param {ArrayBuffer} message */
function take(message) {
  const view = new DataView(message);
  order.insert(view.getUint32(4, true), view.getUint8(1) === 1, message);
  for (let next = order.pop(); next; next = order.pop()) decode(next);
  if (order.lost() > lost) postMessage({ framesLost: order.lost() - lost });
  lost = order.lost();
  miss();
}

/** Names a frame that is missing. */
function miss() {
  const missing = order.missing(performance.now());
  if (missing) socket.send(missing);
}

function decode(message) {
  const view = new DataView(message);
  const [intra, length, number] = [view.getUint8(1) === 1, view.getUint16(2, true), view.getUint32(4, true)];
  if (!decoding.isStarted()) decoding.start({ codec: CODEC, optimizeForLatency: true }, () => socket?.close());
  decoding.decode(number, intra, new Uint8Array(message.slice(0, PREFIX + length)), new Uint8Array(message, PREFIX + length));
}
