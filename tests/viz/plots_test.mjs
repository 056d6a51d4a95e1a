// tests/viz/plots_test.mjs -- the plots of the page and what is saved of them, and images of the
// view. Real viz_node and headless Chromium; expected values are the formulas of scene_source.cpp.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { drawn, openScenePage, textOf, viz } from './browser.mjs';
import { out, runCases, source, until } from './session.mjs';

const palette = JSON.parse(readFileSync(join(source, 'viz_node/colours.json'), 'utf8')).dark;
const [POSITION, FORCE, ENERGY] = [1, 2, 3]; // the plots, from above

/** Position of the port, force and energy at a time [s]. */
function signalsAt(t) {
  const u = 12 / 59; // of the port along the string
  const swing = Math.sin(Math.PI * u) * Math.cos(2 * Math.PI * 0.9 * t) + 0.4 * Math.sin(2 * Math.PI * u) * Math.sin(2 * Math.PI * 1.7 * t);
  const position = 0.03 * swing;
  return [position, -90 * position + 0.15 * Math.sin(2 * Math.PI * 140 * t), 0.012 * Math.exp(-0.02 * t)];
}

/** Notes what is written on each canvas since it was cleared. Runs in the page, before it does anything. */
function recordTexts() {
  const texts = new Map();
  const { clearRect, fillText } = CanvasRenderingContext2D.prototype;
  CanvasRenderingContext2D.prototype.clearRect = function (...words) {
    texts.set(this.canvas, []);
    clearRect.apply(this, words);
  };
  CanvasRenderingContext2D.prototype.fillText = function (text, x, y, ...words) {
    const { width } = this.measureText(text);
    const left = x - { left: 0, start: 0, center: 0.5, right: 1, end: 1 }[this.textAlign] * width;
    texts.set(this.canvas, [...(texts.get(this.canvas) ?? []), { text, x, y, left, right: left + width }].slice(-60));
    fillText.apply(this, [text, x, y, ...words]);
  };
  window.textsOf = (selector) => texts.get(document.querySelector(selector)) ?? [];
  window.textsElsewhere = () => [...texts].filter(([canvas]) => !canvas.isConnected).at(-1)?.[1].map(({ text }) => text) ?? [];
}

const canvasOf = (plot) => `.plot:nth-of-type(${plot}) canvas`;

/** Labels of both axes of a plot, from left to right and from top to bottom: numbers in SI units, and where they stand, 0..1. */
async function labelsOf(page, plot) {
  const selector = canvasOf(plot);
  const [texts, width, height] = await page.evaluate((one) => [window.textsOf(one), document.querySelector(one).width, document.querySelector(one).height], selector);
  const cut = texts.filter(({ left, right }) => left < 0 || right > width);
  assert.deepEqual(cut, [], `labels that the edge of a canvas of ${width} pixels cuts`);
  const number = (text) => {
    const [, value, prefix] = /^(-?[\d.]+)\s?([mµn]?)[NmJs]$/.exec(text) ?? [];
    return Number(value) * { '': 1, m: 1e-3, µ: 1e-6, n: 1e-9 }[prefix];
  };
  const times = texts.filter(({ y }) => y > height - 22).map(({ text, x }) => ({ value: number(text), at: x / width }));
  const values = texts.filter(({ y }) => y <= height - 22).map(({ text, y }) => ({ value: number(text), at: y / height }));
  return { times: times.sort((a, b) => a.at - b.at), values: values.sort((a, b) => a.at - b.at) };
}

/** Simulated time from the first to the last label of a plot [s]. */
async function spanOf(page, plot) {
  const { times } = await labelsOf(page, plot);
  return times.length < 2 ? Number.NaN : times.at(-1).value - times[0].value;
}

/** [file name, bytes] of what `action` saves. */
async function savedBy(page, action) {
  const [download] = await Promise.all([page.waitForEvent('download'), action()]);
  return [download.suggestedFilename(), readFileSync(await download.path())];
}

