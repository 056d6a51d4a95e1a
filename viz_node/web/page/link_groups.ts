// viz_node/web/page/link_groups.ts -- how the links of each liaison look: a colour for each state,
// and where several liaisons are drawn a line pattern for each of them.
import { NO_STATE_MACHINE, type Description, type Topology } from './protocol.ts';

export const PATTERNS = ['solid', 'dashed', 'dotted'] as const;

/** Links of one liaison with states, or those without. */
export interface LinkGroup {
  name: string; // of the liaison; empty for links without states
  states: string[];
  pattern: number; // of PATTERNS; the largest group is solid
}

export class LinkGroups {
  readonly list: LinkGroup[]; // the largest first
  private readonly groupOf: Map<number, LinkGroup>; // by state machine

  constructor({ state_machines }: Description, private readonly topology: Topology) {
    const { stateMachines, linkCount } = topology;
    const counts = new Map<number, number>();
    for (const machine of stateMachines) counts.set(machine, (counts.get(machine) ?? 0) + 1);
    if (stateMachines.length === 0 && linkCount > 0) counts.set(NO_STATE_MACHINE, linkCount);
    const machines = [...counts.keys()].sort((a, b) => counts.get(b)! - counts.get(a)! || a - b);
    this.list = machines.map((machine, place) => {
      const { name = '', states = [] } = state_machines[machine] ?? {};
      return { name, states, pattern: Math.min(place, PATTERNS.length - 1) };
    });
    this.groupOf = new Map(machines.map((machine, place) => [machine, this.list[place]!]));
  }

  of(link: number): LinkGroup {
    return this.groupOf.get(this.topology.stateMachines[link] ?? NO_STATE_MACHINE) ?? this.list[0]!;
  }

  /** The name of a state of a link; empty for links without states. */
  stateName(link: number, state: number): string {
    return this.of(link).states[state] ?? '';
  }
}
