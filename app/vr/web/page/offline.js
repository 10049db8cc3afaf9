// The service worker that keeps the page's files, so that the page works without a network.

const CACHE = 'yoro VERSION';
const FILES = ['./', 'icon.svg', 'manifest.webmanifest', /* FILES */];
/** The longest wait for the network if the file is kept, in ms. */
const NETWORK_TIMEOUT = 4000;

self.addEventListener('install', (event) => {
  event.waitUntil(caches.open(CACHE).then((cache) => cache.addAll(FILES)).then(() => self.skipWaiting()));
});

self.addEventListener('activate', (event) => {
  event.waitUntil((async () => {
    const old = (await caches.keys()).filter((name) => name.startsWith('yoro') && name !== CACHE);
    await Promise.all(old.map((name) => caches.delete(name)));
    await self.clients.claim();
  })());
});

/** Returns the network's answer, or fails after a while. */
function ask(request) {
  return new Promise((resolve, reject) => {
    setTimeout(() => reject(new Error('The network does not answer.')), NETWORK_TIMEOUT);
    fetch(request).then(resolve, reject);
  });
}

async function answer(request) {
  const cache = await caches.open(CACHE);
  // The page has one document, under whichever name it was requested.
  const kept = await cache.match(request.mode === 'navigate' ? './' : request, { ignoreSearch: true });
  // Files of a version never change.
  if (!kept || new URL(request.url).pathname.includes('/VERSION/')) return kept ?? fetch(request);
  return ask(request).then((response) => (response.ok ? response : kept), () => kept);
}

self.addEventListener('fetch', (event) => {
  const { request } = event;
  if (request.method === 'GET' && new URL(request.url).origin === location.origin) event.respondWith(answer(request));
});
