// viz_node/web/page/page.ts -- the page: takes messages, draws the newest frame, and says so.
import { Bodies } from './bodies.ts';
import { ClockOffset, RealTimeFactor } from './clock.ts';
import type { Pose } from './camera_rig.ts';
import { firstTheme, keepTheme, paletteOf, type Palette, type ThemeName } from './colours.ts';
import { ColouringBox, forceScale, speedScale, stretchScale, type Scale } from './colouring.ts';
import { Connection } from './connection.ts';
import { Controls } from './controls.ts';
import { count, joined, roundLength, withUnit } from './format.ts';
import { Hud } from './hud.ts';
import { drawKeys } from './key_marks.ts';
import { KeyboardPanel } from './keyboards.ts';
import { keysAreListed, toggleKeys } from './keys_dialog.ts';
import { legendOf, showLegend, type LegendEntry } from './legend.ts';
import { BondGroups, LinkGroups } from './link_groups.ts';
import { Marks } from './marks.ts';
import { MotionBox } from './motion_box.ts';
import { drawNames } from './names.ts';
import { ParameterPanel } from './parameters.ts';
import { Picked } from './picked.ts';
import { download } from './plot_export.ts';
import { PointerHand } from './pointer.ts';
import { PortArrows } from './port_arrows.ts';
import { toolsOf, type Description, type Frame, type Message, type Topology } from './protocol.ts';
import { chooseQuality, findRenderer } from './quality.ts';
import { setText } from './rows.ts';
import { SceneView } from './scene_view.ts';
import { SlowMotion } from './slow_motion.ts';
import { SignalPanel } from './signal_panel.ts';
import type { SignalStore } from './signal_store.ts';
import { SoundPanel } from './sound/sound_panel.ts';
import { TakeBar } from './take.ts';
import { imageOfView } from './view_image.ts';

const FIGURES_PERIOD_MS = 200;
const PLOTS_PERIOD_MS = 100;
const MAX_ERRORS = 20;
const CONTEXT_LOST = 'The browser stopped drawing: its graphics driver failed. Reload the page if the view does not come back';

function find<T extends HTMLElement>(selector: string): T {
  const found = document.querySelector<T>(selector);
  if (found === null) throw new Error(`the page has no ${selector}`);
  return found;
}

/** Words for colours of the scene that the page did not get; empty where it has all. */
function leftOut({ colours, colours_left_out: more = 0 }: Description): string {
  return more === 0 ? '' : `The view shows the first ${count(colours.length)} coloured parts of the scene; ${count(more)} more have the colours of their bodies`;
}

/** What has the focus needs the key itself. */
function takesKey(target: EventTarget | null, key: string): boolean {
  const isBox = target instanceof HTMLInputElement && target.type === 'checkbox';
  if (isBox || target instanceof HTMLButtonElement) return key === ' ';
  return target instanceof HTMLInputElement || target instanceof HTMLSelectElement;
}

export class Page {
  readonly hud = new Hud();
  readonly errors: string[] = [];
  description: Description | null = null;
  view: SceneView | null = null;
  store: SignalStore | null = null;
  framesReceived = 0;
  framesDrawn = 0;
  lastFrame: Frame | null = null; // drawn
  dropped = 0;
  lagS = Number.NaN;
  frozen = false;

  private readonly stage = find('#stage');
  private readonly ruler = find('#ruler');
  private rulerWidth = ''; // of its line
  private readonly marks = new Marks(this.stage);
  private readonly plots = new SignalPanel((ending) => this.fileName(ending), () => this.picked?.showPlotted());
  private readonly clock = new ClockOffset();
  private readonly factor = new RealTimeFactor();
  private readonly renderer = findRenderer();
  readonly connection: Connection;
  private readonly controls: Controls;
  private readonly slowMotion: SlowMotion;
  private readonly parameters: ParameterPanel;
  readonly sound: SoundPanel;
  readonly takeBar: TakeBar;
  readonly pointer: PointerHand;
  readonly picked: Picked;
  readonly keyboards: KeyboardPanel;
  theme = firstTheme();
  private pending: Frame | null = null;
  private pendingIsLate = false; // it came, or waited, while the page was hidden
  private frameMs = Number.NaN; // when the newest frame came
  private pose: Pose | null = null; // of the camera, for the next view
  private drawAsked = false;
  private readonly colouring = new ColouringBox(() => this.colour());
  private legendVersion = ''; // of what the legend says of a frame
  private readonly motion = new MotionBox(() => this.exaggerate());
  private names = false;
  private arrows = false; // of the forces on ports
  private readonly portArrows = new PortArrows();
  private maySet = false; // the launch file lets pages set parameters
  private trails = false;
  private plotsMs = 0;
  private plotsDirty = false;

