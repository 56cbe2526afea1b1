// SPDX-License-Identifier: Apache-2.0
import { defineConfig } from "vite";

// Relative addresses: the build runs from any folder of any static host.
export default defineConfig({
  base: "./",
  build: { target: "es2022", chunkSizeWarningLimit: 900, assetsInlineLimit: 0 },
});
