// Decodes pictures in a worker, and passes the newest one to the page.

/**
 * How the page gets a picture: copied by the CPU into planes, or as the browser's frame. The two alternate at first;
 * then the one that took less time is used.
 */
const WAYS = ['planes', 'frame'];
/** How many pictures are timed for each way, after one that is not. */
const TRIALS = 4;
/** How many pictures a decoder must have decoded to be started again if it fails. */
const TRUSTED_AFTER = 30;

let decoder = null;
/** How many pictures it has decoded. */
let pictures = 0;
/** The headers of the frames that are being decoded, by number. */
const headers = new Map();
/** The number of the newest frame that was decoded. */
let latest = -1;
/** The newest decoded frame, if the page is still busy with the previous one. */
let newest = null;
let pageIsFree = true;
/** Is told each picture that is decoded. @type {(number: number) => void} */
let told = () => {};
let bytes = 0;
/** The way in use, once it is chosen. @type {string | null} */
let way = null;
/** How long pictures took in ms, by way. */
const times = { planes: [], frame: [] };
let skipped = 0;

/** Counts received bytes. @param {number} more */
export function count(more) {
  bytes += more;
}

/**
 * Starts a decoder.
 * @param {VideoDecoderConfig} config
 * @param {() => void} failed called if the decoder fails after having worked
 * @param {(number: number) => void} done called for each picture that is decoded
 */
export function start(config, failed, done = () => {}) {
  told = done;
  headers.clear();
  pictures = 0;
  latest = -1;
  const error = ({ message }) => {
    decoder = null;
    if (pictures >= TRUSTED_AFTER) failed();
    else postMessage({ fault: `This browser cannot decode the H.264 (${message}): update it, or use another one.` });
  };
  decoder = new VideoDecoder({ output: decoded, error });
  decoder.configure(config);
}

/** Ends the decoder, and forgets what the page has not taken. */
export function end() {
  decoder?.close();
  decoder = null;
  newest?.frame?.close();
  newest = null;
}

/** True if there is a decoder. */
export const isStarted = () => Boolean(decoder);

/** Waits until no more than two pictures are queued in the decoder. */
export async function queueShrinks() {
  while (decoder?.decodeQueueSize > 2) await new Promise((resolve) => decoder.addEventListener('dequeue', resolve, { once: true }));
}

/**
 * Decodes a frame.
 * @param {number} number of the frame
 * @param {boolean} intra
 * @param {Uint8Array} head the header, which the page gets with the picture
 * @param {Uint8Array} data
 */
export function decode(number, intra, head, data) {
  headers.set(number, head);
  decoder.decode(new EncodedVideoChunk({ type: intra ? 'key' : 'delta', timestamp: number, data }));
}

addEventListener('message', ({ data }) => {
  // Tests choose the way.
  if (data.way) way = data.way;
  if (!data.free) return;
  // The page is ready for the next frame.
  pageIsFree = true;
  if (data.took && !way) took(data.took);
  deliver();
});

/** Notes how long a picture took. @param {{way: string, ms: number}} picture */
function took({ way: its, ms }) {
  times[its].push(ms);
  if (WAYS.some((each) => times[each].length <= TRIALS)) return;
  const [planes, frame] = WAYS.map((each) => times[each].slice(1).sort((a, b) => a - b)[TRIALS / 2]);
  way = frame < planes ? 'frame' : 'planes';
}

async function decoded(frame) {
  const head = headers.get(frame.timestamp);
  headers.delete(frame.timestamp);
  pictures += 1;
  told(frame.timestamp);
  if (!head) {
    frame.close();
    return;
  }
  const start = performance.now();
  // Some pictures can only be passed in one way.
  const only = ['I420', 'NV12'].includes(frame.format) ? way : 'frame';
  const picture = { number: frame.timestamp, head, way: only ?? WAYS[pictures % 2], isTimed: !only };
  if (picture.way === 'frame') {
    put({ ...picture, frame, ms: 0 });
    return;
  }
  try {
    const planes = await copied(frame);
    put({ ...picture, planes, ms: performance.now() - start });
  } catch (error) {
    postMessage({ fault: error.message });
  } finally {
    frame.close();
  }
}

/** Returns the planes of a frame, one after the other. @param {VideoFrame} frame */
async function copied(frame) {
  const { format, visibleRect } = frame;
  const { width, height } = visibleRect;
  const luma = width * height;
  const planes = new Uint8Array((luma * 3) / 2);
  const layout = [{ offset: 0, stride: width }];
  if (format === 'NV12') layout.push({ offset: luma, stride: width });
  else layout.push({ offset: luma, stride: width / 2 }, { offset: (luma * 5) / 4, stride: width / 2 });
  if (format !== 'I420' && format !== 'NV12') throw new Error(`This browser decodes video as ${format}, of which the page reads no depth.`);
  await frame.copyTo(planes, { rect: visibleRect, layout });
  if (format === 'NV12') planes.set(apart(planes.subarray(luma)), luma);
  return planes;
}

/** Keeps the newest frame until the page takes it. */
function put(picture) {
  // Planes may be ready only after a newer picture, which was passed as a frame.
  const old = picture.number < latest ? picture : newest;
  if (old) {
    skipped += 1;
    old.frame?.close();
  }
  if (old === picture) return;
  latest = picture.number;
  newest = picture;
  deliver();
}

/** Separates interleaved samples into two planes, one after the other. */
function apart(mixed) {
  const planes = new Uint8Array(mixed.length);
  const half = mixed.length / 2;
  for (let i = 0; i < half; i += 1) {
    planes[i] = mixed[2 * i];
    planes[half + i] = mixed[2 * i + 1];
  }
  return planes;
}

/** Passes the newest frame to the page, once that is ready for it. */
function deliver() {
  if (!newest || !pageIsFree) return;
  pageIsFree = false;
  postMessage({ ...newest, bytes, skipped }, { transfer: [newest.frame ?? newest.planes.buffer] });
  [newest, bytes, skipped] = [null, 0, 0];
}