  constructor() {
    window.addEventListener('error', (event) => this.note(event.error ?? event.message));
    window.addEventListener('unhandledrejection', (event) => this.note(event.reason));
    if (this.renderer === null) this.say('This browser has no WebGL 2: figures and signals only');
    new ResizeObserver(() => this.resize()).observe(this.stage);
    this.resize();
    document.addEventListener('visibilitychange', () => {
      if (document.hidden) this.pendingIsLate = true;
      else this.askToDraw();
    });
    this.listenToKeys();
    this.connection = new Connection(`ws${location.protocol.slice(4)}//${location.host}/live${location.search}`, {
      message: (message) => this.take(message),
      opened: () => this.sound.reopen(),
      closed: () => this.forgetConnection(),
      failed: (error) => this.note(error),
    });
    this.controls = new Controls(this.connection);
    this.slowMotion = new SlowMotion((verb, more) => this.controls.command(verb, more));
    this.parameters = new ParameterPanel((verb, more, isShown) => (isShown ? this.controls.command(verb, more) : this.connection.command(verb, more)));
    this.sound = new SoundPanel(this.connection, (error) => this.note(error));
    this.takeBar = new TakeBar(this.connection);
    this.pointer = new PointerHand(this.stage, this.connection, () => this.view, () => this.askToDraw());
    this.picked = new Picked(this.stage, () => this.view, this.plots.traces, () => this.askToDraw());
    this.keyboards = new KeyboardPanel((mat) => this.picked.pick({ mat }));
    this.applyTheme();
    window.setInterval(() => this.refresh(), FIGURES_PERIOD_MS);
  }

  get sinceFrameS(): number {
    return (performance.now() - this.frameMs) / 1000;
  }

  note(error: unknown): void {
    console.error(error);
    this.errors.push(String(error));
    if (this.errors.length > MAX_ERRORS) this.errors.shift();
  }

  private take(message: Message): void {
    switch (message.type) {
      case 'hello':
        this.connection.mayCommand = message.may_command;
        this.controls.list(message.scenes ?? []); // a viz_node of another version may list none
        this.maySet = message.parameters;
        return this.hud.setHello(message);
      case 'description':
        return this.describe(message);
      case 'topology':
        return this.build(message);
      case 'status':
        this.clock.note(message.sent_nsec, performance.now());
        this.hud.setStatus(message);
        this.takeBar.update(message.nodes);
        if (this.description !== null && this.keyboards.describe(this.description, message.devices)) this.showLegend();
        this.parameters.update(this.maySet && this.connection.mayCommand && this.hud.commanded?.kind === 'sim_node', message.replies);
        this.slowMotion.update(this.hud.commanded, this.description, message.devices, this.connection.mayCommand);
        return this.controls.update(this.hud.commanded, message.replies);
      case 'signals':
        if (message.scene !== this.description?.scene) return;
        this.store?.append(message);
        this.plotsDirty = true;
        return this.askToDraw();
      case 'sound':
        return message.scene === this.description?.scene ? this.sound.take(message) : undefined;
      case 'pointer':
        return this.pointer.take(message);
      case 'frame':
        return this.takeFrame(message);
    }
  }

