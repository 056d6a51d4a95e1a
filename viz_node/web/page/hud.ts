// viz_node/web/page/hud.ts -- the figures that are always on screen, the state of every node, and
// the banner when something is amiss.
import { count, duration, joined, NONE, plain, rate, threeDigits, withUnit } from './format.ts';
import { countsLine, eventLine } from './events.ts';
import { VERSION, type Description, type Hello, type NodeState, type Reply, type Status } from './protocol.ts';
import { refusalOf } from './refusal.ts';
import { fillRows, setText } from './rows.ts';
import { timeScaleOf } from './slow_motion.ts';
import { takeIn, type Take } from './take.ts';

// After this time without a frame the view is called old, whatever the nodes say.
const OLD_AFTER_S = 1.5;
const FROZEN: [string, string, 'warn'] = ['view frozen', 'The simulation goes on. h lets the view go on too.', 'warn'];
const GONE = ['lost', 'stopped', 'failed'];

/** What the page itself measures. */
export interface Measured {
  connected: boolean;
  frozen: boolean; // a person froze the view
  simulatedS: number;
  realTimeFactor: number;
  lagS: number;
  dropped: number;
  sinceFrameS: number; // since the newest frame came
}

function element(id: string): HTMLElement {
  const found = document.getElementById(id);
  if (found === null) throw new Error(`the page has no element '${id}'`);
  return found;
}

function set(id: string, text: string, level: 'good' | 'warn' | 'bad' | '' = ''): void {
  const target = element(id);
  setText(target, text);
  target.dataset.level = level;
}

export class Hud {
  private status: Status | null = null;
  private take: Take | null = null; // null in a live session
  private description: Description | null = null;
  private session = ''; // its name
  private otherVersion = false; // of viz_node than of this page

  setHello({ session, protocol }: Hello): void {
    this.otherVersion = protocol !== VERSION;
    this.session = session;
    set('session', session);
    document.title = `${session} · Cordis`;
  }

  setDescription(description: Description | null): void {
    this.description = description;
    if (description === null) return;
    const mats = `${count(description.mat_count)} MATs`;
    // Most sessions have the name of their scene, and a narrow window has no room for it twice.
    set('scene', description.name === this.session ? mats : `${description.name} · ${mats}`);
    element('scene').title = `${description.scene_file}, ${count(description.link_count)} links`;
  }

  setStatus(status: Status): void {
    this.status = status;
    this.take = takeIn(status.nodes);
    this.writeNodes(status.nodes);
    this.writeEvents(status);
  }

  get nodes(): NodeState[] {
    return this.status?.nodes ?? [];
  }

  get replies(): Reply[] {
    return this.status?.replies ?? [];
  }

  /** Writes all figures again; a few times a second. */
  refresh(measured: Measured): void {
    const sim = this.alive('sim_node');
    this.writeLoop(sim);
    this.writeForceLoop();
    this.writeEnergy(sim);
    const fresh = measured.sinceFrameS < OLD_AFTER_S;
    set('time', Number.isFinite(measured.simulatedS) ? measured.simulatedS.toFixed(2) : NONE);
    set('time-more', Number.isFinite(measured.simulatedS) ? 's' : '');
    const factor = fresh && sim !== undefined ? measured.realTimeFactor : Number.NaN;
    set('factor', Number.isFinite(factor) ? `×${factor.toFixed(2)}` : NONE, factor < 0.98 * timeScaleOf(sim, this.description) ? 'warn' : '');
    // The frames of a take were taken by another clock.
    const lag = this.take !== null ? Number.NaN : fresh ? measured.lagS : measured.sinceFrameS;
    set('lag', Number.isFinite(lag) ? (1000 * lag).toFixed(0) : NONE, lag > 0.5 ? 'bad' : lag > 0.15 ? 'warn' : '');
    const viz = this.alive('viz_node');
    element('lag').title = viz !== undefined && viz.latency_count > 0
      ? `from the hand to the view, all pages: p50 ${joined(withUnit(viz.latency_p50_s, 's'))}, p99 ${joined(withUnit(viz.latency_p99_s, 's'))}, max ${joined(withUnit(viz.latency_max_s, 's'))}`
      : '';
    set('dropped', count(measured.dropped), '');
    const before = (this.status?.viz.lost ?? 0) + (this.status?.viz.refused ?? 0);
    element('dropped').title = `frames not sent to this page because it was busy; ${count(before)} more never came to it or did not fit`;
    this.writeBanner(measured);
  }

  /** The node of this kind that was heard lately. */
  alive(kind: string): NodeState | undefined {
    return this.nodes.find((node) => node.kind === kind && !GONE.includes(node.state));
  }

  /** What the buttons command: the player of a take, or else the simulation. */
  get commanded(): NodeState | undefined {
    return this.take === null ? this.alive('sim_node') : this.nodes.find(({ kind }) => kind === 'player');
  }

