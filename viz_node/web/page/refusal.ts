// viz_node/web/page/refusal.ts -- why a device gets no force from the scene.
import type { NodeState } from './protocol.ts';

/** What sim_node says of devices to which it gives no force, as [title, reason]; null when it gives them theirs. */
export function refusalOf(sim: NodeState | undefined): [string, string] | null {
  if (sim === undefined) return null;
  const { state, text } = sim;
  if (state === 'disconnected' && text !== '') return ['the devices are let go of', `${text}.`];
  // Of several devices one may play. Without any, the reason may be that a device is measured first.
  const isRefused = text.includes('is given no force') || (state === 'waiting' && text.includes("device '"));
  return isRefused ? ['a device gets no force', `${text}.`] : null;
}
