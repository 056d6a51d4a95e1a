// tests/viz/page_test.mjs -- the real page in headless Chromium, before a real viz_node: what it
// draws, what it says, and that it comes back by itself. Never how fast it is: that depends on the
// machine.
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { banner, drawn, isDark, look, openScenePage, textOf, viz } from './browser.mjs';
import { out, runCases, until } from './session.mjs';

const [MIDDLE, PORT, TOOL, IDLE] = [29, 12, 15, 32]; // MATs of the string of scene_source.cpp

/** What is beyond a window of this width, or upon something else. Runs in the page, all at one moment. */
function faultsOfLayout(width) {
  const boxesOf = (selector) => [...document.querySelectorAll(selector)].map((one) => one.getBoundingClientRect());
  const faults = window.innerWidth === width ? [] : [`the window has still ${window.innerWidth} pixels`];
  for (const selector of ['.figure', '#control button', '#tools button', '#legend li', '.plot', '#nodes tr']) {
    const beyond = boxesOf(selector).filter((box) => box.width === 0 || box.left < 0 || box.right > width);
    if (beyond.length > 0) faults.push(`${selector}: ${JSON.stringify(beyond)}`);
  }
  const [plots] = boxesOf('#plots');
  const plotted = boxesOf('.plot').reduce((sum, { height }) => sum + height, 0);
  if (!(plotted > 300 && plots.height > plotted - 1)) faults.push(`plots: ${plotted} of ${plots.height}`);
  const marks = ['#legend', '#control', '#ruler', '#tools'].flatMap(boxesOf);
  for (const [i, a] of marks.entries()) {
    for (const b of marks.slice(i + 1)) {
      const apart = a.right <= b.left || b.right <= a.left || a.bottom <= b.top || b.bottom <= a.top;
      if (!apart) faults.push(JSON.stringify([a, b]));
    }
  }
  return faults;
}

