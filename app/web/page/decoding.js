// Decodes pictures in a worker, and gives the page the newest one.

/** A decoder that fails before so many pictures would fail again. */
const STEADY = 30;

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

/** Counts bytes that have come. @param {number} more */
export function count(more) {
  bytes += more;
}

/**
 * Starts a decoder.
 * @param {VideoDecoderConfig} config
 * @param {() => void} failed it has failed after having worked
 */
export function start(config, failed) {
  heads.clear();
  pictures = 0;
  const error = ({ message }) => {
    decoder = null;
    if (pictures >= STEADY) failed();
    else postMessage({ fault: `This browser cannot decode the H.264 (${message}): update it, or use another one.` });
  };
  decoder = new VideoDecoder({ output: decoded, error });
  decoder.configure(config);
}

/** Ends the decoder. */
export function end() {
  decoder?.close();
  decoder = null;
}

/** True if there is a decoder. */
export const isStarted = () => Boolean(decoder);

/** Waits until few pictures wait for the decoder. */
export async function calm() {
  while (decoder?.decodeQueueSize > 2) await new Promise((resolve) => decoder.addEventListener('dequeue', resolve, { once: true }));
}

/**
 * Decodes a frame.
 * @param {number} number of the frame
 * @param {boolean} intra
 * @param {Uint8Array} head what the page gets beside the picture
 * @param {Uint8Array} data
 */
export function decode(number, intra, head, data) {
  heads.set(number, head);
  decoder.decode(new EncodedVideoChunk({ type: intra ? 'key' : 'delta', timestamp: number, data }));
}

/** The page takes the next frame. */
export function free() {
  pageIsFree = true;
  hand();
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
