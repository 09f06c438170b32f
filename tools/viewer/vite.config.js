// How build.js makes pages of one file, with script and style in it. ASCII only and without
// "</script", so that they can stand in an HTML file and in a C++ string alike.
import { createHash } from 'node:crypto';
import { existsSync, readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';

const folder = fileURLToPath(new URL('.', import.meta.url));
const root = `${folder}../..`;

// A comment with the licences of the page itself and of the packages in it. They ask that their
// notices go wherever the code goes, and minifying removes those that stand in it.
function notices(bundle, wasm) {
  const packages = new Set();
  for (const file of Object.values(bundle)) {
    for (const module of Object.keys(file.modules ?? {})) {
      const found = module.match(/^.*\/node_modules\/(?:@[^/]+\/)?[^/]+/);
      if (found) packages.add(found[0]);
    }
  }
  const files = [root, ...[...packages].sort()].map((folder) => {
    const file = [`${folder}/LICENSE`, `${folder}/LICENSE.md`].find((name) => existsSync(name));
    if (!file) throw new Error(`${folder} has no licence that pages could contain`);
    return file;
  });
  if (wasm) files.push(`${root}/javascript/NOTICES`);
  const texts = files.map((file) =>
    readFileSync(file, 'utf8')
      .trim()
      .replaceAll('\u00a9', '(c)')
      .normalize('NFKD')
      .replaceAll(/\p{M}/gu, '') // accents of names
      .replaceAll(/--+/g, '='), // comments may not contain two hyphens
  );
  const text = ['shapespace and the software that this page contains', ...texts].join('\n\n\n');
  if (/--|[^\n\x20-\x7e]/.test(text)) throw new Error('a licence does not fit into a comment');
  return `<!--\n${text}\n-->`;
}

// The module as base64 of what gzip makes of it: in a page there is no other file to load it from.
function asText(wasm) {
  return gzipSync(readFileSync(wasm), { level: 9 }).toString('base64');
}

function inline(wasm) {
  return {
    name: 'inline',
    enforce: 'post',
    generateBundle(_, bundle) {
      const page = Object.values(bundle).find((file) => file.fileName.endsWith('.html'));
      page.source = page.source.replace('</head>', () => `${notices(bundle, wasm)}\n  </head>`);
      for (const file of Object.values(bundle)) {
        if (file === page) continue;
        const name = file.fileName.replaceAll('.', '\\.');
        const content = (file.code ?? String(file.source)).trim();
        const [tag, element] = file.fileName.endsWith('.css')
          ? [`<link[^>]*href="[^"]*${name}"[^>]*>`, `<style>${content}</style>`]
          : [
              `<script[^>]*src="[^"]*${name}"[^>]*></script>`,
              `<script type="module">${content.replaceAll('</script', '<\\/script')}</script>`,
            ];
        page.source = page.source.replace(new RegExp(tag), () => element);
        delete bundle[file.fileName];
      }
      if (wasm) page.source = page.source.replace('SOLVER-MODULE', () => asText(wasm));
      page.source = page.source.replace(/SCRIPT-HASH|STYLE-HASH/g, (mark) => {
        const tag = mark === 'SCRIPT-HASH' ? 'script' : 'style';
        const [, content] = page.source.match(new RegExp(`<${tag}[^>]*>([^]*?)</${tag}>`));
        return `sha256-${createHash('sha256').update(content).digest('base64')}`;
      });
    },
  };
}

/** Of a page, which contains the module `wasm` if there is one. */
export const config = (page, wasm) => ({
  configFile: false,
  root: folder,
  plugins: [inline(wasm)],
  esbuild: { charset: 'ascii', legalComments: 'none' },
  // In pages that are opened as files, browsers start no workers that are modules.
  worker: { format: 'iife' },
  build: {
    target: 'es2022',
    modulePreload: false,
    cssCodeSplit: false,
    reportCompressedSize: false,
    chunkSizeWarningLimit: 2000,
    emptyOutDir: false,
    rollupOptions: { input: `${folder}${page}` },
  },
});
