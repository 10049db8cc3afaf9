// The user's own files, dropped or chosen. They stay on this device.

import { app, element } from './app.js';
import { changed } from './drawing.js';
import { clear, say } from './messages.js';
import { photo } from './photos.js';
import { checkOptions, fill, guess, options, showFields } from './pictures.js';
import { showSource, stopLoading } from './sources.js';

const MODEL = /\.(obj|gltf|glb)$/i;
const PICTURE = /\.(png|jpe?g|bmp|tga|exr)$/i;
const VIDEO = /\.(mp4|m4v|mov)$/i;
const EXR = /\.exr$/i;
const DEPTH = /depth|disp|z[-_. ]?(buffer|map)/i;
/** The largest total size of the files in bytes: more would not fit into the module's memory. */
const MAX_BYTES = 1.5e9;

/** Returns all dropped files. Files in folders are named by their paths. */
async function dropped(transfer) {
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry?.()).filter(Boolean);
  if (!entries.length) return [...transfer.files].map((file) => ({ name: file.name, file }));
  const found = [];
  const walk = async (entry) => {
    if (entry.isFile) {
      const file = await new Promise((resolve, reject) => entry.file(resolve, reject));
      found.push({ name: entry.fullPath.replace(/^\//, ''), file });
      return;
    }
    const reader = entry.createReader();
    for (;;) {
      // Browsers return at most a hundred entries at a time.
      const some = await new Promise((resolve, reject) => reader.readEntries(resolve, reject));
      if (!some.length) return;
      for (const inner of some) await walk(inner);
    }
  };
  for (const entry of entries) await walk(entry);
  return found;
}

/** Returns the files as a source for [showSource]; throws a sentence. */
export function understand(files) {
  const models = files.filter(({ name }) => MODEL.test(name));
  if (models.length) {
    // Take the outermost one if there are several.
    const depth = ({ name }) => name.split('/').length;
    const main = models.reduce((a, b) => (depth(b) < depth(a) ? b : a));
    return { main: main.name, files };
  }
  const pictures = files.filter(({ name }) => PICTURE.test(name));
  if (pictures.length === 2) {
    const depth = pictures.find(({ name }) => DEPTH.test(name)) ?? pictures.find(({ name }) => EXR.test(name)) ?? pictures[1];
    const color = pictures.find((picture) => picture !== depth);
    if (color.name === depth.name) throw new Error(`Both pictures are called ${depth.name}: rename the one with the depth.`);
    return { color, depth };
  }
  if (pictures.length) {
    throw new Error(`${pictures.length === 1 ? 'One picture is not enough' : `${pictures.length} pictures are too many`}: drop two, colour and depth, the one with “depth” in its name.`);
  }
  const names = files.map(({ name }) => name).slice(0, 3).join(', ') || 'nothing';
  throw new Error(`There is neither a model (OBJ, glTF, GLB) nor a pair of pictures (PNG, JPEG, EXR) among the files, nor are they one RGBD video (MP4): ${names}.`);
}

/**
 * Shows files. If something is wrong with them, says what; then what was shown stays.
 * @param {{name: string, file: Blob}[]} files
 * @param {Record<string, string | number> | null} known the options of pictures; null to guess them
 */
export async function take(files, known = null) {
  try {
    if (app.busy) throw new Error(app.busy.end);
    if (!app.page) throw new Error('The page has not started, so that it cannot show files yet.');
    if (files.length === 1 && VIDEO.test(files[0].name)) {
      clear();
      stopLoading();
      (await import('./stream.js')).play(new File([files[0].file], files[0].name));
      return;
    }
    const bytes = files.reduce((sum, { file }) => sum + file.size, 0);
    if (bytes > MAX_BYTES) throw new Error(`The files have ${(bytes / 1e9).toFixed(1)} GB together, more than a page can hold: leave some out.`);
    const read = await Promise.all(files.map(async ({ name, file }) => ({ name, bytes: await file.arrayBuffer() })));
    const carried = read.length === 1 ? await photo(read[0]) : null;
    /** @type {import('./app.js').Source} */
    const source = carried?.pair ?? understand(read);
    clear();
    if (source.color) {
      const certain = known ?? carried?.known;
      fill(certain ?? await guess(source.depth));
      source.options = options;
      element('picture-guess').hidden = Boolean(certain);
    }
    await showSource(source);
  } catch (error) {
    say(error.message);
  }
}

/** Loads one of the page's own examples. */
async function example(names, known) {
  try {
    take(await Promise.all(names.map(async (name) => {
      const answer = await fetch(name);
      if (!answer.ok) throw new Error(String(answer.status));
      return { name, file: await answer.blob() };
    })), known);
  } catch (error) {
    say(`The example cannot be loaded (${error.message}): is there a network?`);
  }
}

/** Listens to dropped and chosen files, and to the options of pictures. */
export function listenToFiles() {
  addEventListener('dragover', (event) => {
    event.preventDefault();
    document.body.classList.add('dropping');
  });
  addEventListener('dragleave', (event) => {
    if (!event.relatedTarget) document.body.classList.remove('dropping');
  });
  addEventListener('drop', async (event) => {
    event.preventDefault();
    document.body.classList.remove('dropping');
    try {
      const files = await dropped(event.dataTransfer);
      if (files.length) await take(files);
      else say('What was dropped is no file: save it first, and drop the file.');
    } catch (error) {
      say(`The files cannot be read (${error.message}): choose them by the button.`);
    }
  });
  element('files').addEventListener('change', ({ target }) => {
    take([...target.files].map((file) => ({ name: file.webkitRelativePath || file.name, file })));
  });
  element('example-pictures').addEventListener('click', () => {
    example(['example-color.jpg', 'example-depth.png'], { source: 'right', encoding: 'standard-z', near: 0.3, far: 30, 'fov-y-degrees': 60 });
  });
  element('example-model').addEventListener('click', () => example(['example.obj', 'example.mtl'], null));
  element('picture-options').addEventListener('change', () => {
    if (!app.source?.color || !app.page) return;
    clear();
    showFields();
    try {
      checkOptions();
      app.page.setPictureOptions(options());
    } catch (error) {
      say(error.message);
    }
    changed();
  });
}
