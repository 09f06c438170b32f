// Run in the page: what is wrong with its text, layout and controls.

// Text with less contrast to what is behind it than WCAG 2 asks for, 4.5.
export function contrastFaults() {
  const channels = (colour) => colour.match(/[\d.]+/g).map(Number);
  const luminance = ([r, g, b]) => {
    const [x, y, z] = [r, g, b].map((byte) => {
      const c = byte / 255;
      return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
    });
    return 0.2126 * x + 0.7152 * y + 0.0722 * z;
  };
  const behind = (element) => {
    for (let e = element; e; e = e.parentElement) {
      const colour = channels(getComputedStyle(e).backgroundColor);
      if (colour.length < 4 || colour[3] === 1) return colour;
    }
    return [255, 255, 255];
  };
  const faults = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const element = node.parentElement;
    if (!node.textContent.trim() || !element.checkVisibility()) continue;
    if (/^(script|style|title)$/i.test(element.tagName)) continue;
    const style = getComputedStyle(element);
    const colour = element instanceof SVGElement ? style.fill : style.color;
    const [a, b] = [luminance(channels(colour)), luminance(behind(element))];
    const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    if (ratio < 4.5) faults.push(`${node.textContent.trim()}: contrast ${ratio.toFixed(2)}`);
  }
  return faults;
}

// What sticks out of the page, and controls that are hard to hit with a finger.
export function layoutFaults() {
  const faults = [];
  const { clientWidth, scrollWidth } = document.documentElement;
  if (scrollWidth > clientWidth) faults.push(`the page is ${scrollWidth} wide`);
  for (const element of document.querySelectorAll('body *')) {
    if (!element.checkVisibility() || element.closest('svg')) continue;
    const { left, right, width } = element.getBoundingClientRect();
    if (width > 0 && (left < -0.5 || right > clientWidth + 0.5)) {
      faults.push(`${element.tagName} ${element.id} reaches from ${left} to ${right}`);
    }
  }
  const controls = 'button, select, input[type=range], label.check, .handle';
  for (const element of document.querySelectorAll(controls)) {
    if (!element.checkVisibility()) continue;
    const { width, height } = element.getBoundingClientRect();
    if (width < 40 || height < 40) {
      faults.push(`${element.tagName} ${element.id} is ${width} x ${height}`);
    }
  }
  return faults;
}

// Controls without a name that can be read aloud.
export function namelessControls() {
  const controls = 'button, select, input, textarea, canvas, [role=slider], [role=img]';
  return [...document.querySelectorAll(controls)]
    .filter((element) => element.checkVisibility())
    .filter((element) => {
      const around = element.labels?.[0] ?? element.closest('label');
      const label = element.getAttribute('aria-label') ?? around?.textContent;
      return !(label ?? element.textContent).trim();
    })
    .map((element) => `${element.tagName} ${element.id}`);
}