const cases = {
  'the string is drawn where it is, and moves': async ({ page }) => {
    await drawn(page, 10);
    const scene = await viz(page, 'scene');
    assert.deepEqual([scene.name, scene.space, scene.matCount, scene.linkCount], ['string', 2, 60, 59]);

    const first = await look(page, MIDDLE);
    assert.ok(first.colour[2] > 130 && first.colour[2] > first.colour[0] + 30, `a mass is blue: ${first.colour}`);
    const port = await look(page, PORT);
    const isAmber = ([r, , b]) => r > 130 && r > b + 60;
    assert.ok(isAmber(port.colour), `a port is amber: ${port.colour}`);
    const tool = await look(page, TOOL);
    assert.ok(isAmber(tool.colour), `and so is what a hand holds: ${tool.colour}`);

    const later = await until('the middle has moved by 30 pixels', async () => {
      const now = await look(page, MIDDLE, [first.point]);
      return Math.abs(now.point.y - first.point.y) > 30 && now;
    });
    assert.ok(later.colour[2] > 130, `it is drawn at its new place: ${later.colour}`);
    assert.ok(isDark(later.others[0]), `and no longer at the old one: ${later.others[0]}`);
  },

  'the whole string fits into the first view, seen from the front': async ({ page }) => {
    const camera = await viz(page, 'camera');
    assert.equal(camera.preset, 'front');
    assert.ok(camera.orthographic);
    const stage = await page.locator('#stage').boundingBox();
    const [left, right] = [await look(page, 0), await look(page, 59)];
    assert.ok(left.point.x > stage.x && right.point.x < stage.x + stage.width);
    assert.ok(right.point.x - left.point.x > 0.7 * stage.width);
  },

  'a link has the colour of its state': async ({ page }) => {
    // The line between a MAT and the next is one pixel thin: the most coloured one of a few around its middle counts.
    const linkAfter = (mat) =>
      page.evaluate((index) => {
        const [a, b] = [window.viz.project(index), window.viz.project(index + 1)];
        const shades = [-2, -1, 0, 1, 2].map((dy) => window.viz.pixelAt((a.x + b.x) / 2, (a.y + b.y) / 2 + dy));
        return shades.sort((p, q) => q[0] + q[1] + q[2] - (p[0] + p[1] + p[2]))[0];
      }, mat);
    const isAmber = ([r, , b]) => r > 120 && r > b + 50;
    const isBlue = ([r, , b]) => b > 80 && b > r + 20;
    for (const [colour, fits] of [['amber', isAmber], ['blue', isBlue], ['amber', isAmber]]) {
      await until(`the link turns ${colour}`, async () => fits(await linkAfter(MIDDLE)));
      const other = await linkAfter(MIDDLE + 1);
      assert.ok(isBlue(other), `its neighbour stays blue: ${other}`);
    }
    const idle = await linkAfter(IDLE);
    assert.ok(isDark(idle), `a link that does nothing is not drawn: ${idle}`);
  },

  'every figure is there, and true': async ({ page, url }) => {
    await until('real time is known', async () => /^×\d/.test(await textOf(page, '#factor')));
    const figures = {
      session: /^viz_test$/,
      scene: /^string · 60 MATs$/,
      loop: /^\d+\.\d$/,
      'loop-more': /^\/ 1000 Hz$/,
      overruns: /^3$/,
      'overruns-more': /^\d\.\d{3} %$/,
      latency: /^92\.0\sµs$/,
      'latency-p99': /^310\sµs$/,
      'latency-max': /^1\.90\sms$/,
      'latency-device': /keyboard/,
      energy: /^12\.0\smJ$/,
      'energy-more': /^drift 2\.5e-9, error 2(\.0+)?\s?µJ$/,
      'by-ports': /^3\.00\smJ$/,
      'by-switching': /^250\sµJ$/,
      'by-viscosity': /^1\.20\smJ$/,
      limit: /^1\.75 of 4$/,
      time: /^\d+\.\d\d$/,
      lag: /^[\d,\s]+$/,
      dropped: /^[\d,\s]+$/,
    };
    for (const [id, pattern] of Object.entries(figures)) {
      await until(`#${id} reads ${pattern}`, async () => pattern.test(await textOf(page, `#${id}`)));
    }
    const names = async () => (await page.locator('#nodes tr').allTextContents()).map((row) => /^(sim|keyboard|view)/.exec(row)?.[0]);
    await until('every node has its row', async () => String(await names()) === 'sim,keyboard,view');
    const lost = page.locator('#nodes td.lost').first();
    assert.equal(await lost.textContent(), '7 lost');
    assert.match(await lost.getAttribute('title'), /^messages lost, late or refused/);
    const link = /^keyboard: round trip 92\.0\sµs, 1\.20 % of 20.000 samples without an answer$/;
    assert.match(await page.locator('#latency').getAttribute('title'), link);
    assert.equal(await page.locator('#nodes tr', { hasText: 'keyboard' }).locator('td.lost').textContent(), '1.2 % lost');
    await page.evaluate(() => document.querySelectorAll('#nodes td').forEach((cell) => (cell.isTheFirst = true)));
    const since = await textOf(page, '#time');
    await until('the figures go on', async () => Number(await textOf(page, '#time')) > Number(since) + 1);
    const stay = await page.locator('#nodes td').evaluateAll((cells) => cells.every((cell) => cell.isTheFirst));
    assert.ok(stay, 'a row stays the same element while its text changes');
    const view = (await viz(page, 'nodes')).find((node) => node.kind === 'viz_node');
    assert.equal(view.text, url);
    await page.screenshot({ path: join(out, 'page_string.png') });
  },

  'the view keeps up, and signals come at full rate': async ({ page }) => {
    await drawn(page, 25);
    await until('the view is not old', async () => {
      const lag = await viz(page, 'lag_s');
      return lag >= 0 && lag < 2;
    });
    const signals = await viz(page, 'signals');
    assert.equal(signals.count, 3);
    await until('signals and view show the same time', async () => {
      const [newestS, simulatedS] = await page.evaluate(() => [window.viz.signals.newestS, window.viz.lastFrame.simulatedS]);
      return Math.abs(newestS - simulatedS) < 2;
    });
    // A page that is left without a processor for longer than viz_node keeps signals misses some.
    await until('500 rows came without a gap', async () => {
      const before = await viz(page, 'signals');
      const now = await until('500 more rows came', async () => {
        const later = await viz(page, 'signals');
        return later.newestS >= before.newestS + 0.5 && later;
      });
      return now.gaps === before.gaps;
    });
    assert.ok((await page.locator('#plots canvas').count()) === 3, 'one plot per unit');
    assert.match(await textOf(page, '.plot:first-child .series b'), /^-?\d.*m$/);
  },

  'troubles of the steps are shown, and those that never came are not': async ({ page }) => {
    await until('inputs were refused', async () => (await textOf(page, '#troubles')) === '3 inputs refused');
  },

  'keys turn the camera, colour by speed, freeze the view': async ({ page }) => {
    const camera = (what, fits) => until(what, async () => fits(await viz(page, 'camera')));
    await page.keyboard.press('3');
    await camera('it looks from the top', ({ preset }) => preset === 'top');
    await page.keyboard.press('o');
    await camera('it has a perspective', ({ orthographic }) => !orthographic);
    await page.keyboard.press('o');
    await page.keyboard.press('1');
    await camera('it looks from the front again', ({ preset, orthographic }) => preset === 'front' && orthographic);
    await page.mouse.move(400, 300);
    const before = (await viz(page, 'camera')).metresPerPixel;
    await page.mouse.wheel(0, -400);
    await until('the wheel has zoomed', async () => (await viz(page, 'camera')).metresPerPixel < 0.95 * before);
    await page.keyboard.press('f');
    await until('the scene fits again', async () => (await viz(page, 'camera')).metresPerPixel > 0.97 * before);

    await page.keyboard.press('c');
    await drawn(page, 5);
    await until('a slow place is not the blue of a mass', async () => (await look(page, MIDDLE)).colour[2] < 240);
    await until('the fastest speed is reported', async () => /m\/s$/.test(await textOf(page, '#scale-high')));
    await page.selectOption('#colouring', 'bodies');

    await page.keyboard.press('h');
    await banner(page, 'view frozen');
    const frozen = await viz(page, 'framesDrawn');
    const came = await viz(page, 'framesReceived');
    await until('frames still come', async () => (await viz(page, 'framesReceived')) > came + 5);
    assert.equal(await viz(page, 'framesDrawn'), frozen);
    await page.keyboard.press('h');
    await drawn(page, 3);
  },

  'a narrow window shows all of it, and nothing upon something else': async ({ page }) => {
    for (const width of [1024, 480, 360]) {
      await page.setViewportSize({ width, height: 720 });
      let faults = [];
      const fits = async () => (faults = await page.evaluate(faultsOfLayout, width)).length === 0;
      await until(`it fits into ${width} pixels`, fits, 60_000).catch((error) => {
        throw new Error(`${error.message}\n${faults.join('\n')}`);
      });
    }
    await page.setViewportSize({ width: 1280, height: 720 });
  },

  'a second page shows the same, and passes the query of its address on': async ({ browser, url, page }) => {
    const second = await browser.newPage();
    const [socket] = await Promise.all([second.waitForEvent('websocket'), second.goto(`${url}/?every=5`)]);
    assert.match(socket.url(), /\/live\?every=5$/);
    await until('it draws', async () => (await viz(second, 'framesDrawn')) > 5);
    await second.close();
    await page.bringToFront();
    await drawn(page, 5);
  },

  'it finds viz_node again after a kill': async (session) => {
    const { page } = session;
    const { port } = new URL(session.url);
    await session.view.end('SIGKILL');
    await banner(page, 'viz_node is gone');
    assert.equal(await viz(page, 'connected'), false);
    const dots = await page.locator('#nodes td.state').evaluateAll((cells) => cells.map((cell) => getComputedStyle(cell, '::before').backgroundColor));
    const quiet = await page.locator('#brand span').evaluate((text) => getComputedStyle(text).color);
    assert.ok(dots.length > 0 && dots.every((dot) => dot === quiet), `no node is shown as running: ${dots}`);
    session.view = session.viz(`view.port=${port}`);
    await session.view.says(/page at (\S+)/);
    await drawn(page, 10);
    await banner(page, '');
  },

  'it says when the simulation or a device is gone, and goes on with the next one': async (session) => {
    const { page } = session;
    await session.source.end('SIGKILL');
    await banner(page, 'waiting for sim_node');
    assert.match(await textOf(page, '#banner-text'), /sim was last heard/);
    assert.equal(await textOf(page, '#loop'), '–');
    await page.screenshot({ path: join(out, 'page_waiting.png') });
    const refusal = "port 'key' is as stiff as 3100 N/m, and the device 'keyboard' supports 1001 N/m: driver kfb1 is given no force";
    session.source = session.scene('--refusal', refusal);
    await banner(page, 'a device gets no force');
    assert.equal(await textOf(page, '#banner-text'), `${refusal}.`);
    await page.screenshot({ path: join(out, 'page_refusal.png') });
    await session.source.end('SIGKILL');
    await banner(page, 'waiting for sim_node');
    session.source = session.scene('--scene', 'grid', '--mats', '900');
    await until('the new scene is drawn', async () => (await viz(page, 'lastFrame'))?.matCount === 900);
    await drawn(page, 10);
    await banner(page, '');
    await until('it has depth', async () => !(await viz(page, 'camera')).orthographic);
    await page.screenshot({ path: join(out, 'page_grid.png') });
  },

  'what grows out of the view is followed, until a person moves the camera': async (session) => {
    const { page } = session;
    await session.source.end('SIGKILL');
    session.source = session.scene('--amplitude', '0.5'); // at first all of it is above 0, half a second later below
    await until('the new scene is drawn', async () => (await viz(page, 'lastFrame')).matCount === 60);
    const stage = await page.locator('#stage').boundingBox();
    // Height of the middle [m] and its place on the page, of one frame.
    const middle = () =>
      page.evaluate((mat) => ({ height: window.viz.position(mat)[1], point: window.viz.project(mat) }), MIDDLE);
    const isLow = async () => {
      const now = await middle();
      return now.height < -0.4 && now;
    };
    await until('it has been low', isLow);
    await drawn(page, 10);
    const { y } = (await until('it is low again', isLow)).point;
    assert.ok(y > stage.y && y < stage.y + stage.height, `the middle is at ${y}, the view at ${JSON.stringify(stage)}`);
    assert.ok((await viz(page, 'camera')).orthographic);

    const far = (await viz(page, 'camera')).metresPerPixel;
    await page.mouse.move(400, 300);
    await page.mouse.wheel(0, -1500);
    const near = await until('the wheel has zoomed', async () => {
      const { metresPerPixel } = await viz(page, 'camera');
      return metresPerPixel < 0.6 * far && metresPerPixel;
    });
    await until('it is high', async () => !(await isLow()));
    await until('it is low once more', isLow);
    await drawn(page, 6);
    assert.equal((await viz(page, 'camera')).metresPerPixel, near);
  },

  'nothing went wrong in the page': async ({ page, pageErrors }) => {
    assert.deepEqual(await viz(page, 'errors'), []);
    assert.deepEqual(pageErrors, []);
  },
};

await runCases(cases, () => openScenePage('--states'));
