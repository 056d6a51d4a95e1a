// tests/integration/parameters_page_test.mjs -- parameters are set and scenes loaded on the page.
// With real sim_node, device_node, viz_node and Chromium.
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { drawn, openPage, replied, textOf, viz } from '../viz/browser.mjs';
import { out, program, runCases, Session, source, until } from '../viz/session.mjs';

const LAUNCH = join(source, 'launch_configs/plucked_string.yaml');
const STIFFNESS = 'finger.stiffness_n_per_m';

/** What sim_node says of parameters. */
async function reported(session, name) {
  const ctl = session.start('ctl', program('cordis'), ['ctl', LAUNCH, 'get', name, '--domain', session.domain]);
  assert.equal(await ctl.ended, 0);
  return ctl.log.trim();
}

const row = (page, name) => page.locator(`#parameters-list li[data-parameter="${name}"]`);
const targetRate = async (page) => (await viz(page, 'nodes')).find(({ kind }) => kind === 'sim_node').target_rate_hz;
const numberOf = (page, name) => row(page, name).locator('input[type=number]');

/** Opens the list of parameters, unless it is open: a page that was loaded again has it closed. */
async function openList(page) {
  if (!(await page.locator('#parameters-list').isVisible())) await page.click('#parameters-open');
  await until('the parameters are listed', async () => (await page.locator('#parameters-list li').count()) >= 2);
}

const cases = {
  'every parameter of the scene has a slider and a number': async ({ page }) => {
    await drawn(page, 2);
    await openList(page);
    assert.equal(await row(page, STIFFNESS).locator('label').textContent(), 'finger stiffness [N/m]');
    assert.equal(await numberOf(page, STIFFNESS).inputValue(), '80');
    assert.equal(await row(page, STIFFNESS).locator('input[type=range]').getAttribute('aria-label'), `${STIFFNESS}, slider`);
    await page.screenshot({ path: join(out, 'parameters.png') });
  },

  'a slider that is moved by a key sets its parameter, and shows what is set': async (session) => {
    const { page } = session;
    await openList(page);
    await row(page, STIFFNESS).locator('input[type=range]').focus();
    // A tenth of the first value. The keyboard supports it before its answers are measured, and on a busy machine.
    await page.keyboard.press('Home');
    await until('sim_node has it', async () => (await reported(session, STIFFNESS)).endsWith(`${STIFFNESS} = 8`));
    await until('the page shows it', async () => (await numberOf(page, STIFFNESS).inputValue()) === '8');
  },

  'a number that is written sets its parameter; one that is refused says why, and the page shows what is': async (session) => {
    const { page } = session;
    await openList(page);
    await numberOf(page, STIFFNESS).fill('120');
    await page.keyboard.press('Enter');
    await until('sim_node has it', async () => (await reported(session, STIFFNESS)).endsWith(`${STIFFNESS} = 120`));
    await numberOf(page, STIFFNESS).fill('-3');
    await page.keyboard.press('Tab');
    await replied(page, /stiffness/);
    await until('the refusal is shown', async () => /stiffness/.test(await textOf(page, '#reply')) && (await page.locator('#reply').getAttribute('data-level')) === 'bad');
    await until('the page shows what is', async () => (await numberOf(page, STIFFNESS).inputValue()) === '120');
    assert.match(await reported(session, STIFFNESS), / = 120$/);
  },

  'gravity has a slider that goes from one direction to the other': async (session) => {
    const { page } = session;
    const name = 'world.gravity_y_m_per_s2';
    await openList(page);
    assert.equal(await row(page, name).locator('label').textContent(), 'world gravity y [m/s²]');
    assert.equal(await numberOf(page, name).inputValue(), '0');
    await row(page, name).locator('input[type=range]').focus();
    await page.keyboard.press('Home');
    await until('sim_node has it', async () => (await reported(session, name)).endsWith(`${name} = -20`));
    await numberOf(page, name).fill('0');
    await page.keyboard.press('Enter');
    await until('it is off again', async () => (await reported(session, name)).endsWith(`${name} = 0`));
  },

  'slow motion: a slider and two keys slow the simulation, and the simulated devices follow': async ({ page }) => {
    await until('the slider is there', () => page.locator('#slow').isVisible());
    assert.equal(await textOf(page, '#slow-text'), '×1');
    await page.locator('#slow-scale').focus();
    await page.keyboard.press('Home');
    await until('the simulation is slow', async () => Math.abs((await targetRate(page)) - 10) < 1e-6);
    await until('so is the keyboard', async () => (await viz(page, 'nodes')).some(({ name, target_rate_hz: rate }) => name === 'keyboard' && Math.abs(rate - 10) < 1e-6));
    assert.equal(await textOf(page, '#slow-text'), '×0.01');
    await page.keyboard.press(']');
    await page.keyboard.press(']');
    await until('it is faster', async () => Math.abs((await targetRate(page)) - 100) < 1e-6);
    await until('real time says so', async () => /^×0\.(0[5-9]|1[0-5])$/.test(await textOf(page, '#factor')));
    assert.equal(await textOf(page, '#slow-text'), '×0.1');
    await replied(page, /plays 0\.1 times as fast as in real time/);
    await page.screenshot({ path: join(out, 'slow_motion.png') });
  },

  'a scene that the launch file lists is loaded, with its own parameters, in real time': async (session) => {
    const { page } = session;
    assert.ok(Math.abs((await targetRate(page)) - 100) < 1e-6, 'it is slow still');
    const offered = await page.locator('#scenes option').allTextContents();
    assert.deepEqual(offered, ['Load …', 'membrane', 'hanging_chain']);
    await page.selectOption('#scenes', { label: 'hanging_chain' });
    await until('it is played', async () => (await viz(page, 'scene')).name === 'hanging_chain');
    await drawn(page, 2);
    await until('it plays in real time', async () => (await targetRate(page)) === 1000 && (await textOf(page, '#slow-text')) === '×1');
    await until('the parameters are others', async () => (await row(page, STIFFNESS).count()) === 0);
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
  return session;
}

await runCases(cases, open);
