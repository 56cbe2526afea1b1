// SPDX-License-Identifier: Apache-2.0
// The built page on loopback, as any static host would serve it: from the top or from a folder.

import { createServer } from "node:http";
import { readFile } from "node:fs/promises";
import { extname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";

export const dist = fileURLToPath(new URL("../dist/", import.meta.url));
const TYPES = {
  ".html": "text/html",
  ".js": "text/javascript",
  ".css": "text/css",
  ".svg": "image/svg+xml",
};

export async function serve(folder = "/") {
  const server = createServer(async (request, response) => {
    const whole = normalize(new URL(request.url, "http://x").pathname);
    try {
      if (!whole.startsWith(folder)) throw new Error("not ours");
      const path = whole.slice(folder.length);
      const body = await readFile(join(dist, path === "" ? "index.html" : path));
      response.setHeader("content-type", TYPES[extname(path)] ?? "text/html");
      response.end(body);
    } catch {
      response.statusCode = 404;
      response.end();
    }
  });
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  return { url: `http://127.0.0.1:${server.address().port}${folder}`, close: () => server.close() };
}
