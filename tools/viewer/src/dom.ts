/** The element of the page with this id. */
export function byId<Kind extends HTMLElement>(id: string): Kind {
  const element = document.getElementById(id);
  if (!element) throw new Error(`the page has no element ${id}`);
  return element as Kind;
}

/** A new element of SVG. */
export function svg<Name extends keyof SVGElementTagNameMap>(
  name: Name,
  attributes: Record<string, string | number> = {},
  parent?: Element,
): SVGElementTagNameMap[Name] {
  const element = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, String(value));
  parent?.append(element);
  return element;
}

/** The value of a property of the theme, such as "--accent". */
export function themeValue(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

/** Three digits, for numbers of any size. */
export function shortNumber(value: number): string {
  return Number(value.toPrecision(3)).toString();
}

export function perCent(value: number): string {
  if (value < 1e-6) return '0\u2009%'; // rounding errors
  return `${shortNumber(100 * value)}\u2009%`;
}

/** Shows a sentence to the user, which screen readers read too. */
export function tell(text: string): void {
  byId('status').textContent = text;
}

/** The names of one or two scenes with facts about each; those of two also above their parts of the
 * stage. */
export function showNames(names: string[], facts: string[]): void {
  byId('title').textContent = names.join(' and ');
  byId('facts').textContent = facts.join('; ');
  if (names.length === 1) return;
  names.forEach((name, i) => {
    const caption = document.createElement('span');
    caption.textContent = `${'AB'[i]}: ${name}`;
    byId('captions').append(caption);
  });
}
