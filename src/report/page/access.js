// Of the self-test: what keeps readers out in the theme that is on.
function rgbaOf(text) {
  const [red, green, blue, alpha = 1] = text.match(/[\d.]+(e-?\d+)?/g).map(Number);
  return text.startsWith('color') ? [red, green, blue, alpha] : [red / 255, green / 255, blue / 255, alpha];
}

const over = ([r, g, b, alpha], below) => [r, g, b].map((part, i) => alpha * part + (1 - alpha) * below[i]);

function groundOf(node) {
  if (!node) return [1, 1, 1];
  return over(rgbaOf(getComputedStyle(node).backgroundColor), groundOf(node.parentElement));
}

function luminance(colour) {
  const [red, green, blue] = colour.map((part) => (part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4));
  return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
}

function contrastOf(node, ground = groundOf(node)) {
  const style = getComputedStyle(node);
  const [low, high] = [luminance(ground), luminance(over(rgbaOf(node.closest('svg') ? style.fill : style.color), ground))].sort((a, b) => a - b);
  return (high + 0.05) / (low + 0.05);
}

// Texts in bars, each with its bar.
function textsInBars() {
  const marks = (kind) => [...document.querySelectorAll(`#chart-outcomes .mark-${kind}.role-mark > *`)];
  const bars = marks('rect');
  return marks('text').filter((one) => one.textContent.trim()).map((text) => {
    const style = getComputedStyle(bars[marks('text').indexOf(text)]);
    const colour = [...rgbaOf(style.fill).slice(0, 3), Number(style.fillOpacity)];
    return {text, contrast: contrastOf(text, over(colour, groundOf(text.closest('svg'))))};
  });
}

// Texts of other marks lie on what a chart draws, which is not their element's ground.
const isSeen = (node) => node.getClientRects().length > 0 && !node.closest('script, noscript') &&
  (!node.closest('svg') || node.closest('[class*="role-axis"]'));

function accessTest() {
  const controls = [...document.querySelectorAll('a[href], button, input, select, summary')].filter(isSeen);
  const nameOf = (one) => one.getAttribute('aria-label') || [...(one.labels || [])].map((label) => label.textContent.trim()).join('') ||
    (one.tagName === 'SELECT' ? '' : one.textContent.trim());
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  const texts = [];
  while (walker.nextNode()) if (walker.currentNode.textContent.trim()) texts.push(walker.currentNode.parentElement);
  return {lang: document.documentElement.lang, title: document.title, controls: controls.length, texts: texts.length,
    unnamed: controls.filter((one) => !nameOf(one)).map((one) => one.outerHTML.slice(0, 80)),
    unreachable: controls.filter((one) => one.tabIndex < 0).map((one) => one.outerHTML.slice(0, 80)),
    // WCAG 2.1, 1.4.3
    bars: textsInBars().length,
    faint: [...texts.filter(isSeen).map((text) => ({text, contrast: contrastOf(text)})), ...textsInBars()]
      .filter(({contrast}) => contrast < 4.5).map(({text, contrast}) => `${text.textContent.slice(0, 40)}: ${contrast.toFixed(2)}`)};
}

// Titles of axes that leave their chart.
function cutTest() {
  return [...document.querySelectorAll('#charts .role-axis-title text')].filter((text) => {
    const [own, chart] = [text, text.closest('svg')].map((one) => one.getBoundingClientRect());
    return own.top < chart.top - 1 || own.bottom > chart.bottom + 1 || own.left < chart.left - 1 || own.right > chart.right + 1;
  }).map((text) => text.textContent);
}

// Labels below a chart that run into another one.
function crossedLabels(id) {
  const cross = ([a, b]) => a.left < b.right - 1 && b.left < a.right - 1 && a.top < b.bottom - 1 && b.top < a.bottom - 1;
  return [...document.querySelectorAll(`#chart-${id} svg`)].flatMap((svg) => {
    const boxes = [...svg.querySelector('.role-axis-label').children].map((one) => one.getBoundingClientRect());
    return boxes.flatMap((a, i) => boxes.slice(0, i).map((b) => [a, b])).filter(cross);
  });
}
