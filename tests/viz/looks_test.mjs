// tests/viz/looks_test.mjs -- what scene and device say of how they look, and the force on what is
// picked, on the page. Real viz_node and headless Chromium.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { drawn, isDark, look, openScenePage, textOf, viz } from './browser.mjs';
import { out, runCases, source, until } from './session.mjs';

const [CORE, SKIN, BOB, PORT, TOOL] = [10, 30, 45, 12, 15]; // MATs
const TOOL_RADIUS_M = 0.03;
const [PITCH_M, WAY_M] = [0.01375, 0.01]; // of the keys of scene_source
const MASS_KG = 0.001;
const palettes = JSON.parse(readFileSync(join(source, 'viz_node/colours.json'), 'utf8'));

const bytesOf = (hex) => [1, 3, 5].map((begin) => Number.parseInt(hex.slice(begin, begin + 2), 16));
const legendOf = (page) =>
  page.locator('#legend li').evaluateAll((items) => items.map((item) => [item.className, item.textContent, item.style.getPropertyValue('--colour')]));

/** Shading makes a colour darker and leaves its hue. */
function assertHue(colour, hex, what) {
  const wanted = bytesOf(hex);
  const share = Math.max(...colour) / Math.max(...wanted);
  const away = Math.max(...wanted.map((byte, k) => Math.abs(byte * share - colour[k])));
  assert.ok(share > 0.4 && away < 55, `${what} is ${colour}, a shade of ${wanted}`);
}

/** How many pixels of the sheet of marks are inked. Runs in the page. */
function inkOfMarks() {
  const sheet = document.querySelector('#marks');
  const { data } = sheet.getContext('2d').getImageData(0, 0, sheet.width, sheet.height);
  return data.filter((_, i) => i % 4 === 3).filter((alpha) => alpha > 0).length;
}

/** The end of the scale of forces, and the force on each of these MATs with its colour: all of one frame. */
const seeForces = (page, mats) =>
  page.evaluate((all) => {
    const { force, project, pixelAt } = window.viz;
    // The page writes its scale ten times a second. A choice writes that of the frame drawn last.
    document.querySelector('#colouring').dispatchEvent(new Event('change'));
    const masses = all.map((mat) => {
      const { x, y } = project(mat);
      return { mat, sizeN: Math.hypot(...force(mat)), colour: pixelAt(x, y) };
    });
    return { high: document.querySelector('#scale-high').textContent, masses };
  }, mats);

async function pickCore(page) {
  await until('a MAT is picked', async () => {
    const { x, y } = await page.evaluate((mat) => window.viz.project(mat), CORE);
    await page.mouse.click(x, y);
    return (await page.locator('#picked').isVisible()) && /^rope\.core\[10\]$/.test(await textOf(page, '#picked-name'));
  });
}

