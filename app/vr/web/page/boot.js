// Starts the page, or says why it does not start. This is a classic script: such scripts also run from a file, and if a
// module is missing.

import('./main.js').then((page) => page.start()).catch((error) => {
  const message = document.getElementById('message');
  document.getElementById('message-text').textContent = location.protocol === 'file:'
    ? 'Browsers do not run this page from a file: serve its folder, for instance with “cargo xtask web --serve”.'
    : `The page could not be started (${error.message}): reload it, or update the browser.`;
  message.hidden = false;
  message.showPopover?.();
  document.getElementById('loading').hidden = true;
});
