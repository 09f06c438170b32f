// One file, dist/viewer.html, with script and style in it. ASCII only and without "</script", so that
// it can stand in an HTML file and in a C++ string alike.
import { createHash } from 'node:crypto';
import { existsSync, readFileSync } from 'node:fs';
import { defineConfig } from 'vite';

// A comment with the licences of the page itself and of the packages in it. They ask that their
// notices go wherever the code goes, and minifying removes those that stand in it.
function notices(bundle) {
  const packages = new Set();
  for (const file of Object.values(bundle)) {
    for (const module of Object.keys(file.modules ?? {})) {
      const found = module.match(/^.*\/node_modules\/(?:@[^/]+\/)?[^/]+/);
      if (found) packages.add(found[0]);
    }
  }
  const texts = ['../..', ...[...packages].sort()].map((folder) => {
    const file = [`${folder}/LICENSE`, `${folder}/LICENSE.md`].find((name) => existsSync(name));
    if (!file) throw new Error(`${folder} has no licence that pages could contain`);
    return readFileSync(file, 'utf8').trim().replaceAll('\u00a9', '(c)');
  });
  const text = ['shapespace and the software that this page contains', ...texts].join('\n\n\n');
  if (/--|[^\n\x20-\x7e]/.test(text)) throw new Error('a licence does not fit into a comment');
  return `<!--\n${text}\n-->`;
}

function inline() {
  return {
    name: 'inline',
    enforce: 'post',
    generateBundle(_, bundle) {
      const page = Object.values(bundle).find((file) => file.fileName.endsWith('.html'));
      page.source = page.source.replace('</head>', () => `${notices(bundle)}\n  </head>`);
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
      page.source = page.source.replace(/SCRIPT-HASH|STYLE-HASH/g, (mark) => {
        const tag = mark === 'SCRIPT-HASH' ? 'script' : 'style';
        const [, content] = page.source.match(new RegExp(`<${tag}[^>]*>([^]*?)</${tag}>`));
        return `sha256-${createHash('sha256').update(content).digest('base64')}`;
      });
    },
  };
}

export default defineConfig({
  plugins: [inline()],
  esbuild: { charset: 'ascii', legalComments: 'none' },
  build: {
    target: 'es2022',
    modulePreload: false,
    cssCodeSplit: false,
    reportCompressedSize: false,
    chunkSizeWarningLimit: 2000,
    rollupOptions: { input: 'viewer.html' },
  },
});
