// The mosaics of the study's example: one with the estimate on it, and two on one another.
const mosaics = JSON.parse(document.getElementById('mosaics-data').textContent);
const mosaicChoice = {estimator: '', pair: 0, track: true, loops: true};

// "1.2 cm", with as many digits as a reader needs.
function lengthText(metres) {
  const [factor, unit] = metres < 0.01 ? [1000, 'mm'] : metres < 1 ? [100, 'cm'] : [1, 'm'];
  return `${Number((factor * metres).toPrecision(2))} ${unit}`;
}

function svgElement(tag, attributes, children = []) {
  const made = document.createElementNS('http://www.w3.org/2000/svg', tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...children);
  return made;
}

// What is drawn keeps its thickness, however large the picture is shown.
function lineOver(points, colour, width, opacity) {
  return svgElement('polyline', {
    points: points.map((point) => point.join(',')).join(' '), fill: 'none', stroke: colour, 'stroke-width': width,
    'stroke-opacity': opacity, 'stroke-linejoin': 'round', 'vector-effect': 'non-scaling-stroke',
  });
}

// Not larger than its pixels, and no taller than a window.
function showMosaic(card, mosaic, layers, text) {
  const box = card.querySelector('.mosaic');
  const drawing = svgElement('svg', {viewBox: `0 0 ${mosaic.width} ${mosaic.height}`}, layers);
  box.style.width = `${Math.round(Math.min(1.5 * mosaic.width, (900 * mosaic.width) / mosaic.height))}px`;
  box.replaceChildren(element('img', {src: mosaic.picture, alt: text, width: mosaic.width, height: mosaic.height}), drawing);
  card.querySelector('.caption').textContent = text;
}

function mosaicBox(label, key, redraw) {
  const box = element('input', {type: 'checkbox', checked: mosaicChoice[key], onchange: () => {
    mosaicChoice[key] = box.checked;
    redraw();
  }});
  return element('label', {}, [box, label]);
}

function mosaicSelect(label, key, values, redraw) {
  const select = element('select', {onchange: () => {
    mosaicChoice[key] = typeof mosaicChoice[key] === 'number' ? Number(select.value) : select.value;
    redraw();
  }});
  for (const [value, text] of values) select.append(element('option', {value, textContent: text, selected: value === mosaicChoice[key]}));
  return element('label', {textContent: `${label} `}, [select]);
}

function drawEstimateMosaic() {
  const mosaic = mosaics.mosaics.find((one) => one.estimator === mosaicChoice.estimator);
  const {colour} = styleOf(mosaic.estimator);
  const layers = [];
  if (mosaicChoice.loops) layers.push(...mosaic.loops.map((loop) => lineOver(loop, '#fff', 1, 0.45)));
  if (mosaicChoice.track) {
    // White below it: a floor has any grey.
    layers.push(lineOver(mosaic.path, '#fff', 4, 0.7), lineOver(mosaic.path, colour, 2, 1));
    const [u, v] = mosaic.path[0];
    layers.push(svgElement('circle', {cx: u, cy: v, r: mosaic.width / 150, fill: colour, stroke: '#fff', 'vector-effect': 'non-scaling-stroke'}));
  }
  const thinned = mosaic.loops.length < mosaic.loops_in_all ? `, ${mosaic.loops.length} of ${mosaic.loops_in_all} drawn` : '';
  showMosaic(document.getElementById('mosaic-estimate'), mosaic, layers,
    `${sentence(study.cells[0].example.text)}: the pictures at the poses of ${labelOf(mosaic.estimator)}, ` +
    `${lengthText(mosaic.metres_per_pixel)} a pixel, x up and y to the left. Thick: its trajectory from the dot on; ` +
    `white: loops used${thinned}. ` + (mosaic.blend === 'seams'
      ? 'Every detail is of one picture: where an outline breaks at a seam, the trajectory is wrong, and seams hide the rest of what is misplaced.'
      : 'Where a stone is there twice, or blurred, the trajectory is wrong.'));
}

function drawMosaicDifference() {
  const pair = mosaics.differences[mosaicChoice.pair];
  const share = 100 * pair.share_differs;
  const words = [
    `${labelOf(pair.a)} in warm tones and ${labelOf(pair.b)} in cold ones, not the colours of their lines; grey where both show the same, pale where one alone shows the floor; ` +
    `${lengthText(pair.metres_per_pixel)} a pixel.`,
    pair.common_m2 > 0 ? `${share < 0.1 ? 'Under 0.1' : Number(share.toPrecision(2))} % of the ${Number(pair.common_m2.toPrecision(3))} m² that both show ` +
      `differ by more than ${pair.grey_levels} of 254 grey levels.` : 'They have no place in common.',
  ];
  if (pair.estimates) {
    words.push(`The estimates are ${lengthText(pair.estimates.mean_m)} apart in the mean, ` +
      `${lengthText(pair.estimates.most_m)} at most (keyframe ${pair.estimates.keyframe}).`);
  }
  showMosaic(document.getElementById('mosaic-difference'), pair, [], words.join(' '));
}

function drawMask() {
  const card = document.getElementById('mask');
  card.hidden = !mosaics.mask;
  if (card.hidden) return;
  showMosaic(card, mosaics.mask, [], `Black: ${mosaics.mask.where}, ${Number((100 * mosaics.mask.share).toPrecision(2))} % of the picture. ` +
    'No feature there is matched, as it is no floor: given with the data, or found because it stays in place over the survey. front_end.mask: off switches that off.');
}

function makeMosaics() {
  if (!mosaics) return;
  document.getElementById('mosaics').hidden = false;
  drawMask();
  document.getElementById('mosaic-estimate').hidden = mosaics.mosaics.length === 0;
  document.getElementById('mosaic-difference').hidden = mosaics.differences.length === 0;
  if (mosaics.mosaics.length === 0) return;
  const best = mosaics.differences.length > 0 ? mosaics.differences[0].a : mosaics.mosaics[0].estimator;
  mosaicChoice.estimator = best;
  const names = mosaics.mosaics.map((one) => [one.estimator, labelOf(one.estimator)]);
  document.querySelector('#mosaic-estimate .choices').append(
    ...(names.length > 1 ? [mosaicSelect('estimator', 'estimator', names, drawEstimateMosaic)] : []),
    mosaicBox('trajectory', 'track', drawEstimateMosaic), mosaicBox('loops', 'loops', drawEstimateMosaic));
  drawEstimateMosaic();
  const card = document.getElementById('mosaic-difference');
  card.hidden = mosaics.differences.length === 0;
  if (card.hidden) return;
  const pairs = mosaics.differences.map((pair, i) => [i, `${labelOf(pair.a)} and ${labelOf(pair.b)}`]);
  if (pairs.length > 1) card.querySelector('.choices').append(mosaicSelect('two', 'pair', pairs, drawMosaicDifference));
  drawMosaicDifference();
}