/** How many pixels of an image are about of a colour, its size, and the colour of one place. Runs in the page. */
async function readImage([base64, hex, x, y]) {
  const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
  const bitmap = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
  const pen = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
  pen.drawImage(bitmap, 0, 0);
  const { data } = pen.getImageData(0, 0, bitmap.width, bitmap.height);
  const wanted = [1, 3, 5].map((begin) => Number.parseInt(hex.slice(begin, begin + 2), 16));
  let count = 0;
  for (let i = 0; i < data.length; i += 4) if (wanted.every((byte, k) => Math.abs(byte - data[i + k]) < 30)) ++count;
  return { width: bitmap.width, height: bitmap.height, count, place: [...data.slice(4 * (y * bitmap.width + x), 4 * (y * bitmap.width + x) + 3)] };
}

/** Mean heights (0 at the top) of the curve of the phase plot in its left and its right third. Runs in the page. */
function thirdsOfPhase(hex) {
  const canvas = document.querySelector('.phase canvas');
  const { data, width, height } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  const wanted = [1, 3, 5].map((begin) => Number.parseInt(hex.slice(begin, begin + 2), 16));
  const places = [];
  for (let i = 0; i < width * height; ++i) if (wanted.every((byte, k) => Math.abs(byte - data[4 * i + k]) < 40)) places.push([i % width, Math.floor(i / width) / height]);
  const [low, high] = [Math.min(...places.map(([x]) => x)), Math.max(...places.map(([x]) => x))];
  const mean = (begin, end) => {
    const heights = places.filter(([x]) => x >= low + begin * (high - low) && x <= low + end * (high - low)).map(([, y]) => y);
    return heights.reduce((sum, y) => sum + y, 0) / heights.length;
  };
  return { count: places.length, left: mean(0, 1 / 3), right: mean(2 / 3, 1) };
}