  private writeLoop(sim: NodeState | undefined): void {
    set('loop', rate(sim?.reached_rate_hz));
    if (sim === undefined) {
      for (const id of ['loop-more', 'overruns', 'overruns-more']) set(id, id === 'overruns' ? NONE : '');
      return;
    }
    const target = sim.target_rate_hz ?? 0;
    // A rate over half a second is one tick more or less: 2 Hz.
    const missing = target - (sim.reached_rate_hz ?? 0);
    const short = target > 0 && sim.state !== 'paused' && missing > Math.max(0.02 * target, 2);
    set('loop', rate(sim.reached_rate_hz), short ? 'warn' : '');
    set('loop-more', target > 0 ? `/ ${plainRate(target)} Hz` : 'Hz, no target');
    const share = sim.ticks > 0 ? sim.overruns / sim.ticks : 0;
    set('overruns', count(sim.overruns), share > 0.001 ? 'warn' : '');
    set('overruns-more', `${(100 * share).toFixed(3)} %`);
  }

  private writeForceLoop(): void {
    const devices = this.nodes.filter((n) => n.kind === 'device_node' && !GONE.includes(n.state) && n.latency_count > 0);
    // The slowest of several devices is shown.
    const worst = devices.sort((a, b) => (b.latency_p99_s ?? 0) - (a.latency_p99_s ?? 0))[0];
    set('latency', worst ? joined(withUnit(worst.latency_p50_s, 's')) : NONE);
    set('latency-p99', worst ? joined(withUnit(worst.latency_p99_s, 's')) : NONE);
    set('latency-max', worst ? joined(withUnit(worst.latency_max_s, 's')) : NONE);
    set('latency-device', worst ? `· ${worst.name}` : '');
    element('latency').title = devices.map(linkLine).join('\n');
  }

  private writeEnergy(sim: NodeState | undefined): void {
    set('energy', joined(withUnit(sim?.energy_j, 'J')));
    const drift = sim?.energy_drift;
    set('energy-more', typeof drift === 'number' ? `drift ${plain(drift)}, error ${joined(withUnit(sim?.integration_error_j, 'J'))}` : '');
    element('energy').title = element('energy-more').textContent ?? ''; // a narrow window has no room for it
    element('account').hidden = sim === undefined;
    set('by-ports', joined(withUnit(sim?.port_work_j, 'J')));
    set('by-switching', joined(withUnit(sim?.switching_energy_j, 'J')));
    set('by-viscosity', joined(withUnit(sim?.dissipated_j, 'J')));
    const limit = sim?.largest_stability_number;
    // As the table at the end of `cordis run`.
    const bounded = typeof limit === 'number' && limit > 1e6 ? 'not bounded' : undefined;
    set('limit', typeof limit === 'number' ? (bounded ?? `${threeDigits(limit)} of 4`) : NONE, typeof limit === 'number' && limit >= 4 ? 'warn' : '');
    const partners = sim?.largest_partners ?? 0;
    const certified = sim?.certified_partners ?? null;
    set('partners', certified !== null ? `${partners} of ${certified}` : NONE, certified !== null && partners > certified ? 'warn' : '');
    const troubles: [number, string][] = [
      [sim?.overflowed_steps ?? 0, 'steps with pairs beyond room'],
      [sim?.forgotten_pairs ?? 0, 'pairs forgotten'],
      [sim?.refused_inputs ?? 0, 'inputs refused'],
    ];
    const shown = troubles.filter(([times]) => times > 0).map(([times, what]) => `${count(times)} ${what}`);
    element('troubles').hidden = shown.length === 0;
    set('troubles', shown.join(', '), 'warn');
  }

  private writeNodes(nodes: NodeState[]): void {
    const order = ['sim_node', 'device_node', 'viz_node'];
    const sorted = [...nodes].sort((a, b) => order.indexOf(a.kind) - order.indexOf(b.kind) || a.name.localeCompare(b.name));
    fillRows(element('nodes'), sorted, makeRow, writeRow);
    element('nodes').dataset.old = '';
  }

  private writeEvents(status: Status): void {
    const { total, lost, newest } = status.events;
    const sim = this.alive('sim_node');
    const all = sim?.changes.reduce((sum, { changes }) => sum + changes, 0) ?? 0;
    const unseen = lost + (sim?.lost_events ?? 0) > 0 ? `, ${count(Math.max(lost, sim?.lost_events ?? 0))} lost` : '';
    element('events').hidden = total === 0 && all === 0;
    set('events-total', count(Math.max(total, all)) + unseen);
    set('events-counts', countsLine(sim?.changes ?? []));
    const makeLine = () => document.createElement('li');
    fillRows(element('events-list'), [...newest].reverse(), makeLine, (line, event) => {
      line.title = eventLine(event, this.description);
      setText(line, line.title);
    });
  }

