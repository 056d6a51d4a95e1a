// viz_node/web/page/protocol.ts -- messages between viz_node and the page; ../README.md says what
// each field is.

export const MAGIC = 0x31534443; // the bytes "CDS1"
export const VERSION = 4;
export const NO_STATE_MACHINE = 65535; // of a link

const TYPE_FRAME = 1;
const TYPE_SIGNALS = 2;
const TYPE_TOPOLOGY = 3;
const TYPE_SOUND = 4;

export interface Frame {
  type: 'frame';
  sequence: number;
  scene: number;
  frame: number;
  step: number;
  takenNsec: number;
  sentNsec: number;
  simulatedS: number;
  matCount: number;
  dropped: number;
  positions: Float32Array<ArrayBuffer>; // x, y, z of each MAT [m]
  linkStates: Uint8Array<ArrayBuffer>; // per link, + LINK_IS_IDLE of wire.ts, or empty
  bondEnds: Uint32Array<ArrayBuffer>; // two per bond, set after set
  bondCounts: Uint32Array<ArrayBuffer>; // bonds of each set of the description, or empty
  bondStates: Uint8Array<ArrayBuffer>; // per bond, + LINK_IS_IDLE
  bondsLeftOut: number; // that there are beside these
  portForces: Float32Array<ArrayBuffer>; // x, y, z of what the liaisons do to each port [N], or empty
}

export interface Signals {
  type: 'signals';
  scene: number;
  signalCount: number;
  rowCount: number;
  droppedRows: number;
  firstStep: number;
  firstS: number;
  rowPeriodS: number;
  values: Float32Array<ArrayBuffer>; // row after row
}

export interface Topology {
  type: 'topology';
  scene: number;
  matCount: number;
  linkCount: number;
  radii: Float32Array<ArrayBuffer>; // [m]
  masses: Float32Array<ArrayBuffer>; // [kg]; 0 of what is fixed or moved by a device
  linkEnds: Uint32Array<ArrayBuffer>; // two per link
  stateMachines: Uint16Array<ArrayBuffer>; // per link: an index in those of the description, or NO_STATE_MACHINE; or empty
  kinds: Uint8Array<ArrayBuffer>; // MAT_*
}

export interface Sound {
  type: 'sound';
  scene: number;
  soundCount: number;
  stepCount: number;
  droppedSteps: number; // before the first, by sim_node
  firstStep: number;
  stepRateHz: number; // samples per second of simulated time
  takenNsec: number; // when the last sample was taken
  values: Float32Array<ArrayBuffer>; // step after step
}

export interface NamedRange {
  name: string;
  first: number;
  count: number;
}

export interface Port {
  name: string;
  device: string;
  role: 'mass' | 'liaison';
  mat: number;
  axes: number[];
  rest: number[]; // x, y, z of its MAT when all axes are at 0 [m]
  direction: number[]; // 3 per axis: unit vector along which the axis moves it
}

/** A liaison of sets whose pairs have states; a pair in another state than that of the start is a bond. */
export interface PairSet {
  name: string;
  state_machine: number;
  start_state: number;
}

/** A device, as it says it is. */
export interface DeviceShape {
  name: string;
  simulated: boolean; // nothing real is moved by it
  key_pitch_m: Figure; // of keys side by side; 0: it is no keyboard
  lowest_m: Figure; // end of the travel of each key below its rest; 0: they differ
  travel_m: Figure[]; // per axis, from stop to stop; 0: unknown
}

/** Consecutive MATs to which the scene gives a colour; a later range stands above an earlier one. */
export interface ColouredRange {
  first: number;
  count: number;
  colour: string; // #rrggbb
}

/** A body of the scene that matter touches: fixed, or driven by a function of time. */
export interface Surface {
  name: string;
  mat: number | null; // it is at `centre` in each frame; null: there is none
  kind: 'plane' | 'box' | 'cylinder' | 'segment' | 'hollow_box' | 'hollow_cylinder' | 'inner_face';
  centre: number[]; // x, y, z [m] at the start; a point of a plane
  axis: number[]; // unit vector: the normal of a plane on its outer side, the direction of a segment; empty for a box and an inner face
  size: number[]; // box: edges x, y, z [m], 0 where it has no end; cylinder: radius, length; segment: length
}

export interface Hello {
  type: 'hello';
  protocol: number;
  session: string;
  node: string;
  scenes: string[]; // that pages may load by their number
  parameters: boolean; // pages may set them
  may_command: boolean; // false: the address of the page lacks the token
}

