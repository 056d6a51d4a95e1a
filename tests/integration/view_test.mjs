// tests/integration/view_test.mjs -- the view goes on, whatever a person presses: every button,
// list and input of the page, and scenes loaded on the page and from a shell, while frames are on
// their way. Real sim_node, device_node, viz_node, launcher and Chromium. The page itself says what
// there is to press. What is pressed next is drawn by lot; the seed is printed.
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { drawn, openPage, viz } from '../viz/browser.mjs';
import { lot, pause, program, runCases, Session, source, until } from '../viz/session.mjs';

const DESCRIPTIONS = 50; // resets and loads
const MAX_ROUNDS = 100;
const LAUNCH = join(source, 'launch_configs/plucked_string.yaml');
const SCENES = ['membrane', 'hanging_chain', 'plucked_string'].map((name) => join(source, `launch_configs/scenes/${name}.yaml`));
/** Controls that are not there in this session, by name, and which test presses them. */
const ELSEWHERE = {
  '#sound-on': 'of a scene that sounds: sound_page_test.mjs',
  '#volume': 'of a scene that sounds: sound_page_test.mjs',
  '#seek': 'of a take: take_page_test.mjs',
  '#take-rate': 'of a take: take_page_test.mjs',
};

/**
 * The controls of the page by name, whether each can be used now, and whether it is off. What the page makes, as the sliders of
 * parameters, has the name of its kind. Runs in the page. @param press  name of one that is used first
 */
function controls([fixedIds, press, chance]) {
  const nameOf = (control) => {
    const data = Object.entries(control.dataset).map(([key, value]) => `[data-${key}="${value}"]`).join('');
    if (fixedIds.includes(control.id)) return `#${control.id}`;
    let near = control.parentElement;
    while (near !== null && !fixedIds.includes(near.id)) near = near.parentElement;
    const kind = control.matches('input') ? `[type=${control.type}]` : control.matches('button') && data === '' ? ` "${control.textContent}"` : '';
    return `#${near?.id} ${control.localName}${kind}${data}`;
  };
  const use = (control) => {
    const isNumber = control.type === 'range' || control.type === 'number';
    if (control.matches('select')) {
      const first = control.id === 'scenes' ? 1 : 0; // before it stands what the list is for
      control.selectedIndex = first + Math.floor(chance * (control.options.length - first));
    } else if (isNumber) {
      const [min, max] = control.type === 'range' ? [Number(control.min), Number(control.max)] : [0, 2 * Number(control.value)];
      const tenth = (max - min) / 10;
      control.value = String(Number(control.value) + (Number(control.value) > (min + max) / 2 ? -tenth : tenth));
    } else {
      return control.click();
    }
    for (const type of ['input', 'change']) control.dispatchEvent(new Event(type, { bubbles: true }));
  };
  const isUsable = (control) => control.checkVisibility() && !control.disabled;
  const all = () => [...document.querySelectorAll('button, input, select, textarea, summary, a[href], [role=button], [contenteditable]')];
  const named = all().filter((control) => press !== undefined && nameOf(control) === press && isUsable(control));
  if (named.length > 0) use(named[Math.floor(chance * named.length)]);
  return all().map((control) => ({ name: nameOf(control), usable: isUsable(control), off: control.ariaPressed === 'false' }));
}

/** Does something that describes the scene again, and waits until the page has the new description. */
async function describeAnew(page, what, action) {
  const before = (await viz(page, 'scene')).number;
  await action();
  await until(`the page has the scene after ${what}`, async () => (await viz(page, 'scene')).number > before);
}

async function load(session, file) {
  const words = ['ctl', LAUNCH, 'load', file, '--domain', session.domain, '--timeout', '60s'];
  assert.equal(await session.start('ctl', program('cordis'), words).ended, 0, `load ${file}`);
}

async function answered(page, verb, action) {
  const newest = async () => (await viz(page, 'replies')).at(-1)?.number ?? 0;
  const before = await newest();
  await action();
  await until(`${verb} is answered`, async () => (await newest()) > before);
}

/** A person before the page, who draws by lot what comes next. */
class Person {
  known = new Set(); // names of controls that have been there
  used = new Set();
  log = [];

  constructor(session, draw, fixedIds) {
    Object.assign(this, { session, page: session.page, draw, fixedIds });
  }

  of = (list) => list[Math.floor(this.draw() * list.length)];

  /** The page's controls, after one of them was used. */
  async controls(press, chance) {
    const all = await this.page.evaluate(controls, [this.fixedIds, press, chance]);
    for (const { name } of all) this.known.add(name);
    return all;
  }

  /** Names of what has not been used: of what can be now, and of the rest. */
  async left() {
    const now = new Set((await this.controls()).filter(({ usable }) => usable).map(({ name }) => name));
    const unused = [...this.known].filter((name) => !this.used.has(name) && !(name in ELSEWHERE));
    return { usable: unused.filter((name) => now.has(name)), hidden: unused.filter((name) => !now.has(name)) };
  }

  /** Uses a control at once, wherever the page is in drawing. */
  async use(name) {
    const { page } = this;
    this.used.add(name);
    this.log.push(name);
    const press = () => this.controls(name, this.draw());
    if (name.endsWith('[data-verb="reset"]') || name === '#scenes') return describeAnew(page, name, press);
    if (name.includes('[data-verb=')) return answered(page, name, press);
    return press();
  }

  /** Has the scene described again, in one of three ways. */
  async describe() {
    const way = this.of(['reset', 'reset', 'list', 'list', 'shell']);
    if (way === 'reset') return this.use('#control button[data-verb="reset"]');
    if (way === 'list') return this.use('#scenes');
    return this.load(this.of(SCENES));
  }

