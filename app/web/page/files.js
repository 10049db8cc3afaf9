// The user's own files: dropped or chosen, shown, kept on this device.

import { element } from './app.js';

const MODEL = /\.(obj|gltf|glb)$/i;
const PICTURE = /\.(png|jpe?g|bmp|tga|exr)$/i;
const EXR = /\.exr$/i;
const DEPTH = /depth|disp|z[-_. ]?(buffer|map)/i;
/** A size beyond the capacity of a browser's module, in bytes. */
const MAX_BYTES = 1.5e9;

/** Returns all dropped files, those in folders with their paths. */
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
      // Browsers give a hundred at a time.
      const some = await new Promise((resolve, reject) => reader.readEntries(resolve, reject));
      if (!some.length) return;
      for (const inner of some) await walk(inner);
    }
  };
  for (const entry of entries) await walk(entry);
  return found;
}

/** Returns the files as a source for [app.showSource]; throws a sentence. */
export function understand(files) {
  const models = files.filter(({ name }) => MODEL.test(name));
  if (models.length) {
    // The outermost one if there are several.
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
    throw new Error(`${pictures.length === 1 ? 'One picture is' : `${pictures.length} pictures are`} not enough: drop two, colour and depth, the one with “depth” in its name.`);
  }
  const names = files.map(({ name }) => name).slice(0, 3).join(', ') || 'nothing';
  throw new Error(`There is neither a model (OBJ, glTF, GLB) nor a pair of pictures (PNG, JPEG, EXR) among the files: ${names}.`);
}

function options() {
  const keys = [
    'source', 'encoding', 'near', 'far', 'metres-at-white', 'disparity-offset', 'disparity-scale', 'gamma', 'fov-y-degrees',
    'edges',
  ];
  const entries = keys.map((key) => {
    const input = element(`picture-${key}`);
    return [key, input.type === 'number' ? input.valueAsNumber : input.value];
  });
  // An empty field is no number.
  return JSON.stringify(Object.fromEntries(entries.filter(([, value]) => !Number.isNaN(value))));
}

/** Makes the panel work. */
export function offerFiles(app) {
  const take = async (files) => {
    try {
      if (app.busy) throw new Error('Something is being measured or shown elsewhere: end that first.');
      const bytes = files.reduce((sum, { file }) => sum + file.size, 0);
      if (bytes > MAX_BYTES) throw new Error(`The files have ${(bytes / 1e9).toFixed(1)} GB together, more than a page can hold: leave some out.`);
      const read = await Promise.all(files.map(async ({ name, file }) => ({ name, bytes: await file.arrayBuffer() })));
      const source = understand(read);
      if (source.color) source.options = options;
      await app.showSource(source);
    } catch (error) {
      app.say(error.message);
    }
  };
  // For tests.
  app.take = take;
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
      await take(await dropped(event.dataTransfer));
    } catch (error) {
      app.say(`The files cannot be read (${error.message}): choose them by the button.`);
    }
  });
  element('files').addEventListener('change', ({ target }) => {
    take([...target.files].map((file) => ({ name: file.webkitRelativePath || file.name, file })));
  });
  element('picture-options').addEventListener('change', () => {
    if (!app.source?.color || !app.page) return;
    app.clear();
    try {
      app.page.setPictureOptions(options());
    } catch (error) {
      app.say(error.message);
    }
    app.changed();
  });
}
