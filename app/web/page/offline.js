// Keeps the page's files, so that it works without a network. Files from the network take precedence.

const CACHE = 'yoro';
const FILES = [
  './', 'icon.svg', 'style.css', 'main.js', 'address.js', 'app.js', 'choices.js', 'controls.js', 'drawing.js', 'files.js',
  'headset.js', 'link.js', 'measure.js', 'messages.js', 'phone.js', 'sentence.js', 'sources.js', 'worker.js', 'yoro_web.js',
  'yoro_web_bg.wasm',
];

self.addEventListener('install', (event) => {
  event.waitUntil(caches.open(CACHE).then((cache) => cache.addAll(FILES)).then(() => self.skipWaiting()));
});
self.addEventListener('activate', (event) => event.waitUntil(self.clients.claim()));
self.addEventListener('fetch', (event) => {
  const { request } = event;
  if (request.method !== 'GET' || new URL(request.url).origin !== location.origin) return;
  event.respondWith((async () => {
    const cache = await caches.open(CACHE);
    try {
      const response = await fetch(request);
      if (response.ok) await cache.put(request, response.clone());
      return response;
    } catch (error) {
      const kept = await cache.match(request, { ignoreSearch: true });
      if (kept) return kept;
      throw error;
    }
  })());
});
