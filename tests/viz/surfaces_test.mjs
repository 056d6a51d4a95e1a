// tests/viz/surfaces_test.mjs -- surfaces on the page: faces in their colours where the scene
// has them, behind and before matter, in the legend and in both themes. Real viz_node and headless
// Chromium; the surfaces are those of tests/support/surfaces.h.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { drawn, isDark, openScenePage, textOf, viz } from './browser.mjs';
import { out, runCases, source, until } from './session.mjs';

const palettes = JSON.parse(readFileSync(join(source, 'viz_node/colours.json'), 'utf8'));
const bytesOf = (hex) => [1, 3, 5].map((begin) => Number.parseInt(hex.slice(begin, begin + 2), 16));

/** The share of its colour that a face with this normal shows: key light from (-0.45, 0.75, 0.6). */
function lightOn([x, y, z]) {
  const key = (-0.45 * x + 0.75 * y + 0.6 * z) / Math.hypot(0.45, 0.75, 0.6);
  return Math.min(1, 0.7 + 0.1 * y + 0.3 * Math.max(key, 0));
}

const colourAt = (page, place) =>
  page.evaluate((at) => {
    const { x, y } = window.viz.screenOf(at);
    return window.viz.pixelAt(x, y);
  }, place);

async function assertFace(page, place, normal, theme) {
  const wanted = bytesOf(palettes[theme].surface).map((byte) => byte * lightOn(normal));
  const colour = await colourAt(page, place);
  const away = Math.max(...wanted.map((byte, k) => Math.abs(byte - colour[k])));
  assert.ok(away < 4, `the face at ${place} is ${colour}, not ${wanted.map(Math.round)}`);
}

// Places of faces that nothing is before; seen from the right, the next step hides most of a tread.
const TREADS = [0, 1, 2].map((step) => [0.27 + 0.06 * step, -0.1 + 0.05 * step, 0.085]);
const FRONTS = [0, 1, 2].map((step) => [0.27 + 0.06 * step, -0.13 + 0.02 * step, 0.1]);

const legendMarks = (page) => page.locator('#legend li.surface').evaluateAll((items) => items.map((item) => item.textContent));

async function assertStairs(page, theme) {
  await drawn(page, 2);
  for (const place of TREADS) await assertFace(page, place, [0, 1, 0], theme);
  for (const place of FRONTS) await assertFace(page, place, [0, 0, 1], theme);
}