export interface Description {
  type: 'description';
  scene: number;
  epoch: string;
  version: number;
  name: string;
  scene_file: string;
  space: 1 | 2 | 3;
  step_rate_hz: number;
  gesture_rate_hz: number;
  frame_rate_hz: number;
  mat_count: number;
  link_count: number;
  matter: NamedRange[];
  links: NamedRange[];
  state_machines: { name: string; states: string[] }[];
  sets: PairSet[];
  ports: Port[];
  tools: (number | null)[]; // of each port: the MAT that its coupling moves. Filled in by the page
  signals: { name: string; unit: string; sound: boolean; full_scale: Figure }[];
  surfaces: Surface[];
  colours: ColouredRange[];
  colours_left_out?: number; // that viz_node knows beside these
}

/** The MATs that hands move by a coupling: they have the name of a port whose own MAT is the handle. */
export function toolsOf({ ports, matter }: Description): (number | null)[] {
  const isTool = (range: NamedRange, port: Port) =>
    range.name === port.name && range.count === 1 && range.first !== port.mat;
  return ports.map((port) => matter.find((range) => isTool(range, port))?.first ?? null);
}

/** A number that was not finite in the node comes as null. */
type Figure = number | null;

export interface NodeState {
  name: string;
  host: string; // with its address on a network
  kind: string;
  epoch: string;
  state: string; // a word of NodePhase, idl/control.idl
  text: string;
  received_s: number;
  target_rate_hz: Figure;
  reached_rate_hz: Figure;
  mean_rate_hz: Figure;
  ticks: number;
  overruns: number;
  dropped: number;
  latency_count: number;
  latency_p50_s: Figure;
  latency_p99_s: Figure;
  latency_max_s: Figure;
  link_samples: number; // of a device: answered, or older than one that is
  link_unanswered: number; // of these, without an answer of their own
  energy_j: Figure;
  energy_drift: Figure;
  integration_error_j: Figure; // what the steps have put in, and no account explains
  switching_energy_j: Figure; // brought in by changes of state and of parameters, net
  port_work_j: Figure; // brought in through the ports, net
  dissipated_j: Figure; // taken by viscosity
  largest_stability_number: Figure; // K' + 2 Z' seen: below 4 nothing diverges
  largest_partners: number; // most others that a mass of a set has touched at once
  certified_partners: number | null; // up to which the step is certified; null where nothing is watched
  overflowed_steps: number; // in which a set had more pairs than room
  forgotten_pairs: number; // states lost for lack of memory
  refused_inputs: number; // not finite
  port_energy_j: Figure; // of a device: given to the hand, net
  passivity_ticks: number;
  step: number;
  changes: LiaisonChanges[]; // since the scene began
  lost_events: number;
  memory_bytes: Figure;
}

export interface LiaisonChanges {
  liaison: string;
  changes: number;
}

export interface Reply {
  number: number;
  node: string;
  accepted: boolean;
  text: string;
}

export interface LinkEvent {
  step: number;
  link: number | null; // null: a pair of a set liaison
  mat_a: number;
  mat_b: number;
  state_machine: number;
  from: number;
  to: number;
  quantity: string; // that triggered it; empty: the state was forced from outside
  unit: string; // of value
  value: Figure;
  energy_j: Figure;
}

export interface Status {
  type: 'status';
  scene: number;
  sent_nsec: number;
  nodes: NodeState[];
  devices: DeviceShape[];
  events: { total: number; lost: number; newest: LinkEvent[] };
  replies: Reply[]; // to the commands of pages, newest last
  viz: { frames: number; refused: number; lost: number };
}

/** A port that can be dragged. */
export interface PointerPort {
  port: number;
  holder: number; // number of the page that holds its device; 0: none
  held: boolean; // this very port is
  plays: boolean; // the device says so
  event: number; // newest of this page whose force is at the handle
  target_m: number[]; // that the hand follows
  force_n: number[]; // on the handle
}

export interface PointerState {
  type: 'pointer';
  page: number; // number of this page
  ports: PointerPort[];
}

export type Message = Frame | Signals | Topology | Sound | Hello | Description | Status | PointerState;

