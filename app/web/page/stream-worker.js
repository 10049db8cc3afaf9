// Receives a stream and decodes it, away from the page.

/** The kind of a frame's message; what stands before its header is described in app/stream/src/messages.rs. */
const FRAME = 2;
const PREFIX = 8;
/** The decoder takes H.264's constrained baseline profile up to this level (5.1), as the server codes it. */
const CODEC = 'avc1.42c033';
/** After a connection was lost it is tried again after so long, in ms. */
const AGAIN = 1000;
/** A decoder that fails before so many pictures would fail again. */
const STEADY = 30;

/** What the page has said: the server's address, and the message with which to begin. */
let begin;
let socket = null;
let decoder = null;
/** Pictures that it has decoded. */
let pictures = 0;
/** The heads of the frames that are being decoded, by number. */
const heads = new Map();
/** The newest decoded frame, if the page is still busy with the one before. */
let newest = null;
let pageIsFree = true;
let bytes = 0;
let skipped = 0;

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
  if (data.free) {
    pageIsFree = true;
    hand();
  }
};

function connect() {
  if (!begin || socket) return;
  socket = new WebSocket(begin.address);
  socket.binaryType = 'arraybuffer';
  socket.onopen = () => socket.send(begin.hello);
  socket.onmessage = ({ data }) => {
    bytes += data.byteLength;
    if (new Uint8Array(data)[0] === FRAME) decode(data);
    else postMessage({ answer: new Uint8Array(data) });
  };
  socket.onclose = () => {
    socket = null;
    decoder?.close();
    decoder = null;
    postMessage({ lost: true });
    setTimeout(connect, AGAIN);
  };
}

function start() {
  heads.clear();
  pictures = 0;
  const error = ({ message }) => {
    decoder = null;
    // A new connection begins with an intra frame.
    if (pictures >= STEADY) socket?.close();
    else postMessage({ fault: `This browser cannot decode the stream’s H.264 (${message}): update it, or use another one.` });
  };
  decoder = new VideoDecoder({ output: decoded, error });
  decoder.configure({ codec: CODEC, optimizeForLatency: true });
}

function decode(message) {
  const view = new DataView(message);
  const [intra, length, number] = [view.getUint8(1) === 1, view.getUint16(2, true), view.getUint32(4, true)];
  if (!intra && !decoder) return;
  if (!decoder) start();
  heads.set(number, new Uint8Array(message.slice(0, PREFIX + length)));
  decoder.decode(new EncodedVideoChunk({
    type: intra ? 'key' : 'delta', timestamp: number, data: new Uint8Array(message, PREFIX + length),
  }));
}

async function decoded(frame) {
  const head = heads.get(frame.timestamp);
  heads.delete(frame.timestamp);
  pictures += 1;
  const { width, height } = frame.visibleRect;
  const [luma, format] = [width * height, frame.format];
  const planes = new Uint8Array((luma * 3) / 2);
  const layout = [{ offset: 0, stride: width }];
  if (format === 'NV12') layout.push({ offset: luma, stride: width });
  else layout.push({ offset: luma, stride: width / 2 }, { offset: (luma * 5) / 4, stride: width / 2 });
  try {
    if (format !== 'I420' && format !== 'NV12') throw new Error(`This browser decodes video as ${format}, which the page cannot show.`);
    await frame.copyTo(planes, { rect: frame.visibleRect, layout });
    if (format === 'NV12') planes.set(apart(planes.subarray(luma)), luma);
  } catch (error) {
    postMessage({ fault: error.message });
    return;
  } finally {
    frame.close();
  }
  if (!head) return;
  if (newest) skipped += 1;
  newest = { head, planes };
  hand();
}

/** Returns two planes of samples that take turns. */
function apart(mixed) {
  const planes = new Uint8Array(mixed.length);
  const half = mixed.length / 2;
  for (let i = 0; i < half; i += 1) {
    planes[i] = mixed[2 * i];
    planes[half + i] = mixed[2 * i + 1];
  }
  return planes;
}

/** Gives the page the newest frame, once it has taken the one before. */
function hand() {
  if (!newest || !pageIsFree) return;
  pageIsFree = false;
  postMessage({ ...newest, bytes, skipped }, { transfer: [newest.planes.buffer] });
  [newest, bytes, skipped] = [null, 0, 0];
}