const cases = {
  'both ends of every axis have labels, and round values between them': async ({ page }) => {
    await page.click('#windows [data-window="1"]');
    await until('a second of signals came', async () => (await viz(page, 'signals')).newestS > 2);
    await drawn(page, 3);
    await page.keyboard.press('h');
    for (const plot of [POSITION, FORCE, ENERGY]) {
      const { times, values } = await labelsOf(page, plot);
      assert.ok(times.length >= 3 && times.every(({ value }) => value > 0), JSON.stringify(times));
      assert.ok(times[0].at < 0.3 && times.at(-1).at > 0.87, `ends of the time: ${JSON.stringify(times)}`);
      assert.ok(times.at(-1).value - times[0].value > 0.85, JSON.stringify(times));
      const newestS = (await viz(page, 'signals')).newestS;
      assert.ok(times.at(-1).value <= newestS, `nothing is newer than ${newestS}`);
      assert.ok(values.length >= 2 && values[0].at < 0.25 && values.at(-1).at > 0.55, `ends of the values: ${JSON.stringify(values)}`);
      assert.ok(values.every(({ value }, i) => i === 0 || value < values[i - 1].value), JSON.stringify(values));
    }
    await page.screenshot({ path: join(out, 'plots.png') });
  },

  'the values under the pointer are shown, at one time in all plots': async ({ page }) => {
    const box = await page.locator(canvasOf(POSITION)).boundingBox();
    const times = [];
    for (const share of [0.35, 0.75]) {
      await page.mouse.move(box.x + share * box.width, box.y + 0.5 * box.height);
      const t = Number(/^at (\d+\.\d{3}) s$/.exec(await until('the time is shown', () => textOf(page, '.plot:nth-of-type(1) .at')))[1]);
      times.push(t);
      for (const plot of [FORCE, ENERGY]) await until('it is in all plots', async () => (await textOf(page, `.plot:nth-of-type(${plot}) .at`)) === `at ${t.toFixed(3)} s`);
      const [, number, prefix] = /(-?[\d.]+)\s?([mµ]?)m$/.exec(await textOf(page, '.plot:nth-of-type(1) .series b'));
      const shown = Number(number) * { '': 1, m: 1e-3, µ: 1e-6 }[prefix];
      // A point of the plot is the extreme of up to 5 ms, in which the port moves by 1.5 mm at most.
      assert.ok(Math.abs(shown - signalsAt(t)[0]) < 1.6e-3, `${shown} m at ${t} s, not ${signalsAt(t)[0]} m`);
    }
    assert.ok(Math.abs(times[1] - times[0] - 0.4 * (box.width / (box.width - 80))) < 0.05, `the times follow the pointer: ${times}`);
    await page.mouse.move(300, 300);
    await until('the pointer has left', async () => (await textOf(page, '.plot:nth-of-type(1) .at')) === '');
  },

  'the wheel, keys and buttons choose how long is shown': async ({ page }) => {
    const spans = (what, low, high) =>
      until(what, async () => {
        const span = await spanOf(page, POSITION);
        return span > low && span < high;
      });
    const box = await page.locator(canvasOf(POSITION)).boundingBox();
    await page.mouse.move(box.x + 0.5 * box.width, box.y + 0.5 * box.height);
    await page.mouse.wheel(0, -1000);
    await spans('the wheel shows 1 / e s', 0.3, 0.37);
    await page.keyboard.press('-');
    await spans('a key shows twice as much', 0.6, 0.74);
    await page.keyboard.press('+');
    await spans('and another half of that', 0.3, 0.37);
    await page.click('#windows [data-window="1"]');
    await spans('the button shows 1 s', 0.85, 1);
    assert.equal(await page.locator('#windows [aria-pressed="true"]').textContent(), '1 s');
    await page.mouse.move(300, 300);
  },

  'a frozen view keeps its plots, and lets them go on': async ({ page }) => {
    const last = async () => (await labelsOf(page, POSITION)).times.at(-1).value;
    const before = await last();
    const since = (await viz(page, 'signals')).newestS;
    await until('a second passes', async () => (await viz(page, 'signals')).newestS > since + 1);
    await page.click('#windows [data-window="1"]');
    assert.equal(await last(), before);
    await page.keyboard.press('h');
    await until('they go on', async () => (await last()) > before + 1);
  },

  'a person chooses the signals': async ({ page }) => {
    await page.click('#choose');
    const box = page.getByLabel('finger force [N]');
    assert.equal(await box.isChecked(), true);
    await box.uncheck();
    await until('its plot is gone', async () => (await page.locator('.plot').count()) === 2);
    assert.deepEqual(await page.locator('.plot .series').evaluateAll((labels) => labels.map((label) => label.firstChild.textContent)), ['finger position', 'energy']);
    assert.equal(await textOf(page, '#plots .note'), '1 more signal is not drawn: Choose');
    await page.screenshot({ path: join(out, 'plots_choose.png') });
    await box.check();
    await until('its plot is back', async () => (await page.locator('.plot').count()) === 3);
    assert.equal(await page.locator('#plots .note').count(), 0);
    await page.click('#choose');
    assert.equal(await page.locator('#choices').isVisible(), false);
  },

  'a logarithmic scale has powers of ten': async ({ page }) => {
    await page.click('#log');
    for (const plot of [POSITION, ENERGY]) {
      const values = await until('there are labels', async () => {
        const labels = (await labelsOf(page, plot)).values;
        return labels.length >= 2 && labels;
      });
      for (const { value } of values) assert.ok(Math.abs(Math.log10(value) - Math.round(Math.log10(value))) < 1e-9, `${value} is a power of ten`);
      assert.ok(values[0].value > values.at(-1).value);
    }
    await page.screenshot({ path: join(out, 'plots_log.png') });
    await page.click('#log');
    await until('the scale is linear', async () => (await labelsOf(page, POSITION)).values.some(({ value }) => value <= 0));
  },

  'two signals are drawn against each other': async ({ page }) => {
    await page.keyboard.press('p');
    await drawn(page, 3);
    // The force is a spring's: the farther up the port, the farther down the force.
    const falling = await until('the curve is drawn', async () => {
      const curve = await page.evaluate(thirdsOfPhase, palette.signals[0]);
      return curve.count > 100 && curve;
    });
    assert.ok(falling.right > falling.left + 0.2, JSON.stringify(falling));
    const labels = await page.evaluate(() => window.textsOf('.phase canvas').slice(-4).map(({ text }) => text));
    assert.match(labels.join(), /^\S+ m?N,\S+ m?N,\S+ m?m,\S+ m?m$/);
    await page.screenshot({ path: join(out, 'plots_phase.png') });
    await page.getByLabel('to the right').selectOption('finger force');
    await until('a signal against itself rises', async () => {
      const rising = await page.evaluate(thirdsOfPhase, palette.signals[0]);
      return rising.right < rising.left - 0.2;
    });
    await page.click('#phase');
    assert.equal(await page.locator('.phase').count(), 0);
  },

  'the signals of the window are saved as a table': async ({ page }) => {
    const [name, bytes] = await savedBy(page, () => page.click('#csv'));
    assert.match(name, /^string_[\d.]+s\.csv$/);
    const [head, ...rows] = bytes.toString().trimEnd().split('\n');
    assert.equal(head, 'time [s],finger position [m],finger force [N],energy [J]');
    assert.ok(Math.abs(rows.length - 1000) <= 1, `${rows.length} rows`);
    let complete = 0;
    for (const row of rows) {
      const [t, ...values] = row.split(',');
      if (values.some((value) => value === '')) continue; // it was lost on the way
      ++complete;
      // Values are numbers of 24 bits, up to 3 N.
      signalsAt(Number(t)).forEach((wanted, i) => assert.ok(Math.abs(Number(values[i]) - wanted) < 5e-7, `${row}, not ${wanted}`));
    }
    assert.ok(complete > 500, `${complete} rows are complete`);
  },

  'the plots are saved as an image': async ({ page }) => {
    const [name, bytes] = await savedBy(page, () => page.click('#png'));
    assert.match(name, /^string_[\d.]+s\.plots\.png$/);
    const image = await page.evaluate(readImage, [bytes.toString('base64'), palette.signals[0], 0, 0]);
    const canvases = await page.locator('.plot canvas').evaluateAll((all) => all.map(({ width, height }) => ({ width, height })));
    assert.equal(image.width, canvases[0].width);
    assert.ok(image.height > canvases.reduce((sum, { height }) => sum + height, 0));
    assert.ok(image.count > 300, `${image.count} pixels of curves`);
    const names = await page.evaluate(() => window.textsElsewhere());
    assert.deepEqual(names, ['finger position', 'finger force', 'energy']);
  },

  'an image of the view carries its scene, time, legend and ruler': async ({ page }) => {
    await page.keyboard.press('c');
    await drawn(page, 3);
    await page.keyboard.press('h');
    const [name, bytes] = await savedBy(page, () => page.keyboard.press('s'));
    const { simulatedS } = await viz(page, 'lastFrame');
    assert.equal(name, `string_${simulatedS.toFixed(2)}s.png`);
    const texts = await page.evaluate(() => window.textsElsewhere());
    const legend = await page.locator('#legend li').allTextContents();
    const ruler = await textOf(page, '#ruler span');
    assert.deepEqual(texts.slice(0, -4), [`string · ${simulatedS.toFixed(3)} s`, ...legend]);
    assert.equal(texts.at(-4), '0');
    assert.match(texts.at(-3), /^[\d.]+\s?\S*m\/s$/);
    assert.equal(texts.at(-2), 'speed, mean over a frame');
    assert.equal(texts.at(-1).replace(/\.0+(?=\D)/, ''), ruler);
    const mark = [16 + 3, 46 - 4]; // the edge of the square of fixed points
    const image = await page.evaluate(readImage, [bytes.toString('base64'), palette.fixed, ...mark]);
    const stage = await page.locator('#stage').boundingBox();
    assert.deepEqual([image.width, image.height], [stage.width, stage.height].map(Math.floor));
    const wanted = [1, 3, 5].map((begin) => Number.parseInt(palette.fixed.slice(begin, begin + 2), 16));
    assert.ok(wanted.every((byte, k) => Math.abs(byte - image.place[k]) < 12), `the mark of fixed points is ${image.place}`);
    await page.keyboard.press('h');
    await page.selectOption('#colouring', 'bodies');
  },

  'nothing went wrong in the page': async ({ page, pageErrors }) => {
    assert.deepEqual([await viz(page, 'errors'), pageErrors], [[], []]);
  },
};

async function open() {
  const session = await openScenePage();
  await session.page.addInitScript(recordTexts);
  await session.page.reload();
  await until('the page draws', () => session.page.evaluate(() => (window.viz?.framesDrawn ?? 0) > 0));
  return session;
}

await runCases(cases, open);
