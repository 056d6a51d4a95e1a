// viz_node/web/page/link_groups.ts -- how the links of each liaison, and the bonds of sets, look: a
// colour for each state, and where several liaisons are drawn a line pattern for each of them.
import { NO_STATE_MACHINE, type Description, type Topology } from './protocol.ts';

/** A state with its liaison before it; the liaison alone if its only state has no name. */
export const stateName = (liaison: string, state: string): string => (liaison === '' || state === '' ? liaison + state : `${liaison}: ${state}`);

export const PATTERNS = ['solid', 'dashed', 'dotted'] as const;

/** Links of one liaison with states, whatever their parameters, or those without. */
export interface LinkGroup {
  name: string; // of the liaison; empty for links without states
  states: string[];
  pattern: number; // of PATTERNS; the largest group is solid
}

/** Bonds of the liaisons of sets with one name. */
export interface BondGroup {
  name: string; // of the liaison
  states: string[];
  shown: number[]; // states that they may be in
  pattern: number; // of PATTERNS
}

/** One liaison with other parameters for some of its links is several state machines of one name. */
const keyIn = (machines: Description['state_machines'], machine: number) => JSON.stringify([machines[machine]?.name ?? '', machines[machine]?.states ?? []]);

/** How the bonds of each set look. Their patterns are their own: a line before balls is no link. */
export class BondGroups {
  readonly list: BondGroup[]; // in the order of the sets
  private readonly sets: BondGroup[]; // per set of the description

  constructor({ state_machines: machines, sets }: Description) {
    const groups = new Map<string, BondGroup>();
    this.sets = sets.map(({ state_machine: machine, start_state: start }) => {
      const { name = '', states = [] } = machines[machine] ?? {};
      const key = keyIn(machines, machine);
      const group = groups.get(key) ?? { name, states, shown: [], pattern: Math.min(groups.size, PATTERNS.length - 1) };
      group.shown.push(...[...states.keys()].filter((state) => state !== start && !group.shown.includes(state)));
      groups.set(key, group);
      return group;
    });
    this.list = [...groups.values()];
  }

  /** The pattern of the bonds of a set, whether the page knows it or not. */
  patternOf(set: number): number {
    return this.sets[set]?.pattern ?? PATTERNS.length - 1;
  }
}

export class LinkGroups {
  readonly list: LinkGroup[]; // the largest first
  private readonly groupOf: Map<number, LinkGroup>; // by state machine

  constructor({ state_machines }: Description, private readonly topology: Topology) {
    const { stateMachines, linkCount } = topology;
    const counts = new Map<number, number>();
    for (const machine of stateMachines) counts.set(machine, (counts.get(machine) ?? 0) + 1);
    if (stateMachines.length === 0 && linkCount > 0) counts.set(NO_STATE_MACHINE, linkCount);
    const keyOf = (machine: number) => keyIn(state_machines, machine);
    const sizes = new Map<string, number>();
    for (const [machine, count] of counts) sizes.set(keyOf(machine), (sizes.get(keyOf(machine)) ?? 0) + count);
    const machines = [...counts.keys()].sort((a, b) => sizes.get(keyOf(b))! - sizes.get(keyOf(a))! || a - b);
    const groups = new Map<string, LinkGroup>();
    for (const machine of machines) {
      const { name = '', states = [] } = state_machines[machine] ?? {};
      if (!groups.has(keyOf(machine))) groups.set(keyOf(machine), { name, states, pattern: Math.min(groups.size, PATTERNS.length - 1) });
    }
    this.list = [...groups.values()];
    this.groupOf = new Map(machines.map((machine) => [machine, groups.get(keyOf(machine))!]));
  }

  of(link: number): LinkGroup {
    return this.groupOf.get(this.topology.stateMachines[link] ?? NO_STATE_MACHINE) ?? this.list[0]!;
  }

  /** The name of a state of a link; empty for links without states. */
  stateName(link: number, state: number): string {
    return this.of(link).states[state] ?? '';
  }
}
