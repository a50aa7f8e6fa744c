// `node build.mjs` bundles the extension, `node build.mjs test` its tests, which need no editor.
import { readdirSync } from "node:fs";
import { build } from "esbuild";

const shared = { bundle: true, external: ["vscode"], format: "cjs", platform: "node", target: "node18" };
if (process.argv[2] === "test") {
  const tests = readdirSync("test").filter((name) => name.endsWith(".test.ts"));
  await build({ ...shared, entryPoints: tests.map((name) => `test/${name}`), outdir: "dist/test" });
} else {
  await build({ ...shared, entryPoints: ["src/extension.ts"], outfile: "dist/extension.js", minify: true });
}
