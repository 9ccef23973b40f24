// Fixes and headings on the map: what was measured, and what each estimator left out.
const hasMarks = (cell) => cell.example.estimators.some((one) => one.absolute.length > 0);

function fateText({fate, weight, nis}) {
  const what = fate === 'used' && weight < 1 ? `used with a weight of ${digits(weight)}` : study.fates[fate];
  return nis === undefined ? what : `${what}, NIS ${digits(nis)}`;
}

// "σ 1.00 m", or both axes of the ellipse.
function fixSigmas([long, short]) {
  return long < 1.02 * short ? `σ ${quantity(long, 'm')}` : `σ ${quantity(long, 'm')} and ${quantity(short, 'm')}`;
}

function fixRow(name, z) {
  const [x, y] = z.fix_m;
  const [at_x, at_y] = z.at_m;
  return {estimator: name, x, y, at_x, at_y, left: z.left_out ? 1 : 0,
    what: `Fix of keyframe ${z.keyframe}, ${fixSigmas(z.fix_sigma_m)}`,
    tooltip: `${labelOf(name)}: ${fateText(z)}, ${quantity(z.off_m, 'm')} from the estimate`};
}

// The direction is that of the map: x up, y to the left.
function headingRow(name, z) {
  const [x, y] = z.at_m;
  return {estimator: name, x, y, right: -Math.sin(z.heading_rad), down: -Math.cos(z.heading_rad), left: z.left_out ? 1 : 0,
    tooltip: `Heading of keyframe ${z.keyframe}, ${digits((180 / Math.PI) * z.heading_rad)}°, σ ${digits((180 / Math.PI) * z.sigma_rad)}°\n` +
      `${labelOf(name)}: ${fateText(z)}`};
}

// Estimates that are not moved by an alignment of their own have their fixes at one place: these
// are one mark, which the chart makes of them.
function markRows(cell) {
  const of = (part, row) => cell.example.estimators.flatMap((one) => one.absolute.filter((z) => z[part] !== undefined).map((z) => row(one.name, z)));
  const fixes = of('fix_m', fixRow);
  const headings = of('heading_rad', headingRow);
  return {fixes, links: fixes, headings, bars: headings.filter((row) => row.left)};
}

// How many of the fixes, each counted once, are not within the first view.
function beyondNote(fixes, [y1, y0], [x0, x1]) {
  const beyond = new Set(fixes.filter(({x, y}) => x < x0 || x > x1 || y < y0 || y > y1).map((row) => row.what));
  return beyond.size > 0 ? `Beyond the first view: ${beyond.size} fix${beyond.size === 1 ? '' : 'es'}.` : '';
}

// What the map's marks mean, and what was left out by whom.
function marksCaption(cell) {
  if (!hasMarks(cell)) return '';
  const all = cell.example.estimators.filter((one) => one.name !== kBaseline);
  const has = (kind) => all.some((one) => sum(one.absolute_in_all[kind]) > 0);
  const kinds = ['fixes', 'headings'].filter(has);
  const shapes = {fixes: '○ fixes, each joined to the pose that it measures', headings: 'short lines: measured headings'};
  const leftShapes = {fixes: '×', headings: 'with a bar'};
  const leftOut = kinds.map((kind) => {
    const parts = all.filter((one) => one.absolute_in_all[kind][1] > 0)
      .map((one) => `${labelOf(one.name)} ${one.absolute_in_all[kind][1]} of ${sum(one.absolute_in_all[kind])}`);
    return `${sentence(kind)} left out: ${parts.length > 0 ? parts.join(', ') : 'none'}.`;
  });
  const isThinned = all.some((one) => one.absolute.length < sum(Object.values(one.absolute_in_all).flat()));
  return `${sentence(kinds.map((kind) => shapes[kind]).join('; '))}; red, ${kinds.map((kind) => leftShapes[kind]).join(' or ')}: ` +
    `left out: rejected by a gate, lost with a failed update, or given at most half its weight by a loss. ${leftOut.join(' ')} ` +
    (isThinned ? 'Marks are thinned evenly. ' : '');
}
