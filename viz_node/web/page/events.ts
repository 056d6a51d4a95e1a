// viz_node/web/page/events.ts -- the changes of state: how many, of which liaison, and the last of
// them, newest first.
import { count, joined, withUnit } from './format.ts';
import type { Description, LinkEvent, LiaisonChanges } from './protocol.ts';

/** One line for a person: 1.250 s  rosin[3]  hooked → unhooked  elongation 2.1 mm  −3.2 µJ */
export function eventLine(event: LinkEvent, description: Description | null): string {
  const time = (event.step / (description?.step_rate_hz ?? 1)).toFixed(3);
  const state_machine = description?.state_machines[event.state_machine];
  const state = (index: number) => state_machine?.states[index] ?? `state ${index}`;
  const why = event.quantity === '' ? 'forced' : `${event.quantity} ${joined(withUnit(event.value, event.unit))}`;
  const energy = event.energy_j ? `  ${joined(withUnit(event.energy_j, 'J'))}` : '';
  return `${time} s  ${nameOf(event, description)}  ${state(event.from)} → ${state(event.to)}  ${why}${energy}`;
}

function nameOf(event: LinkEvent, description: Description | null): string {
  if (event.link === null) {
    const liaison = description?.state_machines[event.state_machine]?.name ?? 'pair';
    return `${liaison}(${matName(event.mat_a, description)}, ${matName(event.mat_b, description)})`;
  }
  return indexed(event.link, description?.links) ?? `link ${event.link}`;
}

function matName(mat: number, description: Description | null): string {
  return indexed(mat, description?.matter) ?? `MAT ${mat}`;
}

function indexed(index: number, ranges: Description['links'] | undefined): string | null {
  const range = ranges?.find((r) => index >= r.first && index < r.first + r.count);
  if (range === undefined) return null;
  return range.count === 1 ? range.name : `${range.name}[${index - range.first}]`;
}

/** The counts of all liaisons in one line: collophane 120 · pluck 3 */
export function countsLine(changes: LiaisonChanges[]): string {
  return changes.map(({ liaison, changes: number }) => `${liaison} ${count(number)}`).join(' · ');
}
