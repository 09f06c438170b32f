// Pictures and films of the stage.
import type { Player } from './player';
import type { Stage } from './stage';

export function download(blob: Blob, name: string): void {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

export function savePicture(stage: Stage, name: string): Promise<void> {
  stage.drawNow();
  return new Promise((resolve, reject) => {
    stage.canvas.toBlob((blob) => {
      if (!blob) return reject(new Error('the browser made no picture'));
      download(blob, name);
      resolve();
    });
  });
}

/** Whether this browser can make films. */
export function canFilm(): boolean {
  return typeof MediaRecorder !== 'undefined' && filmType() !== undefined;
}

function filmType(): string | undefined {
  return [
    'video/webm;codecs=vp9',
    'video/webm;codecs=vp8',
    'video/webm',
    'video/mp4;codecs=avc1.42E01E',
    'video/mp4',
  ].find((type) => MediaRecorder.isTypeSupported(type));
}

/** Plays once from the start to the end, as fast as it is set, and saves what is seen as WebM, or
 * as MP4 where the browser writes no WebM. `name` is without extension. */
export function saveFilm(stage: Stage, player: Player, name: string): Promise<void> {
  const stream = stage.canvas.captureStream(60);
  const [type] = filmType()!.split(';');
  const recorder = new MediaRecorder(stream, {
    mimeType: filmType(),
    videoBitsPerSecond: 8_000_000,
  });
  const parts: Blob[] = [];
  const { repeat } = player;
  player.pause();
  player.repeat = 'once';
  player.seek(0);
  stage.draw();
  return new Promise((resolve, reject) => {
    const restore = () => {
      player.pause();
      player.repeat = repeat;
      for (const track of stream.getTracks()) track.stop();
    };
    recorder.addEventListener('dataavailable', ({ data }) => parts.push(data));
    recorder.addEventListener('error', () => {
      restore();
      reject(new Error('the browser could not record the film'));
    });
    recorder.addEventListener('stop', () => {
      restore();
      download(new Blob(parts, { type }), `${name}.${type.slice('video/'.length)}`);
      resolve();
    });
    recorder.start();
    player.play();
    const watch = () => {
      if (player.playing) requestAnimationFrame(watch);
      else recorder.stop();
    };
    requestAnimationFrame(watch);
  });
}