const cases = {
  'steps have their treads and fronts, each with its light': async ({ page }) => {
    await page.keyboard.press('4');
    await assertStairs(page, 'dark');
    await page.screenshot({ path: join(out, 'surfaces.png') });
  },

  'the floor is a face from above, with lines of a grid, and lines alone from below': async ({ page }) => {
    await page.keyboard.press('4');
    await drawn(page, 2);
    const along = Array.from({ length: 200 }, (_, k) => [0.1 + 0.0005 * k, -0.15, 0.23]);
    const colours = await page.evaluate((places) => places.map((at) => window.viz.screenOf(at)).map(({ x, y }) => window.viz.pixelAt(x, y)), along);
    const face = bytesOf(palettes.dark.surface).map((byte) => byte * lightOn([0, 1, 0]));
    const isFace = (colour) => face.every((byte, k) => Math.abs(byte - colour[k]) < 4);
    const isLine = (colour) => colour.every((byte, k) => byte > face[k] + 10);
    assert.ok(colours.filter(isFace).length > 100, `${colours.filter(isFace).length} of 200 places on the floor are its face`);
    assert.ok(colours.filter(isLine).length > 0, 'no line of the floor is seen');
    // Dragged upwards: the viewer goes below the floor, whose face has only one side.
    const box = await page.locator('#stage').boundingBox();
    await page.mouse.move(box.x + 100, box.y + box.height - 150);
    await page.mouse.down();
    await page.mouse.move(box.x + 100, box.y + 60, { steps: 8 });
    await page.mouse.up();
    await until('the view is from below', async () => isDark(await colourAt(page, [0.11, -0.15, 0.24])));
    await page.screenshot({ path: join(out, 'surfaces_below.png') });
    await page.keyboard.press('4');
  },

  'a box hides what is behind it, and the view holds all bodies': async ({ page }) => {
    await page.keyboard.press('2'); // from the side: the highest step is before the lower ones and the matter
    await drawn(page, 2);
    await assertFace(page, [0.42, -0.05, 0.013], [1, 0, 0], 'dark');
    await page.keyboard.press('4');
    await drawn(page, 2);
    const box = await page.locator('#stage').boundingBox();
    for (const corner of [[0.42, -0.15, 0.1], [0.42, 0, -0.1], [0, 0.05, 0.3], [-0.4, -0.15, 0]]) {
      const { x, y } = await page.evaluate((at) => window.viz.screenOf(at), corner);
      assert.ok(x > box.x && x < box.x + box.width && y > box.y && y < box.y + box.height, `${corner} is at ${x}, ${y}`);
    }
    const { metresPerPixel } = await viz(page, 'camera');
    assert.ok(metresPerPixel < 0.004, `the planes have no end, and the view no ${metresPerPixel} m a pixel`);
  },

  'the legend names them': async ({ page }) => {
    assert.deepEqual(await legendMarks(page), ['surface: floor, wall, step …']);
  },

  'the light theme has its own colours': async ({ page }) => {
    await page.keyboard.press('l');
    await assertStairs(page, 'light');
    await page.screenshot({ path: join(out, 'surfaces_light.png') });
    await page.keyboard.press('l');
    await drawn(page, 2);
  },

  'a flat scene has sections': async (session) => {
    const { page } = session;
    await session.source.end();
    session.source = session.scene('--scene', 'string', '--surfaces');
    await until('the flat scene is there', async () => (await viz(page, 'scene'))?.space === 2 && (await viz(page, 'framesDrawn')) > 0);
    await drawn(page, 5);
    for (const place of FRONTS) await assertFace(page, [place[0], place[1], 0], [0, 0, 1], 'dark');
    const ink = await page.evaluate(() => Array.from({ length: 40 }, (_, k) => window.viz.screenOf([0.1, -0.155 + 0.00025 * k, 0])).map(({ x, y }) => window.viz.pixelAt(x, y)));
    const edge = bytesOf(palettes.dark.surface_edge);
    const behind = ink[0]; // a line between two pixels shares its light out to both
    const share = (colour) => edge.reduce((sum, byte, k) => sum + (colour[k] - behind[k]) / (byte - behind[k]), 0) / 3;
    const isBetween = (colour) => edge.every((byte, k) => Math.abs(behind[k] + share(colour) * (byte - behind[k]) - colour[k]) < 4);
    assert.ok(ink.some((colour) => share(colour) > 0.4 && isBetween(colour)), `the floor is a line: ${ink.join('; ')}`);
    await page.screenshot({ path: join(out, 'surfaces_flat.png') });
  },

  'a driven one is where its MAT is, and no port is drawn there': async (session) => {
    const { page } = session;
    await session.source.end();
    session.source = session.scene('--scene', 'grid', '--surfaces', '--driven', '--amplitude', '0.1');
    await until('the ram is there', async () => (await viz(page, 'scene'))?.space === 3 && (await viz(page, 'framesDrawn')) > 0);
    await page.keyboard.press('4');
    await drawn(page, 5);
    await page.screenshot({ path: join(out, 'surfaces_driven.png') });
    const wanted = bytesOf(palettes.dark.surface).map((byte) => byte * lightOn([0, 1, 0]));
    const heights = new Set();
    for (let round = 0; round < 12; ++round) {
      await drawn(page, 3);
      const { height, colours } = await page.evaluate(() => {
        const [x, y, z] = window.viz.position(window.viz.scene.matCount - 1);
        const tops = [[x, y + 0.01, z], [x + 0.04, y + 0.01, z + 0.04], [x - 0.04, y + 0.01, z - 0.04]];
        return { height: y, colours: tops.map((at) => window.viz.screenOf(at)).map((there) => window.viz.pixelAt(there.x, there.y)) };
      });
      heights.add(Math.round(height * 100));
      for (const colour of colours) assert.ok(wanted.every((byte, k) => Math.abs(byte - colour[k]) < 4), `at ${height} m its top is ${colour}, not ${wanted.map(Math.round)}`);
    }
    assert.ok(heights.size > 3, `it was at ${[...heights]} cm`);
  },

  'a scene without surfaces has none': async (session) => {
    const { page } = session;
    await session.source.end();
    session.source = session.scene('--scene', 'grid');
    await until('the next scene is there', async () => (await viz(page, 'scene'))?.space === 3 && (await legendMarks(page)).length === 0);
    await drawn(page, 5);
    assert.ok(isDark(await colourAt(page, TREADS[0])));
    assert.equal(await textOf(page, '#banner-title'), '');
  },

  'no error was reported': async ({ page, pageErrors }) => {
    assert.deepEqual([await viz(page, 'errors'), pageErrors], [[], []]);
  },
};

await runCases(cases, () => openScenePage('--scene', 'grid', '--surfaces'));
