// The picture over the whole screen, with the slider and without the other controls.
import { byId } from './dom';
import { onKey } from './keys';

/** Where the browser does not permit it, as in frames, there is no button. */
export function startFullScreen(): void {
  const button = byId('fullscreen');
  button.hidden = !document.fullscreenEnabled;
  if (button.hidden) return;
  const toggle = () => {
    if (document.fullscreenElement) void document.exitFullscreen();
    else void byId('layout').requestFullscreen();
  };
  button.addEventListener('click', toggle);
  onKey('f', toggle);
}
