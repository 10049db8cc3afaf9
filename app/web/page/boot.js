// Starts the page, and says why if it does not start. An old kind of script: these run from a file, too, and where a module
// is missing.

import('./main.js').then((page) => page.start()).catch((error) => {
  const message = document.getElementById('message');
  document.getElementById('message-text').textContent = location.protocol === 'file:'
    ? 'Browsers do not run this page from a file: serve its folder, for instance with “cargo xtask web --serve”.'
    : `The page could not be started (${error.message}): reload it, or update the browser.`;
  message.hidden = false;
  message.showPopover?.();
  document.getElementById('loading').hidden = true;
});
