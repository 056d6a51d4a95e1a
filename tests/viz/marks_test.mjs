// tests/viz/marks_test.mjs -- what is what on the page: colours and their legend, what a person
// picks, names, themes, the list of keys. Real viz_node and headless Chromium.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { banner, drawn, look, openScenePage, textOf, viz } from './browser.mjs';
import { out, runCases, source, until } from './session.mjs';

const HANDLE = 12; // the MAT of the port
const [FIRST_BODY, SECOND_BODY, HOOKED] = [20, 45, 23]; // two MATs, and a link that changes its state
const palettes = JSON.parse(readFileSync(join(source, 'viz_node/colours.json'), 'utf8'));
const MIN_CONTRAST = 4.5; // WCAG 2.1, 1.4.3: text of usual size

const bytesOf = (hex) => [1, 3, 5].map((begin) => Number.parseInt(hex.slice(begin, begin + 2), 16));
const isPressed = (page, key) => page.locator(`#tools button[data-key="${key}"]`).getAttribute('aria-pressed');

/** Shading makes a colour darker and leaves its hue. */
function assertHue(colour, hex, what) {
  const wanted = bytesOf(hex);
  const share = Math.max(...colour) / Math.max(...wanted);
  const away = Math.max(...wanted.map((byte, k) => Math.abs(byte * share - colour[k])));
  assert.ok(share > 0.4 && away < 45, `${what} is ${colour}, a shade of ${wanted}`);
}

/** Marks of the legend: [class, text, colour]. */
const legendOf = (page) =>
  page.locator('#legend li').evaluateAll((items) => items.map((item) => [item.className, item.textContent, item.style.getPropertyValue('--colour')]));

/** How many pixels of the sheet of marks are inked within `reach` CSS pixels of a place of the page. Runs in the page. */
function inkAround({ x, y, reach }) {
  const sheet = document.querySelector('#marks');
  const box = sheet.getBoundingClientRect();
  const ratio = sheet.width / box.width;
  const [left, top, size] = [x - box.left - reach, y - box.top - reach, 2 * reach].map((value) => Math.round(value * ratio));
  const { data } = sheet.getContext('2d').getImageData(left, top, size, size);
  return data.filter((_, i) => i % 4 === 3).filter((alpha) => alpha > 0).length;
}

/** How many places of 9 in the middle of the line between two MATs have a colour. */
const colouredBetween = (page, a, b, hex) =>
  page.evaluate(
    ([from, to, wanted]) => {
      const [p, q] = [window.viz.project(from), window.viz.project(to)];
      const around = [[0, 0], [0, 1], [0, -1], [1, 0], [-1, 0]];
      const hasIt = ([x, y]) => window.viz.pixelAt(x, y).every((byte, k) => Math.abs(byte - wanted[k]) < 40);
      const places = Array.from({ length: 9 }, (_, k) => 0.3 + 0.05 * k).map((share) => [p.x + share * (q.x - p.x), p.y + share * (q.y - p.y)]);
      return places.filter(([x, y]) => around.some(([dx, dy]) => hasIt([x + dx, y + dy]))).length;
    },
    [a, b, bytesOf(hex)],
  );

/** Clicks a place that moves, until the name of what is picked reads so. */
async function pick(page, placeOf, name) {
  await until(`${name} is picked`, async () => {
    const { x, y } = await placeOf();
    await page.mouse.click(x, y);
    return (await page.locator('#picked').isVisible()) && name.test(await textOf(page, '#picked-name'));
  });
}

const placeOf = (page, mat) => () => page.evaluate((index) => window.viz.project(index), mat);
const middleOfLink = (page, link) => () =>
  page.evaluate((mat) => {
    const [a, b] = [window.viz.project(mat), window.viz.project(mat + 1)];
    return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 };
  }, link);

