import { fileURLToPath } from 'node:url';
import { defineConfig } from 'vite';

// One ES module with everything in it, for a <script type="module"> and for npm alike.
export default defineConfig({
  root: fileURLToPath(new URL('.', import.meta.url)),
  publicDir: false,
  build: {
    target: 'es2022',
    minify: 'oxc',
    emptyOutDir: false,
    outDir: 'dist',
    lib: { entry: 'src/index.ts', formats: ['es'], fileName: () => 'reactive-portrait.js' },
  },
});
