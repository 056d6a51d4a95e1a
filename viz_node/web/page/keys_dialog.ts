// viz_node/web/page/keys_dialog.ts -- the list of keys, in words.

const KEYS: [string, string][] = [
  ['drag a ring', 'be the hand on that port'],
  ['drag elsewhere', 'turn the view, or move a flat one; the right button does the other'],
  ['wheel', 'zoom'],
  ['click', 'pick a mass or a link: its name and values'],
  ['Space', 'pause the simulation, or go on'],
  ['→', 'one step; in a take 5 s on, ← 5 s back'],
  ['[ and ]', 'slower and faster: slow motion, or the speed of a take'],
  ['Home', 'beginning of a take'],
  ['h', 'freeze the view; the simulation goes on'],
  ['f', 'fit the scene'],
  ['1 2 3 4', 'front, side, top, three-dimensional'],
  ['o', 'parallel or perspective'],
  ['c', 'what the colours say: bodies and states, speed, force, components, stretch'],
  ['m', 'motion drawn larger than it is, up to 100 times'],
  ['r', 'count motion and stretch from now on'],
  ['t', 'trails of MATs'],
  ['a', 'arrows of the forces on ports'],
  ['n', 'names of matter and ports'],
  ['g', 'grid'],
  ['+ -', 'plots over a shorter or a longer time, as does the wheel over them'],
  ['p', 'two signals against each other'],
  ['l', 'light or dark'],
  ['u', 'full screen'],
  ['s', 'save the image'],
  ['?', 'this list'],
];

const dialog = (): HTMLDialogElement => document.querySelector<HTMLDialogElement>('#keys')!;

/** While the list is open, no key commands anything. */
export const keysAreListed = (): boolean => dialog().open;

export function toggleKeys(): void {
  if (keysAreListed()) return dialog().close();
  const rows = KEYS.flatMap(([key, what]) => [
    Object.assign(document.createElement('dt'), { textContent: key }),
    Object.assign(document.createElement('dd'), { textContent: what }),
  ]);
  dialog().querySelector('dl')!.replaceChildren(...rows);
  dialog().showModal();
}