/** Texts with too little contrast to what lies behind them. Runs in the page. */
function faintTexts(least) {
  const bytes = (colour) => colour.match(/[\d.]+/g).map(Number);
  const light = (colour) => {
    const [r, g, b] = bytes(colour).map((byte) => (byte / 255 <= 0.03928 ? byte / 255 / 12.92 : ((byte / 255 + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const groundOf = (element) => {
    for (let one = element; one !== null; one = one.parentElement) {
      const { backgroundColor } = getComputedStyle(one);
      if ((bytes(backgroundColor)[3] ?? 1) > 0.8) return backgroundColor;
    }
    return getComputedStyle(document.body).backgroundColor;
  };
  const texts = [...document.querySelectorAll('body *')].filter((one) => [...one.childNodes].some((node) => node.nodeType === 3 && node.data.trim()));
  const shown = texts.filter((one) => one.checkVisibility() && !one.disabled);
  return shown.flatMap((one) => {
    const [a, b] = [light(getComputedStyle(one).color), light(groundOf(one))].sort((p, q) => q - p);
    const contrast = (a + 0.05) / (b + 0.05);
    return contrast < least ? [`${one.tagName} "${one.textContent.trim().slice(0, 30)}": ${contrast.toFixed(2)}`] : [];
  });
}

const cases = {
  'the legend explains every colour and mark': async ({ page }) => {
    await drawn(page, 3);
    const { bodies, fixed, port, link_states: states } = palettes.dark;
    assert.deepEqual(await legendOf(page), [
      ['mass', 'string', bodies[0]],
      ['mass', 'string2', bodies[1]],
      ['fixed-point', 'fixed point', fixed],
      ['handle', 'handle of a device', port],
      ['tool', 'tool that it holds', port],
      ['link solid', 'link, hooked', states[0]],
      ['link solid', 'free', states[1]],
    ]);
  },

  'each body has a colour of its own': async ({ page }) => {
    assertHue((await look(page, FIRST_BODY)).colour, palettes.dark.bodies[0], 'the first body');
    assertHue((await look(page, SECOND_BODY)).colour, palettes.dark.bodies[1], 'the second body');
  },

  'a MAT that is clicked says its name, where it is and how fast, and is followed': async ({ page }) => {
    assert.equal(await page.locator('#picked').isVisible(), false);
    await pick(page, placeOf(page, FIRST_BODY), /^string\[20\]$/);
    await page.screenshot({ path: join(out, 'marks_picked.png') });
    const pattern = /^x (-?[\d.]+)\s?(m|mm|µm) · y -?[\d.]+\s?\S*m · z \S+\s?m · speed [\d.]+\s?\S*m\/s · net force [\d.]+\s?\S*N, mean over [\d.]+\s?m?s$/;
    const [, x, unit] = await until('its values are shown', async () => pattern.exec(await textOf(page, '#picked-values')));
    assert.equal(unit, 'mm');
    assert.ok(Math.abs(Number(x) - 1000 * (0.65 * (20 / 59) - 0.325)) < 0.6, `x is ${x} mm`);
    const first = await textOf(page, '#picked-values');
    await until('its values change', async () => (await textOf(page, '#picked-values')) !== first);

    const { target } = await viz(page, 'camera');
    await page.click('#picked-follow');
    const follows = () => page.evaluate((mat) => Math.hypot(...window.viz.camera.target.map((value, k) => value - window.viz.position(mat)[k])), FIRST_BODY);
    await until('the camera looks at it', async () => (await follows()) < 0.02);
    assert.notDeepEqual((await viz(page, 'camera')).target, target);
    await page.click('#picked-close');
    assert.equal(await page.locator('#picked').isVisible(), false);
    await page.keyboard.press('1');
  },

  'a link that is clicked says its ends, its length and its state': async ({ page }) => {
    await pick(page, middleOfLink(page, HOOKED), /^joints\[23\]$/);
    assert.equal(await page.locator('#picked-follow').isVisible(), false);
    for (const state of ['free', 'hooked', 'free']) {
      const pattern = new RegExp(`^string\\[23\\] to string\\[24\\] · length [\\d.]+\\s?mm, [+−][\\d.]+ % since [\\d.]+ s · ${state}$`);
      await until(`it is ${state}`, async () => pattern.test(await textOf(page, '#picked-values')));
    }
    const stage = await page.locator('#stage').boundingBox();
    await page.mouse.click(stage.x + 100, stage.y + 120);
    await until('a click on nothing lets go of it', async () => !(await page.locator('#picked').isVisible()));
  },

  'what is picked is plotted: the way of a MAT, the length of a link': async ({ page }) => {
    await pick(page, placeOf(page, FIRST_BODY), /^string\[20\]$/);
    await page.click('#picked-plot');
    assert.equal(await page.locator('#picked-plot').getAttribute('aria-pressed'), 'true');
    assert.match(await textOf(page, '.trace .at'), /^string\[20\]: way from [\d.]+ s on$/);
    const metres = (text) => {
      const [, number, unit] = /^(-?[\d.]+)\s?(m|mm|µm|nm)$/.exec(text);
      return number * { m: 1, mm: 1e-3, 'µm': 1e-6, nm: 1e-9 }[unit];
    };
    await until('it has a value', async () => /\d/.test(await textOf(page, '.trace .series:nth-of-type(3) b')));
    // What the plot says and where the MAT is, of the same frame.
    const seen = async () => {
      await page.keyboard.press('h');
      await banner(page, 'view frozen');
      const y = await page.evaluate((mat) => window.viz.position(mat)[1], FIRST_BODY);
      const figure = metres(await textOf(page, '.trace .series:nth-of-type(3) b'));
      await page.keyboard.press('h');
      await banner(page, '');
      return [y, figure];
    };
    const [y0, way0] = await seen();
    await drawn(page, 7);
    const [y1, way1] = await seen();
    assert.ok(Math.abs(y1 - y0) > 1e-4, 'it has moved');
    assert.ok(Math.abs(way1 - way0 - (y1 - y0)) < 3e-4, `the plot went from ${way0} to ${way1}, the MAT from ${y0} to ${y1}`);
    await pick(page, middleOfLink(page, HOOKED), /^joints\[23\]$/);
    assert.equal(await page.locator('#picked-plot').getAttribute('aria-pressed'), 'false');
    await page.click('#picked-plot');
    await until('its length is plotted', async () => /^1\d\.\d\s?mm$/.test(await textOf(page, '.trace:has-text("joints[23]") b')));
    await page.screenshot({ path: join(out, 'marks_traces.png') });
    await page.click('#picked-plot');
    await page.click('.trace button');
    assert.equal(await page.locator('.trace').count(), 0);
    await page.click('#picked-close');
  },

  'components have colours and sizes, and one that is torn off has its own': async ({ page }) => {
    const { bodies } = palettes.dark; // the link behind string[32] does nothing: 33 and 27 MATs
    await page.selectOption('#colouring', 'components');
    await until('the sizes are in the legend', async () => (await legendOf(page)).some(([, text]) => text === '27 MATs'));
    assert.deepEqual((await legendOf(page)).slice(0, 2), [
      ['mass', 'joined by links: 33 MATs', bodies[0]],
      ['mass', '27 MATs', bodies[1]],
    ]);
    await drawn(page, 2);
    assertHue((await look(page, 30)).colour, bodies[0], 'the last but one of the larger component');
    assertHue((await look(page, 35)).colour, bodies[1], 'the smaller component');
    await pick(page, placeOf(page, 35), /^string2\[5\]$/);
    await until('its component is said', async () => / · component 2 by size, 27 MATs$/.test(await textOf(page, '#picked-values')));
    await page.click('#picked-close');
  },

  'links have the colour of their stretch, with a scale that says since when': async ({ page }) => {
    await page.keyboard.press('c');
    assert.equal(await page.locator('#colouring').inputValue(), 'stretch');
    const texts = () => page.evaluate(() => ['low', 'high', 'caption'].map((part) => document.querySelector(`#scale-${part}`).textContent)); // of one frame
    const [low, high, caption] = await until('links are longer and shorter', async () => {
      const all = await texts();
      return /^\+[\d.]+ %$/.test(all[1]) && Number.parseFloat(all[1]) > 0 && all;
    });
    assert.equal(low.slice(1), high.slice(1));
    assert.match(caption, /^length of links against that at [\d.]+ s; balls are drawn small$/);
    await pick(page, middleOfLink(page, 45), /^joints\[45\]$/);
    const longer = async () => Number(/, ([+−][\d.]+(?:e-\d+)?) % since/.exec(await textOf(page, '#picked-values'))?.[1].replace('−', '-') ?? 0);
    await until('a link is longer', async () => {
      const share = await longer();
      if (share < 0) await page.keyboard.press('r'); // it may have been at its longest
      return share > 0;
    });
    await page.screenshot({ path: join(out, 'marks_stretch.png') });
    await page.click('#picked-close');
    await page.keyboard.press('c');
    assert.equal(await page.locator('#colouring').inputValue(), 'bodies');
    assert.equal(await page.locator('#scale').isVisible(), false);
  },

  'motion is drawn larger than it is, and the view says so': async ({ page }) => {
    const height = async (factor) => {
      await page.selectOption('#motion', String(factor));
      return (await placeOf(page, FIRST_BODY)()).y;
    };
    await until('the view is frozen away from where the ball was', async () => {
      await page.keyboard.press('h');
      await banner(page, 'view frozen');
      if (Math.abs((await height(2)) - (await height(1))) > 0.3) return true;
      await page.keyboard.press('h');
      await banner(page, '');
      return false;
    });
    const place = await page.evaluate((mat) => window.viz.position(mat), FIRST_BODY);
    const [y1, y2, y5] = [await height(1), await height(2), await height(5)];
    assert.ok(Math.abs(y5 - y1 - 4 * (y2 - y1)) < 0.05, `four times as far from ${y1}: ${y2} and ${y5}`);
    assert.deepEqual(await page.evaluate((mat) => window.viz.position(mat), FIRST_BODY), place, 'what is said of it is true');
    await until('the view says so', async () => /^motion ×5, from where it was at [\d.]+ s$/.test(await textOf(page, '#exaggeration')));
    await page.keyboard.press('f');
    await until('it is seen', async () => {
      const stage = await page.locator('#stage').boundingBox();
      const { y } = await placeOf(page, FIRST_BODY)();
      return y > stage.y && y < stage.y + stage.height;
    });
    assertHue((await look(page, FIRST_BODY)).colour, palettes.dark.bodies[0], 'the ball where it is drawn');
    await page.screenshot({ path: join(out, 'marks_motion.png') });
    await page.keyboard.press('r');
    const [here, real] = await page.evaluate((mat) => [window.viz.project(mat), window.viz.screenOf(window.viz.position(mat))], FIRST_BODY);
    assert.ok(Math.abs(here.y - real.y) < 0.01, 'counted from now, it is where it is');
    await page.selectOption('#motion', '100');
    await page.keyboard.press('m');
    assert.equal(await page.locator('#motion').inputValue(), '1');
    await until('the view says nothing', async () => !(await page.locator('#exaggeration').isVisible()));
    await page.keyboard.press('h');
    await banner(page, '');
    await page.keyboard.press('1');
    await page.keyboard.press('f');
  },

  'trails show where MATs have been': async ({ page }) => {
    await page.keyboard.press('g'); // no grid behind them
    await page.keyboard.press('t');
    assert.equal(await isPressed(page, 't'), 'true');
    await drawn(page, 20);
    await page.keyboard.press('h');
    await banner(page, 'view frozen');
    const lit = () =>
      page.evaluate((mat) => {
        const { x, y } = window.viz.project(mat);
        const heights = Array.from({ length: 61 }, (_, k) => k - 30).filter((dy) => Math.abs(dy) > 8);
        return heights.filter((dy) => Math.max(...window.viz.pixelAt(x, y + dy)) > 40).length;
      }, FIRST_BODY);
    const withTrails = await lit();
    await page.screenshot({ path: join(out, 'marks_trails.png') });
    await page.keyboard.press('t');
    const without = await lit();
    assert.ok(withTrails > without + 5, `${withTrails} pixels with trails, ${without} without`);
    await page.keyboard.press('h');
    await banner(page, '');
    await page.keyboard.press('g');
  },

  'names are written into the view, and are no more': async ({ page }) => {
    const ink = async () => {
      const { x, y } = await page.evaluate((mat) => window.viz.project(mat), 14); // the middle of the first body
      return page.evaluate(inkAround, { x: x + 25, y: y - 8, reach: 16 });
    };
    await drawn(page, 2);
    assert.equal(await ink(), 0);
    await page.keyboard.press('n');
    assert.equal(await isPressed(page, 'n'), 'true');
    await until('the name is there', async () => (await ink()) > 50);
    await page.screenshot({ path: join(out, 'marks_names.png') });
    await page.keyboard.press('n');
    await until('the name is gone', async () => (await ink()) === 0);
    assert.equal(await isPressed(page, 'n'), 'false');
  },

  'the list of keys names every button, and takes the keys meanwhile': async ({ page }) => {
    await page.keyboard.press('?');
    await until('the list is open', () => page.locator('#keys').isVisible());
    const listed = (await page.locator('#keys dt').allTextContents()).join(' ').split(' ');
    const keys = await page.locator('#tools button').evaluateAll((buttons) => buttons.map(({ dataset }) => dataset.key));
    assert.deepEqual(keys.filter((key) => !listed.includes(key)), []);
    await page.keyboard.press('h');
    await page.keyboard.press('?');
    await until('the list is closed', async () => !(await page.locator('#keys').isVisible()));
    assert.equal(await viz(page, 'frozen'), false);
    await page.keyboard.press('?');
    await page.keyboard.press('Escape');
    await until('Escape closes it too', async () => !(await page.locator('#keys').isVisible()));
  },

  'space presses the button that has the focus, and commands nothing': async ({ page }) => {
    await page.focus('#tools button[data-key="h"]');
    await page.keyboard.press(' ');
    await banner(page, 'view frozen');
    assert.equal(await isPressed(page, 'h'), 'true');
    await page.focus('#tools button[data-key="h"]');
    await page.keyboard.press('Enter');
    await banner(page, '');
  },

  'the light theme is light, readable like the dark one, and kept': async ({ page }) => {
    const theme = () => page.evaluate(() => document.documentElement.dataset.theme);
    await pick(page, placeOf(page, FIRST_BODY), /^string\[20\]$/);
    assert.equal(await theme(), 'dark');
    assert.deepEqual(await page.evaluate(faintTexts, MIN_CONTRAST), []);
    await page.keyboard.press('l');
    assert.equal(await theme(), 'light');
    assert.deepEqual(await page.evaluate(faintTexts, MIN_CONTRAST), []);
    const { left, top } = await page.evaluate(() => document.querySelector('#stage').getBoundingClientRect());
    const colour = await page.evaluate(([x, y]) => window.viz.pixelAt(x, y), [left + 33, top + 207]);
    assert.ok(Math.min(...colour) > 200, `the ground is light: ${colour}`);
    await until('the second body has its light colour', async () => {
      const shade = (await look(page, SECOND_BODY)).colour;
      return shade[1] > shade[0] + 40 && shade[1] > shade[2] + 20;
    });
    assert.equal((await legendOf(page))[0][2], palettes.light.bodies[0]);
    await page.screenshot({ path: join(out, 'marks_light.png') });
    await page.reload();
    await until('it draws again', async () => (await page.evaluate(() => window.viz?.framesDrawn ?? 0)) > 3);
    assert.equal(await theme(), 'light');
    await page.click('#tools button[data-key="l"]');
    assert.equal(await theme(), 'dark');
  },

  'the page fills the screen, and leaves it': async ({ page }) => {
    const fills = () => page.evaluate(() => document.fullscreenElement !== null);
    await page.keyboard.press('u');
    await until('it fills the screen', fills);
    await page.keyboard.press('u');
    await until('it has left the screen', async () => !(await fills()));
  },

  'the force on a port is said, and drawn when arrows are wanted': async ({ page }) => {
    const below = async () => {
      const { x, y } = await page.evaluate((mat) => window.viz.project(mat), HANDLE);
      return page.evaluate(inkAround, { x, y: y + 70, reach: 12 });
    };
    assert.deepEqual(await page.evaluate((mat) => window.viz.force(mat), HANDLE), [0, -0.25, 0]);
    assert.equal(await below(), 0);
    await page.keyboard.press('a');
    assert.equal(await isPressed(page, 'a'), 'true');
    await until('an arrow points down', async () => (await below()) > 20);
    await pick(page, placeOf(page, HANDLE), /./);
    await until('its panel says the force', async () => / · force on the port 250\s?mN$/.test(await textOf(page, '#picked-values')));
    await page.screenshot({ path: join(out, 'marks_forces.png') });
    await page.click('#picked-close');
    await page.keyboard.press('a');
    await until('the arrow is gone', async () => (await below()) === 0);
    assert.equal(await isPressed(page, 'a'), 'false');
  },

  'bonds of sets are drawn in the colour of their state, and are in the legend': async (session) => {
    const { page } = session;
    await session.source.end();
    session.source = session.scene('--scene', 'grid', '--mats', '441', '--bonds');
    await until('the grid is drawn', async () => (await viz(page, 'lastFrame')).matCount === 441);
    const states = palettes.dark.link_states;
    const linesOf = async () => (await legendOf(page)).filter(([mark]) => mark.startsWith('link'));
    await until('not all are in the frames', async () => / \(the first 16.384 of all\), paste: stuck$/.test((await linesOf())[1][1]));
    await until('all are', async () => !(await linesOf())[1][1].includes('('));
    assert.deepEqual(await linesOf(), [
      ['link solid', 'link', states[0]],
      ['link solid', 'bond of sets, paste: stuck', states[1]],
      ['link solid', 'paste: torn', states[2]],
    ]);
    await page.keyboard.press('3'); // from above no link crosses a cell
    const [stuck, torn] = [[44, 66], [264, 286]]; // across a cell each
    await until('one is seen', async () => (await colouredBetween(page, ...stuck, states[1])) > 4);
    await page.screenshot({ path: join(out, 'marks_bonds.png') });
    assert.equal(await colouredBetween(page, ...torn, states[1]), 0, 'there is no bond');
    assert.equal(await colouredBetween(page, ...torn, states[2]), 0, 'one that does nothing is not drawn');
    await page.selectOption('#colouring', 'stretch');
    await drawn(page, 2);
    assert.equal(await colouredBetween(page, ...stuck, states[1]), 0, 'frames say nothing of its stretch');
    await page.selectOption('#colouring', 'bodies');
  },

  'a flat grid in one dimension is seen from above its edge': async (session) => {
    const { page } = session;
    await session.source.end();
    session.source = session.scene('--scene', 'grid', '--mats', '400', '--space', '1');
    await until('the grid is drawn', async () => (await viz(page, 'lastFrame')).matCount === 400);
    const { preset } = await viz(page, 'camera');
    assert.equal(preset, 'free');
    const [near, far] = await page.evaluate(() => [window.viz.project(0), window.viz.project(380)]);
    assert.ok(Math.abs(near.y - far.y) > 60, `its rows are apart: ${near.y} and ${far.y}`);
    await page.screenshot({ path: join(out, 'marks_drum.png') });
  },

  'states of several liaisons have line patterns of their own, and the legend says which': async (session) => {
    const { page } = session;
    await session.source.end();
    session.source = session.scene('--states', '--liaisons');
    await until('the string is drawn', async () => (await viz(page, 'lastFrame')).matCount === 60);
    const states = palettes.dark.link_states;
    await until('the legend has them', async () => (await legendOf(page)).length > 8);
    assert.deepEqual((await legendOf(page)).filter(([mark]) => mark.startsWith('link')), [
      ['link solid', 'link, hook: hooked', states[0]],
      ['link solid', 'hook: free', states[1]],
      ['link dashed', 'glue: stuck', states[0]],
      ['link dashed', 'glue: loose', states[1]],
      ['link dotted', 'without states', states[0]],
    ]);
    await pick(page, middleOfLink(page, 49), /^joints\[49\]$/);
    await until('its liaison is said', async () => / · glue: stuck$/.test(await textOf(page, '#picked-values')));
    await page.click('#picked-close');
    const gaps = await page.evaluate(() => {
      const [a, b] = [window.viz.project(44), window.viz.project(45)];
      const colours = Array.from({ length: 40 }, (_, k) => window.viz.pixelAt(a.x + ((b.x - a.x) * (k + 10)) / 60, a.y + ((b.y - a.y) * (k + 10)) / 60).join());
      return new Set(colours).size;
    });
    assert.ok(gaps > 1, 'a dashed link has gaps');
    await page.screenshot({ path: join(out, 'marks_patterns.png') });
  },

  'a scene that comes while the view is frozen is not drawn before the view goes on': async (session) => {
    const { page } = session;
    await page.keyboard.press('h');
    await banner(page, 'view frozen');
    const { number } = await viz(page, 'scene');
    await session.source.end();
    session.source = session.scene('--scene', 'grid', '--mats', '400', '--space', '1');
    await until('it is described', async () => (await viz(page, 'scene')).number > number);
    await page.keyboard.press('3');
    const stage = await page.locator('#stage').boundingBox();
    const colours = await page.evaluate(
      ({ x, y, width, height }) => [0.3, 0.45, 0.7].map((share) => window.viz.pixelAt(x + share * width, y + share * height)),
      stage,
    );
    assert.ok(colours.every((colour) => Math.max(...colour) < 60), `the view is empty: ${colours.join(' | ')}`);
    await page.keyboard.press('h');
    await until('it is drawn', async () => (await viz(page, 'lastFrame')).matCount === 400);
  },

  'nothing went wrong in the page': async ({ page, pageErrors }) => {
    assert.deepEqual([await viz(page, 'errors'), pageErrors], [[], []]);
  },
};

await runCases(cases, () => openScenePage('--states', '--bodies', '2'));
