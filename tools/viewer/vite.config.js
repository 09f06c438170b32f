// One file, dist/viewer.html, with script and style in it. ASCII only and without "</script", so that
// it can stand in an HTML file and in a C++ string alike.
import { defineConfig } from 'vite';

function inline() {
  return {
    name: 'inline',
    enforce: 'post',
    generateBundle(_, bundle) {
      const page = Object.values(bundle).find((file) => file.fileName.endsWith('.html'));
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
