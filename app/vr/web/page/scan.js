// The QR code of a viewer, read by the camera.

import { Phone } from './yoro_web.js';
import { element } from './app.js';
import { say } from './messages.js';

/** The time between two pictures that are searched for a code, in ms. */
const STEP = 150;

/** Returns a function that reads a code in a video: with the browser's own reader if it has one, else with the
 * module's. */
async function reader() {
  const Detector = /** @type {any} */ (globalThis).BarcodeDetector;
  const formats = await Detector?.getSupportedFormats().catch(() => []);
  if (formats?.includes('qr_code')) {
    const detector = new Detector({ formats: ['qr_code'] });
    return async (video) => (await detector.detect(video).catch(() => []))[0]?.rawValue;
  }
  const paint = new OffscreenCanvas(1, 1).getContext('2d', { willReadFrequently: true });
  return async (video) => {
    const { videoWidth: width, videoHeight: height } = video;
    Object.assign(paint.canvas, { width, height });
    paint.drawImage(video, 0, 0);
    return Phone.readCode(new Uint8Array(paint.getImageData(0, 0, width, height).data.buffer), width);
  };
}

/** Returns the text of the first viewer's code that the camera sees, or null if the user gives up or has no camera. */
export async function scan() {
  const [dialog, video, state] = ['scan', 'scan-video', 'scan-state'].map(element);
  let stream = null;
  try {
    stream = await navigator.mediaDevices.getUserMedia({ video: { facingMode: 'environment' } });
  } catch (error) {
    say(`The camera cannot be used (${error.message}): allow it in the browser’s settings for this page, or write the text of the code.`);
    return null;
  }
  state.textContent = 'Hold the viewer’s code before the camera.';
  dialog.showModal();
  try {
    video.srcObject = stream;
    await video.play();
    const read = await reader();
    while (dialog.open) {
      const text = video.videoWidth ? await read(video) : null;
      const fault = text && Phone.viewerFault(text);
      if (text && !fault) return text;
      if (fault) state.textContent = fault;
      await new Promise((resolve) => setTimeout(resolve, STEP));
    }
    return null;
  } catch (error) {
    say(`The camera’s picture cannot be read (${error.message}): write the text of the code.`);
    return null;
  } finally {
    stream.getTracks().forEach((track) => track.stop());
    video.srcObject = null;
    dialog.close();
  }
}