const cases = {
  'matter has the colours of the scene, and the legend names them': async ({ page }) => {
    await drawn(page, 2);
    const masses = (await legendOf(page)).filter(([mark]) => mark === 'mass');
    assert.deepEqual(masses, [
      ['mass', 'rope.core', palettes.dark.bodies[0]],
      ['mass', 'rope.skin', '#c81e1e'],
      ['mass', 'string3', '#f5f500'],
    ]);
    const anchor = (await legendOf(page)).find(([, text]) => text === 'anchor, fixed');
    assert.equal(anchor[0], 'fixed-point');
    assertHue((await look(page, CORE)).colour, palettes.dark.bodies[0], 'matter without a colour of its own');
    assertHue((await look(page, SKIN)).colour, '#c81e1e', 'a part of a body');
    assertHue((await look(page, BOB)).colour, '#f5f500', 'a body');
    await page.screenshot({ path: join(out, 'looks_dark.png') });
  },

  'a colour that a theme hides is darker there, in the view as in the legend': async ({ page }) => {
    await page.keyboard.press('l');
    await drawn(page, 2);
    const [, , shown] = (await legendOf(page)).find(([, text]) => text === 'string3');
    assert.equal(shown, '#939614', 'yellow on white');
    assertHue((await look(page, BOB)).colour, shown, 'the body');
    await page.screenshot({ path: join(out, 'looks_light.png') });
    await page.keyboard.press('l');
  },

  'a person may still ask for other colours': async ({ page }) => {
    await page.selectOption('#colouring', 'stretch');
    await drawn(page, 2);
    assertHue((await look(page, BOB)).colour, palettes.dark.quiet, 'the body');
    assert.equal((await legendOf(page)).some(([mark, , colour]) => mark === 'mass' && colour === '#f5f500'), false);
    await page.selectOption('#colouring', 'bodies');
  },

  'a MAT that is picked says its net force, and shows it as an arrow on demand': async ({ page }) => {
    await pickCore(page);
    await until('its force is said', async () => /net force [\d.]+\s?(mN|µN|nN), mean over [\d.]+\s?m?s$/.test(await textOf(page, '#picked-values')));
    // The scene moves by formula: no acceleration is beyond that of its two modes.
    const modes = [[0.9, 1], [1.7, 0.4]];
    const largest = MASS_KG * 0.03 * modes.reduce((sum, [hz, share]) => sum + share * (2 * Math.PI * hz) ** 2, 0);
    for (let i = 0; i < 10; ++i) {
      const force = await page.evaluate((mat) => window.viz.force(mat), CORE);
      assert.ok(Math.abs(force[1]) <= 1.01 * largest, `${force[1]} N, at most ${largest} N`);
      assert.ok(Math.abs(force[0]) < 1e-4 * largest + 1e-6 && Math.abs(force[2]) < 1e-4 * largest + 1e-6, 'it moves along y');
      await drawn(page, 1);
    }
    assert.deepEqual(await page.evaluate((mat) => window.viz.force(mat), PORT), [0, -0.25, 0], 'of a port it is what the liaisons do to it');
    assert.equal(await page.evaluate(() => window.viz.force(0)), null, 'it is fixed');
    await page.keyboard.press('h');
    const without = await page.evaluate(inkOfMarks);
    assert.equal(await page.locator('#picked-force').getAttribute('aria-pressed'), 'false');
    await page.click('#picked-force');
    assert.equal(await page.locator('#picked-force').getAttribute('aria-pressed'), 'true');
    await until('the arrow is there', async () => (await page.evaluate(inkOfMarks)) > without + 60);
    await page.screenshot({ path: join(out, 'looks_force.png') });
    await page.click('#picked-force');
    await until('the arrow is gone', async () => (await page.evaluate(inkOfMarks)) === without);
    await page.keyboard.press('h');
    await page.click('#picked-close');
  },

  'masses have the colours of the net forces on them': async ({ page }) => {
    await page.selectOption('#colouring', 'force');
    await until('the scale says how much', async () => /^[\d.]+\s?(mN|µN)$/.test(await textOf(page, '#scale-high')) && Number.parseFloat(await textOf(page, '#scale-high')) > 0);
    await page.keyboard.press('h');
    assert.match(await textOf(page, '#scale-caption'), /^net force on free masses, mean over [\d.]+\s?m?s$/);
    const { high, masses } = await seeForces(page, [CORE - 5, CORE, SKIN, BOB]);
    const highN = Number.parseFloat(high) * (high.endsWith('mN') ? 1e-3 : 1e-6);
    const { speeds, port } = palettes.dark;
    for (const { mat, sizeN, colour } of masses) {
      const share = Math.min(1, sizeN / highN);
      const [from, to] = (share < 0.5 ? speeds.slice(0, 2) : speeds.slice(1)).map(bytesOf);
      const part = share < 0.5 ? 2 * share : 2 * share - 1;
      const wanted = `#${from.map((byte, k) => Math.round(byte + (to[k] - byte) * part).toString(16).padStart(2, '0')).join('')}`;
      assertHue(colour, wanted, `MAT ${mat} with ${share} of ${high}`);
    }
    assert.deepEqual((await legendOf(page)).filter(([mark]) => mark === 'mass' || mark === 'handle'), [['handle', 'handle of a device', port]]);
    await page.screenshot({ path: join(out, 'looks_forces.png') });
    await page.keyboard.press('h');
    await page.selectOption('#colouring', 'bodies');
  },

  'what is picked has its name at once': async ({ page }) => {
    await pickCore(page);
    await page.click('#picked-close');
    await until('another MAT is picked', async () => {
      const { x, y } = await page.evaluate((mat) => window.viz.project(mat), BOB);
      // Before the next frame is drawn, the panel names nothing else.
      const name = await page.evaluate(([left, top]) => {
        const stage = document.querySelector('#stage canvas');
        for (const type of ['pointerdown', 'pointerup'])
          stage.dispatchEvent(new PointerEvent(type, { bubbles: true, clientX: left, clientY: top, pointerId: 1, pointerType: 'mouse' }));
        return document.querySelector('#picked').hidden ? '' : document.querySelector('#picked-name').textContent;
      }, [x, y]);
      assert.notEqual(name, 'rope.core[10]', 'the name of what was picked before');
      return /^string3/.test(name);
    });
    await page.click('#picked-close');
  },

  'a link that is picked has no such button': async ({ page }) => {
    await pickCore(page);
    assert.equal(await page.locator('#picked-force').isVisible(), true);
    await until('a link is picked', async () => {
      const { x, y } = await page.evaluate((mat) => {
        const [a, b] = [window.viz.project(mat), window.viz.project(mat + 1)];
        return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 };
      }, CORE - 5);
      await page.mouse.click(x, y);
      return /^joints/.test(await textOf(page, '#picked-name'));
    });
    assert.equal(await page.locator('#picked-force').isVisible(), false);
    await page.click('#picked-close');
  },

  'a keyboard is drawn with its keys and their pitch': async ({ page }) => {
    await until('the keyboard is there', () => page.locator('#keyboards').isVisible());
    assert.match(await textOf(page, '#keyboards figcaption'), /^keyboard: 4 keys of 13\.75\s?mm, 55\s?mm side by side$/);
    const keys = page.locator('#keyboards button');
    assert.deepEqual(await keys.allTextContents(), ['0', '1', '2', '3']);
    assert.deepEqual(await keys.evaluateAll((all) => all.map(({ disabled }) => disabled)), [true, true, false, true], 'one plays a port');
  },

  'a key is as deep as its port, and one that is pressed says so': async ({ page }) => {
    const seen = () =>
      page.evaluate((mat) => {
        const key = document.querySelectorAll('#keyboards button')[2];
        return [window.viz.position(mat)[1], Number(key.style.getPropertyValue('--depth')), key.classList.contains('pressed'), key.ariaLabel];
      }, PORT);
    for (const wanted of [true, false, true]) {
      const [y, depth, , label] = await until(`it is ${wanted ? 'pressed' : 'up'}`, async () => {
        const all = await seen();
        return all[2] === wanted && all;
      });
      assert.ok(Math.abs(depth - Math.min(1, Math.max(0, -y / 0.01))) < 0.011, `${depth} deep at ${y} m`);
      assert.equal(label, `key 2, port finger: ${wanted ? 'pressed' : 'up'}`);
      if (wanted) await page.screenshot({ path: join(out, 'looks_keyboard.png') });
    }
  },

  'a key stands in the view at its port, as wide as its pitch, filled as far as it is down': async ({ page }) => {
    const key = (await legendOf(page)).find(([mark]) => mark === 'key');
    assert.deepEqual(key, ['key', 'key in true size, filled as far as it is down', palettes.dark.port]);
    // Ink on the sheet of marks at places of the key, with how far it is down in the same frame. The key is about 12 pixels
    // high: beside its outline one pixel has to do.
    const seen = () =>
      page.evaluate(
        async ([mat, pitch, way]) => {
          await new Promise(requestAnimationFrame); // after the page has drawn where the key is now
          const sheet = document.querySelector('#marks');
          const box = sheet.getBoundingClientRect();
          const [x, y] = window.viz.position(mat);
          const inkAt = (across, share, around = 1) => {
            const place = window.viz.screenOf([x + across * pitch, -share * way, 0]);
            const [left, top] = [place.x - box.left, place.y - box.top].map((value) => Math.round((value * sheet.width) / box.width));
            return sheet.getContext('2d').getImageData(left - around, top - around, 1 + 2 * around, 1 + 2 * around).data.some((byte, i) => i % 4 === 3 && byte > 0);
          };
          const [left, right, beside] = [-0.5, 0.5, 0.8].map((across) => inkAt(across, 0.5));
          return { down: -y / way, left, right, beside, end: inkAt(0.2, 1), below: inkAt(0.2, 1.5), high: inkAt(0.2, 0.3, 0), low: inkAt(0.2, 0.8, 0) };
        },
        [PORT, PITCH_M, WAY_M],
      );
    const when = (what, condition) =>
      until(what, async () => {
        const all = await seen();
        return condition(all.down) && all;
      });
    const outline = { left: true, right: true, beside: false, end: true, below: false };
    const { down: up, ...released } = await when('it is up', (share) => share < 0);
    assert.deepEqual(released, { ...outline, high: false, low: false }, `${up} deep`);
    const { down, ...pressed } = await when('it is down', (share) => share > 0.9);
    assert.deepEqual(pressed, { ...outline, high: true, low: true }, `${down} deep`);
    const { down: half, ...between } = await when('it is half down', (share) => share > 0.4 && share < 0.7);
    assert.deepEqual(between, { ...outline, high: true, low: false }, `${half} deep`);
    await page.screenshot({ path: join(out, 'looks_keys.png') });
  },

  'what a device holds is a ring of true size': async ({ page }) => {
    assert.deepEqual((await legendOf(page)).filter(([mark]) => mark === 'ring' || mark === 'tool'), [
      ['ring', 'tool that it holds, in true size', palettes.dark.port],
    ]);
    const [rim, hole, outside] = await page.evaluate(
      ([mat, radius]) => {
        const [x, y, z] = window.viz.position(mat);
        // Off the string, which runs through its middle.
        return [0.88, 0.6, 1.12].map((share) => {
          const place = window.viz.screenOf([x + 0.6 * share * radius, y + 0.8 * share * radius, z]);
          return window.viz.pixelAt(place.x, place.y);
        });
      },
      [TOOL, TOOL_RADIUS_M],
    );
    assertHue(rim, palettes.dark.port, 'the rim');
    assert.ok(isDark(hole) && isDark(outside), `${hole} inside, ${outside} outside`);
    await page.screenshot({ path: join(out, 'looks_ring.png') });
  },

  'a click on a key picks its port': async ({ page }) => {
    await page.click('#keyboards button >> nth=2');
    await until('its port is picked', async () => (await textOf(page, '#picked-name')) === 'finger');
    await page.click('#picked-close');
  },

  'a scene that is fitted stands above the keyboards, whose captions are readable over matter': async ({ page }) => {
    /** Where the camera looks after a fit [m], metres per pixel, and how much of the lower edge is taken [CSS pixels]. */
    const fitted = (hidden) =>
      page.evaluate(async (isHidden) => {
        const panel = document.querySelector('#keyboards');
        panel.hidden = isHidden;
        for (let n = 0; n < 3; ++n) await new Promise(requestAnimationFrame); // until the page knows of its size
        document.querySelector('#tools button[data-key="f"]').click();
        const tops = [panel, document.querySelector('#tools')].map((one) => one.getBoundingClientRect()).filter(({ height }) => height > 0).map(({ top }) => top);
        const { target, metresPerPixel } = window.viz.camera;
        return { y: target[1], metresPerPixel, taken: document.querySelector('#stage').getBoundingClientRect().bottom - Math.min(...tops) };
      }, hidden);
    const found = [];
    await page.keyboard.press('h');
    for (const [width, height] of [[1000, 700], [390, 800]]) {
      await page.setViewportSize({ width, height });
      const [without, below] = [await fitted(true), await fitted(false)];
      found.push({ wanted: (below.taken - without.taken) / 2, higher: (without.y - below.y) / below.metresPerPixel });
      await page.screenshot({ path: join(out, `looks_keyboard_${width}.png`) });
    }
    await page.keyboard.press('h');
    const [wide, narrow] = found;
    assert.ok(wide.wanted > 25 && Math.abs(wide.higher - wide.wanted) < 1, JSON.stringify(wide));
    // A part of the view is left to the scene, however much stands around it.
    assert.ok(narrow.wanted > 25 && narrow.higher > 0.8 * narrow.wanted && narrow.higher < narrow.wanted + 1, JSON.stringify(narrow));
    const [caption, hand] = await page.evaluate(() => ['#keyboards figcaption', '#hand'].map((one) => getComputedStyle(document.querySelector(one)).backgroundColor));
    assert.equal(caption, hand);
    const isBelow = await page.evaluate(() => Boolean(document.querySelector('#marks').compareDocumentPosition(document.querySelector('#head')) & Node.DOCUMENT_POSITION_FOLLOWING));
    assert.ok(isBelow, 'marks of the view lie below the panels');
  },

  'all of it has room on a telephone': async ({ page }) => {
    await page.setViewportSize({ width: 390, height: 800 });
    await drawn(page, 2);
    const inside = await page.locator('#keyboards button').evaluateAll((keys) => keys.every((key) => key.getBoundingClientRect().right <= window.innerWidth));
    assert.ok(inside, 'every key');
    await page.screenshot({ path: join(out, 'looks_narrow.png') });
    await page.setViewportSize({ width: 1400, height: 900 });
    await drawn(page, 2);
    await page.screenshot({ path: join(out, 'looks_wide.png') });
  },

  'the page has no error': async ({ page, pageErrors }) => {
    assert.deepEqual(await viz(page, 'errors'), []);
    assert.deepEqual(pageErrors, []);
  },
};

await runCases(cases, () => openScenePage('--scene', 'string', '--bodies', '3', '--colours', '--keyboard', '--tool-radius', String(TOOL_RADIUS_M)));
