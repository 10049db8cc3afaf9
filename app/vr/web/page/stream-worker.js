// Receives a stream and decodes it, away from the page.

import init, { StreamOrder } from './yoro_web.js';
import * as decoding from './decoding.js';

/** The kind of a frame's message. app/vr/stream/src/messages.rs describes what precedes its header. */
const FRAME = 2;
const PREFIX = 8;
/** The decoder takes H.264's constrained baseline profile up to this level (5.1), as the server encodes it. */
const CODEC = 'avc1.42c033';
/** The wait before a lost connection is tried again, in ms. */
const RETRY_DELAY = 1000;

/** How often a WebTransport that has worked before may fail in a row. */
const PATIENCE = 5;
/** The longest wait for a WebTransport, in ms. */
const CONNECT_TIMEOUT = 3000;

/** What the page has sent: `hello`, the message to begin with; the `module`; and, if available, `socket`, the
 * WebSocket's address, and `transport`, the WebTransport's `address` with its certificate's `hash`. */
let begin;
/** The connection, also while it is being made.
 * @type {{name: string, send: (message: Uint8Array) => void, close: () => void} | null} */
let connection = null;
/** True if the WebTransport has failed and there is a WebSocket. */
let useSocket = false;
/** True if the server has ever answered by WebTransport. */
let hasTransported = false;
/** How often in a row the WebTransport has failed. */
let failures = 0;
/** True once the server has answered. */
let answered = false;
/** Puts this connection's frames into their order. @type {StreamOrder | null} */
let order = null;
/** The number of lost frames of this connection. */
let lost = 0;

onmessage = async ({ data }) => {
  if (data.begin) {
    begin = data.begin;
    await init({ module_or_path: begin.module });
    connect();
  } else if (data.end) {
    begin = null;
    connection?.close();
  } else if (data.send && answered) {
    connection?.send(data.send);
    // Said again, so that a lost datagram does not matter.
    connection?.send(order.report());
    miss();
  }
};

function connect() {
  if (!begin || connection) return;
  order = new StreamOrder();
  lost = 0;
  answered = false;
  try {
    connection = begin.transport && !useSocket ? openTransport(begin) : openSocket(begin);
  } catch {
    postMessage({ fault: 'The link is not whole: open the link that the server prints.' });
  }
}

/** Handles a message from the server. @param {ArrayBuffer} message */
function receive(message) {
  decoding.count(message.byteLength);
  if (new Uint8Array(message)[0] === FRAME) {
    take(message);
    return;
  }
  answered = true;
  failures = 0;
  hasTransported ||= !useSocket && Boolean(begin?.transport);
  postMessage({ answer: new Uint8Array(message), by: connection.name });
}

/** Handles the end of the connection. */
function ended() {
  connection = null;
  decoding.end();
  if (begin?.transport && begin.socket) {
    if (answered || useSocket) useSocket = useSocket && answered && !hasTransported;
    else {
      failures += 1;
      // It needs less time than the WebSocket once the network is there again.
      useSocket = failures >= (hasTransported ? PATIENCE : 1);
      if (useSocket) {
        failures = 0;
        connect();
        return;
      }
    }
  }
  answered = false;
  postMessage({ lost: true });
  setTimeout(connect, RETRY_DELAY);
}

function openSocket({ socket: address, hello }) {
  const socket = new WebSocket(address);
  socket.binaryType = 'arraybuffer';
  socket.onopen = () => socket.send(hello);
  socket.onmessage = ({ data }) => receive(data);
  socket.onclose = ended;
  const send = (message) => { if (socket.readyState === WebSocket.OPEN) socket.send(message); };
  return { name: 'WebSocket', send, close: () => socket.close() };
}

function openTransport({ transport: { address, hash }, hello }) {
  const transport = new WebTransport(address, {
    serverCertificateHashes: [{ algorithm: 'sha-256', value: hash }], congestionControl: 'low-latency',
  });
  const datagrams = transport.datagrams.writable.getWriter();
  const whole = (stream) => new Response(stream).arrayBuffer();
  const ignore = () => {};
  const run = async () => {
    await transport.ready;
    const first = await transport.createBidirectionalStream();
    const writer = first.writable.getWriter();
    await writer.write(hello);
    writer.close().catch(ignore);
    receive(await whole(first.readable));
    const streams = transport.incomingUnidirectionalStreams.getReader();
    for (let next = await streams.read(); !next.done; next = await streams.read()) {
      // A frame that the server gives up is skipped.
      whole(next.value).then((frame) => { if (connection === self) receive(frame); }, ignore);
    }
  };
  const self = {
    name: 'WebTransport',
    send: (message) => { datagrams.write(message).catch(ignore); },
    close: () => { try { transport.close(); } catch { /* it has not begun */ } },
  };
  const timer = setTimeout(() => { if (connection === self && !answered) self.close(); }, CONNECT_TIMEOUT);
  for (const promise of [transport.closed, datagrams.closed]) promise.catch(ignore);
  run().catch(ignore).finally(() => {
    clearTimeout(timer);
    self.close();
    ended();
  });
  return self;
}

/** Takes a frame, and decodes the frames whose turn it is. @param {ArrayBuffer} message */
function take(message) {
  const view = new DataView(message);
  order.insert(view.getUint32(4, true), view.getUint8(1) === 1, message, performance.now());
  connection?.send(order.report());
  for (let next = order.pop(); next; next = order.pop()) decode(next);
  if (order.lost() > lost) postMessage({ framesLost: order.lost() - lost });
  lost = order.lost();
  miss();
}

/** Reports a missing frame to the server. */
function miss() {
  const missing = order.missing(performance.now());
  if (missing) connection?.send(missing);
}

function decode(message) {
  const view = new DataView(message);
  const [intra, length, number] = [view.getUint8(1) === 1, view.getUint16(2, true), view.getUint32(4, true)];
  if (!decoding.isStarted()) {
    const own = order;
    decoding.start({ codec: CODEC, optimizeForLatency: true }, () => connection?.close(), null, (done) => own.decoded(done));
  }
  decoding.decode(number, intra, new Uint8Array(message.slice(0, PREFIX + length)), new Uint8Array(message, PREFIX + length));
}
