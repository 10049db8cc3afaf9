// Shows what the example draws, or says why it cannot draw.
import start from "./offscreen.js";

const say = (sentence) => (document.querySelector("p").textContent = sentence);

globalThis.show = (width, rgba, sentence) => {
  if (width) {
    const picture = new ImageData(new Uint8ClampedArray(rgba), width);
    const canvas = document.querySelector("canvas");
    [canvas.width, canvas.height] = [picture.width, picture.height];
    canvas.getContext("2d").putImageData(picture, 0, 0);
  }
  say(sentence);
};

if (navigator.gpu) {
  start({ module_or_path: "offscreen_bg.wasm" }).catch((error) => say(String(error)));
} else {
  say("This browser has no WebGPU.");
}
