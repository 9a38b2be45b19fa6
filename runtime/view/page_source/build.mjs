// Writes dist/viewer.min.js from src/, and three's licence beside it: `npm ci && npm run build`.
// The same sources and versions (package-lock.json) give the same bytes.
import { build } from "esbuild";
import { copyFile, readFile } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const output = process.argv[2] ?? join(here, "dist");
const { version } = JSON.parse(await readFile(join(here, "node_modules/three/package.json"), "utf8"));

await build({
  absWorkingDir: here,
  entryPoints: ["src/main.js"],
  outfile: join(output, "viewer.min.js"),
  bundle: true,
  minify: true,
  format: "iife",
  target: "es2022",
  charset: "ascii", // the bundle stands in pages of any encoding
  legalComments: "none", // the banner and the licence file say it once
  banner: {
    js: `/* Viewer of funicular (MIT), with three.js ${version} (MIT, three.js authors): three-LICENSE.txt */`,
  },
});
await copyFile(join(here, "node_modules/three/LICENSE"), join(output, "three-LICENSE.txt"));
