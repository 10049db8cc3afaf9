// Receives a stream and decodes it, away from the page.

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

onmessage = ({ data }) => {
  if (data.begin) {
    begin = data.begin;
    connect();
  } else if (data.end) {
    begin = null;
    socket?.close();
  } else if (data.send && socket?.readyState === WebSocket.OPEN) {
    socket.send(data.send);
  }
};

function connect() {
  if (!begin || socket) return;
  socket = new WebSocket(begin.address);
  socket.binaryType = 'arraybuffer';
  socket.onopen = () => socket.send(begin.hello);
  socket.onmessage = ({ data }) => {
    decoding.count(data.byteLength);
    if (new Uint8Array(data)[0] === FRAME) decode(data);
    else postMessage({ answer: new Uint8Array(data) });
  };
  socket.onclose = () => {
    socket = null;
    decoding.end();
    postMessage({ lost: true });
    setTimeout(connect, AGAIN);
  };
}

function decode(message) {
  const view = new DataView(message);
  const [intra, length, number] = [view.getUint8(1) === 1, view.getUint16(2, true), view.getUint32(4, true)];
  if (!intra && !decoding.isStarted()) return;
  // A new connection begins with an intra frame.
  if (!decoding.isStarted()) decoding.start({ codec: CODEC, optimizeForLatency: true }, () => socket?.close());
  decoding.decode(number, intra, new Uint8Array(message.slice(0, PREFIX + length)), new Uint8Array(message, PREFIX + length));
}