  private takeFrame(frame: Frame): void {
    const now = performance.now();
    this.clock.note(frame.sentNsec, now);
    ++this.framesReceived;
    this.frameMs = now;
    this.dropped = frame.dropped;
    if (frame.scene !== this.description?.scene) return this.connection.acknowledge();
    this.factor.note(frame.takenNsec, frame.simulatedS);
    this.pending = frame;
    this.pendingIsLate = document.hidden;
    this.askToDraw();
  }

  /** A scene that is described again, by a viz_node that was restarted, goes on where it was. */
  private describe(description: Description): void {
    const last = this.description;
    const isSame = last !== null && last.epoch === description.epoch && last.version === description.version;
    const looksAlike = last !== null && last.name === description.name && last.space === description.space;
    description.tools = toolsOf(description);
    this.description = description;
    this.pointer.describe(description, isSame);
    this.pending = null;
    this.connection.acknowledge(); // frames of the last scene are not drawn any more
    this.factor.clear();
    this.hud.setDescription(description);
    this.sound.describe(description);
    if (isSame) return;
    this.keyboards.describe(description, []); // until the devices are known
    this.parameters.describe();
    this.picked.pick(null);
    this.pose = looksAlike && this.view !== null ? this.view.rig.pose : null;
    this.view?.dispose();
    this.view = null;
    this.store = this.plots.describe(description);
  }

  private build(topology: Topology): void {
    if (topology.scene !== this.description?.scene || this.view !== null || this.renderer === null) return;
    const size = Math.max(topology.matCount, topology.linkCount / 2);
    const quality = chooseQuality(this.renderer.software, size, window.devicePixelRatio);
    const note = [quality.note, leftOut(this.description)].filter((text) => text !== '').join('. ');
    this.say(note);
    const { space, surfaces } = this.description;
    const tools = this.description.tools.filter((tool) => tool !== null);
    const portMats = this.description.ports.map(({ mat }) => mat);
    const changed = () => this.askToDraw();
    const lost = (isLost: boolean) => this.say(isLost ? CONTEXT_LOST : note);
    try {
      const bodies = new Bodies(this.description, topology);
      const groups = new LinkGroups(this.description, topology);
      this.view = new SceneView(this.stage, topology, bodies, groups, new BondGroups(this.description), tools, portMats, space, surfaces, this.palette, quality, this.pose, changed, lost);
      this.colouring.describe(topology.linkCount, this.view.hasFreeMasses);
      this.colour();
      this.exaggerate();
      this.view.showTrails(this.trails);
    } catch (error) {
      this.note(error);
      this.say('The browser gives this page no WebGL: figures and signals only. Close other tabs and reload the page');
    }
  }

  private forgetConnection(): void {
    this.pending = null;
    this.pointer.forget();
    this.clock.clear();
    this.factor.clear();
    this.refresh();
  }

  private say(text: string): void {
    const notice = document.getElementById('notice') ?? find('#foot').insertAdjacentElement('afterbegin', document.createElement('p'))!;
    notice.id = 'notice';
    notice.textContent = text;
  }

  askToDraw(): void {
    if (this.drawAsked) return;
    this.drawAsked = true;
    requestAnimationFrame(() => {
      this.drawAsked = false;
      this.draw();
    });
  }

  private draw(): void {
    const frame = this.pending;
    this.pending = null;
    try {
      if (frame !== null && this.view !== null && !this.frozen) this.view.show(frame);
      this.view?.draw();
      if (this.view !== null && this.lastFrame !== null) this.keyboards.draw(this.view);
      this.drawMarks();
    } catch (error) {
      this.note(error);
    }
    if (frame === null) this.connection.acknowledge();
    else this.finish(frame);
    this.drawPlots();
    this.drawRuler();
  }

  private finish(frame: Frame): void {
    const drawn = this.view !== null && !this.frozen && !this.pendingIsLate;
    this.connection.acknowledge(drawn ? frame.sequence : 0);
    if (this.view === null || this.frozen) return;
    ++this.framesDrawn;
    this.lastFrame = frame;
    this.pendingIsLate = false;
    this.plots.traces.append(frame.simulatedS);
    this.plotsDirty = true;
    const lagS = Math.max(0, this.clock.serverMs(performance.now()) * 1e-3 - frame.takenNsec * 1e-9);
    // Smoothed so that it can be read; a view that falls behind shows within a second.
    this.lagS = Number.isNaN(this.lagS) || !drawn ? lagS : this.lagS + 0.1 * (lagS - this.lagS);
  }