  private writeBanner(measured: Measured): void {
    const [title, text, level] = this.alarm(measured);
    // Without viz_node the rows are old.
    if (!measured.connected) element('nodes').dataset.old = 'yes';
    element('banner').hidden = title === '';
    element('stage').classList.toggle('stale', level === 'bad');
    set('banner-title', title);
    set('banner-text', text);
    element('banner').dataset.level = level;
  }

  /** The one thing that a person should know first: [title, what it means, level]. */
  private alarm(measured: Measured): [string, string, 'bad' | 'warn' | ''] {
    if (!measured.connected) return ['viz_node is gone', 'The session may be running all the same; what stands here is old. Trying again …', 'bad'];
    if (this.otherVersion) return ['reload this page', 'It is older or newer than the viz_node that it shows.', 'bad'];
    if (this.take?.state === 'paused') return ['take paused', 'Space lets it go on; the bar moves it.', 'warn'];
    if (this.take?.state === 'over') return ['end of the take', 'The bar moves it.', 'warn'];
    if (this.take !== null && this.description !== null) return measured.frozen ? FROZEN : ['', '', ''];
    const sims = this.nodes.filter((node) => node.kind === 'sim_node');
    if (!sims.some((node) => !GONE.includes(node.state))) {
      const last = sims.sort((a, b) => a.received_s - b.received_s)[0];
      return ['waiting for sim_node', last ? fate(last) : 'No simulation has been heard in this session yet.', 'bad'];
    }
    if (this.description === null) return ['waiting for the scene', 'sim_node has not described its scene yet.', 'warn'];
    if (!(measured.sinceFrameS < OLD_AFTER_S)) {
      const since = Number.isFinite(measured.sinceFrameS) ? `for ${duration(measured.sinceFrameS)}` : 'yet';
      return ['no frames', `sim_node is there, but no frame has come ${since}.`, 'bad'];
    }
    const refusal = refusalOf(this.alive('sim_node'));
    if (refusal !== null) return [...refusal, 'warn'];
    const amiss = this.nodes.filter((node) => node.state === 'lost' || node.state === 'failed');
    if (amiss.length > 0) {
      const device = amiss.some((node) => node.kind === 'device_node');
      return [amiss.map((n) => `${n.name} is ${n.state}`).join(', '), amiss.map(fate).join(' ') + (device ? ' Its forces are zero meanwhile.' : ''), 'warn'];
    }
    if (this.alive('sim_node')?.state === 'paused') return ['paused', 'The scene is paused, and the devices are let go of. Space lets it go on.', 'warn'];
    if (measured.frozen) return FROZEN;
    return ['', '', ''];
  }
}

/** A target rate: without decimals when it has none. */
function plainRate(value: number): string {
  return Number.isInteger(value) ? String(value) : rate(value);
}

function fate(node: NodeState): string {
  const since = `${duration(node.received_s)} ago`;
  const reason = node.text !== '' ? `: ${node.text}` : '';
  if (node.state === 'lost') return `${node.name} was last heard ${since}.`;
  return `${node.name} ${node.state} ${since}${reason}.`;
}

const CELLS = ['name', 'state', 'rate', 'lost', 'memory'];

function makeRow(): HTMLElement {
  const row = document.createElement('tr');
  for (const kind of CELLS) row.append(Object.assign(document.createElement('td'), { className: kind }));
  row.querySelector<HTMLElement>('.lost')!.title = 'messages lost, late or refused since it began';
  return row;
}

/** What a row says of losses: of a device the share of samples without an answer, else messages. */
function lossOf(node: NodeState): string {
  const share = node.link_samples > 0 ? (100 * node.link_unanswered) / node.link_samples : 0;
  if (share >= 0.05) return `${share.toFixed(1)} % lost`;
  return node.dropped > 0 ? `${count(node.dropped)} lost` : '';
}

/** The link between a device and the scene: round trip and loss. */
export function linkLine(node: NodeState): string {
  if (node.link_samples === 0) return '';
  const lost = (100 * node.link_unanswered) / node.link_samples;
  return `${node.name}: round trip ${joined(withUnit(node.latency_p50_s, 's'))}, ${lost.toFixed(2)} % of ${count(node.link_samples)} samples without an answer`;
}

function writeRow(row: HTMLElement, node: NodeState): void {
  const device = `${joined(withUnit(node.port_energy_j, 'J'))} given to the hand, ${count(node.passivity_ticks)} passivity ticks`;
  row.dataset.state = node.state;
  const parts = node.kind === 'device_node' ? [node.text, device, linkLine(node)] : [node.text];
  row.title = [...parts, `on ${node.host}`].filter((part) => part !== '').join('; ');
  const texts = [
    node.name,
    node.state,
    GONE.includes(node.state) ? NONE : rate(node.reached_rate_hz) + ' Hz',
    lossOf(node),
    joined(withUnit(node.memory_bytes, 'B')),
  ];
  texts.forEach((text, i) => setText(row.children[i]!, text));
}
