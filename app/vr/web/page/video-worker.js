// Reads an RGBD video and decodes it at its own pace, in a loop, away from the page.

import init, { Video } from './yoro_web_video.js';
import * as decoding from './decoding.js';

/** A picture that is later than this, in ms, delays all pictures after it. */
const LATE = 100;
/** How many numbers the module's list has for each picture. */
const NUMBERS = 6;

let isPlaying = true;
/** Ends the pause. @type {(value?: unknown) => void} */
let goOn = () => {};

onmessage = async ({ data }) => {
  if ('playing' in data) {
    isPlaying = data.playing;
    if (isPlaying) goOn();
  }
  if (!data.file) return;
  try {
    await init({ module_or_path: new URL('yoro_web_video_bg.wasm', import.meta.url) });
    await play(data.file);
  } catch (error) {
    const full = error instanceof WebAssembly.RuntimeError || error instanceof RangeError;
    postMessage({ fault: full ? `${data.file.name} cannot be read: it is damaged, or there is no memory for it.` : error.message });
  }
};

/** Returns part of a file as bytes. */
function part(file, position, length) {
  return new Uint8Array(new FileReaderSync().readAsArrayBuffer(file.slice(position, position + length)));
}

async function play(file) {
  const video = new Video(file.name, file.size, (position, length) => part(file, position, length));
  const pictures = video.pictures();
  const count = pictures.length / NUMBERS;
  postMessage({ answer: video.welcome() });
  const config = { codec: video.codec(), description: video.description(), optimizeForLatency: true };
  const begin = () => decoding.start(config, () => postMessage({ fault: 'The browser’s decoder has given up: drop the video again.' }));
  begin();
  for (let number = 0, start = performance.now(); ; number += 1) {
    const at = (number % count) * NUMBERS;
    const [offset, length, intra, time, duration, shown] = pictures.subarray(at, at + NUMBERS);
    const id = number - (number % count) + shown;
    const data = part(file, offset, length);
    const wait = start + time * 1000 - performance.now();
    if (wait > 0) await new Promise((resolve) => setTimeout(resolve, wait));
    else if (wait < -LATE) start -= wait;
    await decoding.queueShrinks();
    if (!decoding.isStarted()) return;
    decoding.count(length);
    decoding.decode(id, intra === 1, video.head(id), data);
    if (!isPlaying) {
      const paused = performance.now();
      await new Promise((resolve) => { goOn = resolve; });
      start += performance.now() - paused;
    }
    if (at + NUMBERS === pictures.length) start += (time + duration) * 1000;
  }
}
