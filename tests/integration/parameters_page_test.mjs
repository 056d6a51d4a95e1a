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
const numberOf = (page, name) => row(page, name).locator('input[type=number]');

const cases = {
  'every parameter of the scene has a slider and a number': async ({ page }) => {
    await drawn(page, 2);
    await page.click('#parameters-open');
    await until('the parameters are listed', async () => (await page.locator('#parameters-list li').count()) >= 2);
    assert.equal(await row(page, STIFFNESS).locator('label').textContent(), 'finger stiffness [N/m]');
    assert.equal(await numberOf(page, STIFFNESS).inputValue(), '80');
    assert.equal(await row(page, STIFFNESS).locator('input[type=range]').getAttribute('aria-label'), `${STIFFNESS}, slider`);
    await page.screenshot({ path: join(out, 'parameters.png') });
  },

  'a slider that is moved by a key sets its parameter, and shows what is set': async (session) => {
    const { page } = session;
    await row(page, STIFFNESS).locator('input[type=range]').focus();
    await page.keyboard.press('End'); // ten times the first value
    await until('sim_node has it', async () => (await reported(session, STIFFNESS)).endsWith(`${STIFFNESS} = 800`));
    await until('the page shows it', async () => (await numberOf(page, STIFFNESS).inputValue()) === '800');
  },

  'a number that is written sets its parameter; one that is refused says why, and the page shows what is': async (session) => {
    const { page } = session;
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

  'a scene that the launch file lists is loaded, with its own parameters': async (session) => {
    const { page } = session;
    const offered = await page.locator('#scenes option').allTextContents();
    assert.deepEqual(offered, ['Load …', 'membrane', 'hanging_chain']);
    await page.selectOption('#scenes', { label: 'hanging_chain' });
    await until('it is played', async () => (await viz(page, 'scene')).name === 'hanging_chain');
    await drawn(page, 2);
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
