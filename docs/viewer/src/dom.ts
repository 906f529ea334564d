// SPDX-License-Identifier: MIT
//
// Elements of the page, and numbers as text.

export function byId<T extends HTMLElement = HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (found === null) throw new Error(`the page has no #${id}`);
  return found as T;
}

type Child = Node | string;

/** An element with attributes and children; `on...` are listeners. */
export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: { [name: string]: string | boolean | EventListener } = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") element.addEventListener(name.slice(2), value);
    else if (value === true) element.setAttribute(name, "");
    else if (value !== false) element.setAttribute(name, value);
  }
  element.append(...children);
  return element;
}

/** The shortest text from which the same float is read. */
export function shortest(x: number): string {
  if (!Number.isFinite(x)) return String(x);
  for (let digits = 1; digits < 9; ++digits) {
    const text = x.toPrecision(digits);
    if (Math.fround(Number(text)) === Math.fround(x)) return String(Number(text));
  }
  return String(Number(x.toPrecision(9)));
}

/** A few digits, for where there is little room. */
export function brief(x: number): string {
  return String(Number(x.toPrecision(6)));
}

export function counted(n: number, what: string): string {
  const plural = /(s|sh|ch|x)$/.test(what) ? what + "es" : what + "s";
  return `${n.toLocaleString("en")} ${n === 1 ? what : plural}`;
}

export function cssColour(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}
