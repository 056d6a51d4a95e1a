// tests/campaigns/page_stalls_test.mjs -- each node of a realtime session, with launcher and page,
// stalls once for a long time; the same processes and the view in Chromium go on afterwards.
//
// CORDIS_STALL_S seconds each (3), CORDIS_STALL_SESSIONS sessions one after the other (1).
import assert from 'node:assert/strict';
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { banner, drawn, openPage, viz } from '../viz/browser.mjs';
import { pause, program, runCases, Session, source, until } from '../viz/session.mjs';

const STALL_S = Number(process.env.CORDIS_STALL_S ?? 3);
const SESSIONS = Number(process.env.CORDIS_STALL_SESSIONS ?? 1);
const LAUNCH = join(source, 'launch_configs/plucked_string.yaml');
const NODES = ['sim', 'keyboard', 'view'];

/** The process that the launcher started with `--name NAME`; undefined when none runs. */
function processOf(launcher, name) {
  const tasks = readdirSync(`/proc/${launcher}/task`);
  const children = tasks.flatMap((task) => readFileSync(`/proc/${launcher}/task/${task}/children`, 'utf8').split(' ').filter(Boolean));
  return children.map(Number).find((id) => {
    try {
      return readFileSync(`/proc/${id}/cmdline`, 'utf8').includes(`\0--name\0${name}\0`);
    } catch {
      return false; // it has ended meanwhile
    }
  });
}

/** Waits until the page draws, every node runs, and the scene and the device have done more than before. */
async function goesOn(page) {
  const before = (await until('the page has a frame', () => viz(page, 'lastFrame'))).step;
  await drawn(page, 5);
  await banner(page, '');
  await until('every node runs', async () => {
    const running = (await viz(page, 'nodes')).filter(({ state }) => state === 'running').map(({ name }) => name);
    return NODES.every((name) => running.includes(name));
  });
  await until('the scene goes on', async () => (await viz(page, 'lastFrame')).step > before + 100);
}

const stall = (name) => async ({ page, launcher }) => {
  const id = await until(`${name} runs`, () => processOf(launcher.id, name));
  process.kill(id, 'SIGSTOP');
  await pause(STALL_S * 1000);
  process.kill(id, 'SIGCONT');
  const begin = Date.now();
  await goesOn(page);
  console.log(`  ${name}: the view goes on after ${Date.now() - begin} ms`);
  assert.equal(processOf(launcher.id, name), id, `${name} is the same process`);
};

async function start(session) {
  const words = ['run', LAUNCH, '--no-color', `domain=${session.domain}`, 'view.port=0'];
  session.launcher = session.start('cordis', program('cordis'), words);
  session.url = await session.launcher.says(/(http:\/\/127\.0\.0\.1:\d+)/);
}

const cases = {};
for (let i = 1; i <= SESSIONS; ++i) {
  const order = NODES.map((_, offset) => NODES[(offset + i) % NODES.length]);
  for (const name of order) cases[`${i}: the view goes on after a stall of ${name}`] = stall(name);
  cases[`${i}: nothing went wrong in the page, and Ctrl-C ends the session`] = async (session) => {
    const { page, pageErrors } = session;
    assert.deepEqual([await viz(page, 'errors'), pageErrors], [[], []]);
    assert.equal(await session.launcher.end('SIGINT'), 0);
    if (i === SESSIONS) return;
    await start(session);
    await page.goto(session.url);
    await goesOn(page);
  };
}

async function open() {
  const session = await Session.open();
  await start(session);
  await openPage(session, session.url);
  await goesOn(session.page);
  return session;
}

await runCases(cases, open, 570_000 + SESSIONS * NODES.length * (STALL_S + 60) * 1000);