  private drawPlots(): void {
    const now = performance.now();
    if (!this.plotsDirty || this.frozen || now - this.plotsMs < PLOTS_PERIOD_MS) return;
    this.plotsMs = now;
    this.plotsDirty = false;
    this.plots.draw();
    this.colouring.show(this.scale);
  }

  /** A length to measure by; in perspective it holds at the middle of the scene. */
  private drawRuler(): void {
    if (this.view === null || this.lastFrame === null) return;
    const scale = this.view.rig.metresPerPixel;
    const length = roundLength(160 * scale);
    const ruler = this.ruler;
    const width = `${length / scale}px`;
    if (this.rulerWidth !== width) (ruler.firstElementChild as HTMLElement).style.width = this.rulerWidth = width;
    setText(ruler.lastElementChild!, joined(withUnit(length, 'm')).replace(/\.0+(?=\D)/, ''));
    this.motion.say(this.motion.textSince(this.view.countedSinceS));
    const version = `${this.view.links?.componentsVersion ?? 0} ${this.view.bonds.isCut}`;
    if (version !== this.legendVersion) this.showLegend();
    this.legendVersion = version;
  }

  private refresh(): void {
    const line = this.pointer.line;
    find('#hand').hidden = line === '';
    setText(find('#hand'), line);
    this.hud.refresh({
      connected: this.connection.isOpen,
      frozen: this.frozen,
      simulatedS: this.lastFrame?.simulatedS ?? Number.NaN,
      realTimeFactor: this.factor.value,
      lagS: this.lagS,
      dropped: this.dropped,
      sinceFrameS: this.sinceFrameS,
    });
  }

  private listenToKeys(): void {
    const keys: Record<string, () => void> = {
      f: () => this.view?.fit(),
      '1': () => this.view?.rig.look('front'),
      '2': () => this.view?.rig.look('side'),
      '3': () => this.view?.rig.look('top'),
      '4': () => this.view?.rig.look('free'),
      o: () => this.view?.rig.toggleProjection(),
      g: () => this.view?.toggleGround(),
      c: () => this.colouring.step(),
      m: () => this.motion.step(),
      r: () => this.view?.measureFromNow(),
      t: () => this.showTrails(!this.trails),
      a: () => this.toggle('a', (this.arrows = !this.arrows)),
      n: () => this.toggle('n', (this.names = !this.names)),
      h: () => this.freeze(!this.frozen),
      p: () => this.plots.togglePhase(),
      '+': () => this.plots.stretch(0.5),
      '-': () => this.plots.stretch(2),
      l: () => this.setTheme(this.theme === 'dark' ? 'light' : 'dark'),
      u: () => this.toggleFullScreen(),
      '?': () => toggleKeys(),
      ' ': () => this.controls.press('pause'),
      ArrowRight: () => this.controls.press('step'),
      s: () => void this.saveImage(),
    };
    window.addEventListener('keydown', (event) => {
      if (event.ctrlKey || event.altKey || event.metaKey) return;
      if (takesKey(event.target, event.key)) return;
      if (keysAreListed() && event.key !== '?') return;
      if (this.takeBar.key(event.key) || this.slowMotion.key(event.key)) return event.preventDefault();
      const action = keys[event.key];
      if (action === undefined) return;
      event.preventDefault();
      action();
    });
    for (const button of document.querySelectorAll<HTMLButtonElement>('#tools button')) {
      button.addEventListener('click', () => {
        keys[button.dataset.key!]!();
        button.blur();
      });
    }
  }

  private exaggerate(): void {
    this.view?.exaggerate(this.motion.factor);
    this.motion.say(this.motion.textSince(this.view?.countedSinceS ?? 0));
  }

