// Builds the page as one file without outside resources, for the program to hold.
import { viteSingleFile } from "vite-plugin-singlefile";
import { defineConfig } from "vitest/config";

export default defineConfig({
  base: "./",
  // The server puts a fresh nonce here for each answer: only these scripts run (Content-Security-Policy).
  html: { cspNonce: "{{nonce}}" },
  esbuild: { jsx: "automatic", jsxImportSource: "preact" },
  build: { target: "es2022", modulePreload: false },
  plugins: [viteSingleFile({ removeViteModuleLoader: true })],
  test: { include: ["src/**/*.test.ts"] },
});
