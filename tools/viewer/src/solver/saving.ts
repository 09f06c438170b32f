// Files of a motion.
import { Zip, ZipDeflate } from 'fflate';
import { download } from '../record';
import type { Path, Shapespace } from './library';

/** Digits of frames in the names of their files, so that these are in order. */
const framePattern = 'frame_%03d.obj';
/** Coordinates as text become a third of their size, whether it is tried hard or not. */
const level = 3;

/** Lets the page be drawn and used in the middle of long work. */
function pause(): Promise<void> {
  return new Promise((resolve) => setTimeout(resolve, 0));
}

async function zipped(files: { name: string; data: Uint8Array }[]): Promise<Blob> {
  const parts: Uint8Array<ArrayBuffer>[] = [];
  const zip = new Zip((error, part) => {
    if (error) throw error;
    parts.push(part as Uint8Array<ArrayBuffer>);
  });
  for (const { name, data } of files) {
    const entry = new ZipDeflate(name, { level });
    zip.add(entry);
    entry.push(data, true);
    await pause();
  }
  zip.end();
  return new Blob(parts, { type: 'application/zip' });
}

export type Format = 'glb' | 'zip' | 'path';

/** Saves a motion, which takes `seconds` where files say how long, and returns the file's name. */
export async function save(
  library: Shapespace,
  path: Path,
  format: Format,
  stem: string,
  seconds: number,
): Promise<string> {
  const name = `${stem}.${format}`;
  if (format === 'path') {
    download(new Blob([path.file as Uint8Array<ArrayBuffer>]), name);
  } else if (format === 'zip') {
    download(await zipped(await library.write(path, framePattern)), `${stem}-frames.zip`);
    return `${stem}-frames.zip`;
  } else {
    const [{ data }] = await library.write(path, name, { duration: seconds });
    download(new Blob([data as Uint8Array<ArrayBuffer>], { type: 'model/gltf-binary' }), name);
  }
  return name;
}