  private showTrails(wanted: boolean): void {
    this.trails = wanted;
    this.view?.showTrails(wanted);
    this.toggle('t', wanted);
  }

  private colour(): void {
    this.view?.colourBy(this.colouring.value);
    this.colouring.show(this.scale);
    this.showLegend();
  }

  /** What the colours mean, where they are numbers. */
  private get scale(): Scale | null {
    const { view, palette } = this;
    if (view === null) return null;
    if (this.colouring.value === 'speed') return speedScale(view.fastestSpeed, palette);
    if (this.colouring.value === 'force') return forceScale(view.strongestForce, view.forceSpanS, palette);
    if (this.colouring.value === 'stretch') return stretchScale(view.links?.widest ?? 0, view.countedSinceS, palette);
    return null;
  }

  /** Shows whether a button of the view is on. */
  private toggle(key: string, on: boolean): void {
    const button = find(`#tools button[data-key="${key}"]`);
    button.classList.toggle('on', on);
    button.setAttribute('aria-pressed', String(on));
    this.askToDraw();
  }

  private toggleFullScreen(): void {
    const asked = document.fullscreenElement ? document.exitFullscreen() : document.documentElement.requestFullscreen();
    asked.catch(() => this.say('This browser gives the page no full screen'));
  }

  private get palette(): Palette {
    return paletteOf(this.theme);
  }

  private setTheme(theme: ThemeName): void {
    this.theme = theme;
    keepTheme(theme);
    this.applyTheme();
  }

  private applyTheme(): void {
    document.documentElement.dataset.theme = this.theme;
    find('#tools button[data-key="l"]').textContent = this.theme === 'dark' ? 'Light' : 'Dark';
    this.marks.halo = this.palette.background;
    this.view?.paint(this.palette);
    this.plots.paint(this.palette);
    this.showLegend();
    this.plotsDirty = true;
    this.askToDraw();
  }

  private get legend(): LegendEntry[] {
    if (this.description === null || this.view === null) return [];
    return legendOf(this.description, this.view, this.keyboards.playsPorts, this.colouring.value, this.palette);
  }

  private showLegend(): void {
    if (this.description !== null && this.view !== null) showLegend(this.legend);
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.stage;
    this.marks.resize(clientWidth, clientHeight);
    this.view?.resize(clientWidth, clientHeight);
  }

  private drawMarks(): void {
    this.marks.begin();
    if (this.view === null || this.description === null) return;
    if (this.lastFrame !== null) drawKeys(this.keyboards.list, this.view, this.marks, this.palette.port);
    if (this.names) drawNames(this.marks, this.view, this.palette.text);
    this.picked.draw(this.marks, this.palette);
    if (this.arrows) this.portArrows.draw(this.marks, this.view, this.arrowMats, this.palette.port);
    this.pointer.draw(this.marks, { mine: this.palette.text, others: this.palette.quiet });
  }

  /** MATs of the ports without an arrow of their own: those that are held have one. */
  private get arrowMats(): number[] {
    const held = new Set(this.pointer.figures.held.map(({ port }) => port));
    return this.description!.ports.filter((_, port) => !held.has(port)).map(({ mat }) => mat);
  }

  private freeze(wanted: boolean): void {
    this.frozen = wanted;
    this.plots.hold(wanted);
    this.toggle('h', wanted);
    this.refresh();
  }

  private fileName(ending: string): string {
    return `${this.description?.name ?? 'cordis'}_${(this.lastFrame?.simulatedS ?? 0).toFixed(2)}s.${ending}`;
  }

  private async saveImage(): Promise<void> {
    if (this.view === null || this.description === null || this.lastFrame === null) return;
    const image = await imageOfView(this.view, this.marks.canvas, {
      scene: this.description.name,
      simulatedS: this.lastFrame.simulatedS,
      legend: this.legend,
      scale: this.scale,
      note: this.motion.textSince(this.view.countedSinceS),
      palette: this.palette,
    });
    if (image !== null) download(image, this.fileName('png'));
  }
}