/** Reads a binary message. Throws an Error when it is none of this protocol, or shorter than it says. */
export function decodeBinary(buffer: ArrayBuffer): Frame | Signals | Topology | Sound {
  const view = new DataView(buffer);
  if (buffer.byteLength < 8 || view.getUint32(0, true) !== MAGIC) throw new Error('not a message of viz_node');
  if (view.getUint8(4) !== VERSION) throw new Error(`protocol version ${view.getUint8(4)}: reload the page`);
  const header = view.getUint16(6, true);
  switch (view.getUint8(5)) {
    case TYPE_FRAME:
      return decodeFrame(view, header);
    case TYPE_SIGNALS:
      return decodeSignals(view, header);
    case TYPE_TOPOLOGY:
      return decodeTopology(view, header);
    case TYPE_SOUND:
      return decodeSound(view, header);
    default:
      throw new Error(`unknown message type ${view.getUint8(5)}`);
  }
}

const u64 = (view: DataView, offset: number) => Number(view.getBigUint64(offset, true));

function checkLength(view: DataView, expected: number): void {
  if (view.byteLength !== expected) throw new Error(`message of ${view.byteLength} bytes, expected ${expected}`);
}

function decodeFrame(view: DataView<ArrayBuffer>, header: number): Frame {
  const matCount = view.getUint32(56, true);
  const linkStates = view.getUint32(60, true);
  const [bonds, sets, ports] = [68, 76, 80].map((offset) => view.getUint32(offset, true)) as [number, number, number];
  const bondEnds = header + 12 * matCount;
  const bondCounts = bondEnds + 8 * bonds;
  const portForces = bondCounts + 4 * sets;
  const states = portForces + 12 * ports;
  checkLength(view, states + linkStates + bonds);
  return {
    type: 'frame',
    sequence: view.getUint32(8, true),
    scene: view.getUint32(12, true),
    frame: u64(view, 16),
    step: u64(view, 24),
    takenNsec: u64(view, 32),
    sentNsec: u64(view, 40),
    simulatedS: view.getFloat64(48, true),
    matCount,
    dropped: view.getUint32(64, true),
    positions: new Float32Array(view.buffer, header, 3 * matCount),
    linkStates: new Uint8Array(view.buffer, states, linkStates),
    bondEnds: new Uint32Array(view.buffer, bondEnds, 2 * bonds),
    bondCounts: new Uint32Array(view.buffer, bondCounts, sets),
    bondStates: new Uint8Array(view.buffer, states + linkStates, bonds),
    bondsLeftOut: view.getUint32(72, true),
    portForces: new Float32Array(view.buffer, portForces, 3 * ports),
  };
}

function decodeSignals(view: DataView<ArrayBuffer>, header: number): Signals {
  const signalCount = view.getUint32(12, true);
  const rowCount = view.getUint32(16, true);
  checkLength(view, header + 4 * signalCount * rowCount);
  return {
    type: 'signals',
    scene: view.getUint32(8, true),
    signalCount,
    rowCount,
    droppedRows: view.getUint32(20, true),
    firstStep: u64(view, 24),
    firstS: view.getFloat64(32, true),
    rowPeriodS: view.getFloat64(40, true),
    values: new Float32Array(view.buffer, header, signalCount * rowCount),
  };
}

function decodeSound(view: DataView<ArrayBuffer>, header: number): Sound {
  const soundCount = view.getUint32(12, true);
  const stepCount = view.getUint32(16, true);
  checkLength(view, header + 4 * soundCount * stepCount);
  return {
    type: 'sound',
    scene: view.getUint32(8, true),
    soundCount,
    stepCount,
    droppedSteps: view.getUint32(20, true),
    firstStep: u64(view, 24),
    stepRateHz: view.getFloat64(32, true),
    takenNsec: u64(view, 40),
    values: new Float32Array(view.buffer, header, soundCount * stepCount),
  };
}

function decodeTopology(view: DataView<ArrayBuffer>, header: number): Topology {
  const matCount = view.getUint32(12, true);
  const linkCount = view.getUint32(16, true);
  const machineCount = view.getUint32(20, true);
  checkLength(view, header + 9 * matCount + 8 * linkCount + 2 * machineCount);
  const ends = header + 8 * matCount;
  const machines = ends + 8 * linkCount;
  return {
    type: 'topology',
    scene: view.getUint32(8, true),
    matCount,
    linkCount,
    radii: new Float32Array(view.buffer, header, matCount),
    masses: new Float32Array(view.buffer, header + 4 * matCount, matCount),
    linkEnds: new Uint32Array(view.buffer, ends, 2 * linkCount),
    stateMachines: new Uint16Array(view.buffer, machines, machineCount),
    kinds: new Uint8Array(view.buffer, machines + 2 * machineCount, matCount),
  };
}
