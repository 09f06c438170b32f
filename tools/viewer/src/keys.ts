/** Calls `act` when a key is pressed, wherever that is not text that is typed or chosen from. */
export function onKey(key: string, act: () => void): void {
  document.addEventListener('keydown', (event) => {
    if (event.key !== key || event.ctrlKey || event.metaKey || event.altKey) return;
    if ((event.target as Element).closest('select, textarea, input[type=number], dialog')) return;
    event.preventDefault();
    act();
  });
}