  load(file) {
    this.log.push(`ctl load ${file}`);
    return describeAnew(this.page, `load ${file}`, () => load(this.session, file));
  }

  /** Shows all that buttons hide: signals to choose, one against another, parameters, a mass that is picked, and its way. */
  async showAll() {
    await this.load(SCENES[2]); // it has signals, keys and parameters
    if (await viz(this.page, 'frozen')) await this.page.keyboard.press('h');
    await until('a mass is picked', async () => {
      if (!(await this.page.locator('#picked').isVisible())) await this.pick();
      return this.page.locator('#picked').isVisible();
    });
    const off = (await this.controls()).filter((control) => control.off && control.usable);
    for (const { name } of off) await this.use(name);
    const isHidden = ({ name, usable }) => name.startsWith('#keys ') && !usable; // a second press of '?' closes the list of keys
    if ((await this.controls()).some(isHidden)) await this.use('#tools button[data-key="?"]');
  }

  /** Picks a mass, so that its controls are shown: that of a key, or one in the view. */
  async pick() {
    const key = (await this.controls()).find(({ name, usable }) => usable && name.startsWith('#keyboards '));
    if (key !== undefined) return this.use(key.name);
    const point = await this.page.evaluate((chance) => window.viz.project(Math.floor(chance * window.viz.lastFrame.matCount)), this.draw());
    const { width, height } = this.page.viewportSize();
    if (!(point?.x >= 0 && point.x < width && point.y >= 0 && point.y < height)) return; // it is outside of the view
    this.log.push('a click at a mass');
    await this.page.mouse.click(point.x, point.y);
  }
}

/** Three frames more are drawn, or come while the view is frozen. */
async function goesOn(page) {
  const name = (await viz(page, 'frozen')) ? 'framesReceived' : 'framesDrawn';
  const begin = await viz(page, name);
  await until(`${name} grows by 3`, async () => (await viz(page, name)) >= begin + 3);
}

const phaseOf = async (page) => (await viz(page, 'nodes')).find(({ kind }) => kind === 'sim_node')?.state;

const cases = {
  'space pauses the simulation and lets it go on, the right arrow does one step': async ({ page }) => {
    await page.keyboard.press(' ');
    await until('it is paused', async () => (await phaseOf(page)) === 'paused');
    const stepOf = async () => (await viz(page, 'nodes')).find(({ kind }) => kind === 'sim_node').step;
    const before = await stepOf();
    await page.keyboard.press('ArrowRight');
    await until('it has done one step', async () => (await stepOf()) === before + 1);
    await page.keyboard.press(' ');
    await until('it goes on', async () => (await phaseOf(page)) === 'running');
    await drawn(page, 3);
  },

  'the view goes on after every control and every scene': async (session) => {
    const { page } = session;
    const seed = Number(process.env.CORDIS_SEED ?? 20261129);
    console.log(`CORDIS_SEED=${seed}`);
    const draw = lot(seed);
    const html = await (await page.request.get(page.url())).text();
    const person = new Person(session, draw, [...html.matchAll(/ id="([^"]+)"/g)].map(([, id]) => id));
    let described = 0;
    let allIsShown = false;
    let left = await person.left();
    const isDone = () => described >= DESCRIPTIONS && left.usable.length + left.hidden.length === 0;
    for (let round = 1; round <= MAX_ROUNDS && !(isDone() && allIsShown); ++round) {
      const begin = Date.now();
      person.log = [];
      await pause(draw() * 80); // anywhere between two frames
      if (described >= DESCRIPTIONS && left.usable.length === 0) {
        await person.showAll();
        allIsShown = true;
        left = await person.left();
      }
      if (left.usable.length > 0) await person.use(person.of(left.usable));
      if (described++ < DESCRIPTIONS) {
        await person.describe();
        const again = [...person.used].filter((name) => name !== '#scenes');
        if (draw() < 0.5) await person.use(person.of(again));
      }
      if (left.hidden.some((name) => name.startsWith('#picked'))) await person.pick();
      try {
        await goesOn(page);
      } catch (error) {
        const seen = await page.evaluate(() => [window.viz.lastFrame, window.viz.scene, window.viz.errors]);
        throw new Error(`round ${round}, after ${person.log.join(', ')}: ${error.message}; ${JSON.stringify(seen)}`);
      }
      console.log(`  ${round}. ${person.log.join(', ')}: ${Date.now() - begin} ms`);
      left = await person.left();
    }
    assert.deepEqual([...left.usable, ...left.hidden], [], 'each control was used, or another test is named that does so');
    assert.deepEqual(Object.keys(ELSEWHERE).filter((name) => !person.known.has(name)), [], 'all of ELSEWHERE exist');
  },

  'nothing went wrong in the page': async ({ page, pageErrors }) => {
    assert.deepEqual([await viz(page, 'errors'), pageErrors], [[], []]);
  },
};

async function open() {
  const session = await Session.open();
  const words = ['run', LAUNCH, '--no-color', `domain=${session.domain}`, 'view.port=0'];
  session.launcher = session.start('cordis', program('cordis'), [...words, 'view.scenes=[scenes/membrane.yaml, scenes/hanging_chain.yaml]', 'view.parameters=true']);
  await openPage(session, await session.launcher.says(/(http:\/\/127\.0\.0\.1:\d+)/));
  await drawn(session.page, 3);
  return session;
}

await runCases(cases, open);
