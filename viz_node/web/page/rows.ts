// viz_node/web/page/rows.ts -- lists on the page whose rows stay and are written in place: what is
// selected, pointed at or measured is not taken away.

/** Gives `parent` one child per item, made by `make` when there are too few; `write` brings each up to date. */
export function fillRows<T>(parent: HTMLElement, items: T[], make: () => HTMLElement, write: (row: HTMLElement, item: T) => void): void {
  while (parent.childElementCount > items.length) parent.lastElementChild!.remove();
  while (parent.childElementCount < items.length) parent.append(make());
  items.forEach((item, i) => write(parent.children[i] as HTMLElement, item));
}

/** Writes a text only when it differs: a text that is replaced loses the selection. */
export function setText(element: Element, text: string): void {
  if (element.textContent !== text) element.textContent = text;
}

/** Shows whether a button is on. */
export function press(button: HTMLElement, on: boolean): void {
  button.classList.toggle('on', on);
  button.setAttribute('aria-pressed', String(on));
}
