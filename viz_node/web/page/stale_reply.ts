// viz_node/web/page/stale_reply.ts -- says when a reply is no longer true.

/** True if `text` says that the scene is paused, and it now goes on, or the other way round. */
export function isStale(text: string, wasPaused: boolean, isPaused: boolean): boolean {
  if (wasPaused === isPaused) return false;
  return wasPaused ? /\bpaused\b/.test(text) : /\bgoes on\b/.test(text);
}
