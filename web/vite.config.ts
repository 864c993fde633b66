import { fileURLToPath } from 'node:url';
import { defineConfig } from 'vite';
import { help } from './help';

// In development the page comes from Vite and everything under /v1 from a running `galatea serve`.
const service = process.env.GALATEA_URL ?? 'http://127.0.0.1:8000';

export default defineConfig({
  plugins: [help(fileURLToPath(new URL('../docs', import.meta.url)))],
  build: { target: 'es2022', assetsInlineLimit: 0, modulePreload: { polyfill: false } },
  server: { proxy: { '/v1': { target: service, changeOrigin: true, headers: { origin: service } } } },
});
