// Shorthands that create DOM elements.

type Props = Record<string, unknown>;

export function make<K extends keyof HTMLElementTagNameMap>(
    tag: K, props: Props = {}, ...children: (Node | string)[]): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [key, value] of Object.entries(props)) {
    if (key.startsWith('aria-')) element.setAttribute(key, String(value));
    else (element as unknown as Props)[key] = value;
  }
  element.append(...children);
  return element;
}

export function button(text: string, title: string, onclick: () => void): HTMLButtonElement {
  return make('button', {type: 'button', textContent: text, title, 'aria-label': title, onclick});
}
