// tests/viz/browser.mjs -- the real page in headless Chromium, and what it shows. Skipped with a
// reason where the browser or its driver is absent.
import { existsSync, mkdtempSync, rmSync } from 'node:fs';
import { hostname, tmpdir } from 'node:os';
import { join } from 'node:path';
import { LONGEST_MS, need, pageIsBuilt, pause, Session, skip, until } from './session.mjs';

const CHROMIUM = '/usr/bin/chromium';
/** A name of this machine that is not loopback to a browser. */
export const ownName = `${hostname().split('.')[0]}.local`;
const FLAGS = [
  '--headless',
  '--no-sandbox',
  '--disable-gpu',
  '--disable-quic',
  '--no-first-run',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
  `--host-resolver-rules=MAP ${ownName} 127.0.0.1`,
];

const { chromium } = need('playwright-core');
if (!existsSync(CHROMIUM)) skip(`${CHROMIUM} is not installed`);
if (!pageIsBuilt()) throw new Error('the packages are there, but the page was not built');

/** What window.viz says of `name`. */
export const viz = (page, name) => page.evaluate((key) => window.viz[key], name);

export async function drawn(page, count) {
  const begin = await viz(page, 'framesDrawn');
  await until(`${count} more frames were drawn`, async () => (await viz(page, 'framesDrawn')) >= begin + count);
}

/** The newest reply to a command of the page, when it reads so. */
export const replied = (page, pattern) =>
  until(`the reply reads ${pattern}`, async () => pattern.exec((await viz(page, 'replies')).at(-1)?.text ?? ''));

/** Place of a MAT on the page and the colours there and elsewhere, all of one frame. */
export const look = (page, mat, elsewhere = []) =>
  page.evaluate(
    ([index, places]) => {
      const point = window.viz.project(index);
      return { point, colour: window.viz.pixelAt(point.x, point.y), others: places.map(({ x, y }) => window.viz.pixelAt(x, y)) };
    },
    [mat, elsewhere],
  );

export const textOf = (page, selector) => page.locator(selector).textContent();
export const isDark = ([r, g, b]) => r + g + b < 190;

export async function banner(page, title) {
  await until(`the banner says "${title}"`, async () => (await textOf(page, '#banner-title')) === title);
}

/** Opens the page for `session`, which gets browser, page and pageErrors, and closes them before its programs. */
export async function openPage(session, url) {
  const profile = mkdtempSync(join(tmpdir(), 'cordis-chromium-'));
  session.browser = await chromium.launchPersistentContext(profile, {
    executablePath: CHROMIUM,
    args: FLAGS,
    viewport: { width: 1280, height: 720 },
    timeout: LONGEST_MS,
  });
  session.browser.setDefaultTimeout(LONGEST_MS);
  session.profile = profile;
  const closePrograms = session.close.bind(session);
  session.close = async () => {
    await session.browser.close();
    await closePrograms();
    rmSync(profile, { recursive: true, force: true });
  };
  session.pageErrors = [];
  session.page = session.browser.pages()[0] ?? (await session.browser.newPage());
  session.page.on('pageerror', (error) => session.pageErrors.push(String(error)));
  session.askPage = async () => {
    const asked = session.page
      .evaluate(() => {
        const { connected, frozen, framesReceived, framesDrawn, lastFrame, lag_s, dropped, nodes, scene, replies, errors } = window.viz;
        return JSON.stringify({ connected, frozen, framesReceived, framesDrawn, lastFrame, lag_s, dropped, nodes, scene, replies, errors });
      })
      .catch((error) => String(error));
    const state = await Promise.race([asked, pause(5000).then(() => 'no answer')]);
    session.pageState = `--- the page\n${state}\n`;
  };
  session.recover = async () => {
    try {
      await session.page.reload();
      await until('the page draws again', () => session.page.evaluate(() => (window.viz?.framesDrawn ?? 0) > 0));
    } catch (error) {
      console.error(String(error));
    }
  };
  await session.page.goto(url);
  await until('the page draws', () => session.page.evaluate(() => (window.viz?.framesDrawn ?? 0) > 0));
}

/** A session of `scene_source` with these words, its viz_node and the page. */
export async function openScenePage(...words) {
  const session = await Session.open();
  session.source = session.scene(...words);
  session.view = session.viz();
  session.url = await session.view.says(/page at (\S+)/);
  await openPage(session, session.url);
  return session;
}
