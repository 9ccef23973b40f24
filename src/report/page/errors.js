// First of all scripts: keeps what goes wrong, for the page to show and the self-test to count.
const pageErrors = [];
window.addEventListener('error', (event) => pageErrors.push(String(event.message)));
window.addEventListener('unhandledrejection', (event) => pageErrors.push(String(event.reason)));
for (const kind of ['error', 'warn']) {
  const original = console[kind].bind(console);
  console[kind] = (...what) => {
    pageErrors.push(what.join(' '));
    original(...what);
  };
}
