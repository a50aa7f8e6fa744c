// A real VS Code in a real browser: code-server with the packaged extension, in a Chromium without a window.
import { execFile, spawn } from "node:child_process";
import { once } from "node:events";
import { existsSync } from "node:fs";
import { mkdir, mkdtemp, rm, writeFile } from "node:fs/promises";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { delimiter, join } from "node:path";
import { fileURLToPath } from "node:url";
import { promisify } from "node:util";

import { chromium } from "playwright-core";

const ROOT = fileURLToPath(new URL("../../../../", import.meta.url));
const VSIX = join(ROOT, "dist", "motion-script.vsix");
const LAUNCH = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const QUIET = {
  "chat.disableAIFeatures": true,
  "extensions.autoCheckUpdates": false,
  "extensions.autoUpdate": false,
  "telemetry.telemetryLevel": "off",
  "update.mode": "none",
  "workbench.startupEditor": "none",
};

/** Returns what is missing for it, in words; undefined if nothing is. */
export function missing() {
  const wanted = { "code-server": codeServer(), chromium: chromiumHere() };
  const gone = Object.keys(wanted).filter((name) => wanted[name] === undefined);
  return gone.length === 0 ? undefined : `${gone.join(" and ")} cannot be found: see docs/editors.md`;
}

/** What names the demo library. */
export const DEMO = { "mlmg.toml": 'library = "demo"\n' };

/** Opens a folder in VS Code, with some files in it and one of them open; closes all when `work` on its page ends. */
export async function inVSCode({ files, open, settings = {}, mlmg = join(ROOT, ".venv", "bin", "mlmg") }, work) {
  const home = await mkdtemp(join(tmpdir(), "vscode-"));
  const folder = join(home, "scripts");
  const user = join(home, "user");
  const ends = [() => rm(home, { recursive: true, force: true, maxRetries: 5 })];
  try {
    await write(folder, files);
    await write(join(user, "User"), { "settings.json": JSON.stringify({ ...QUIET, ...settings }) });
    await write(join(user, "Machine"), { "settings.json": JSON.stringify({ "mlmg.path": mlmg }) });
    const address = await serve(home, user, ends);
    const browser = await chromium.launch({ executablePath: chromiumHere(), args: LAUNCH });
    ends.push(() => browser.close());
    const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
    const opened = JSON.stringify([["openFile", `vscode-remote://${new URL(address).host}${join(folder, open)}`]]);
    await page.goto(`${address}/?folder=${encodeURIComponent(folder)}&payload=${encodeURIComponent(opened)}`);
    await page.locator(`.tab[aria-label^="${open}"]`).waitFor({ timeout: 120_000 });
    return await work(page);
  } finally {
    for (const end of ends.reverse()) {
      await end();
    }
  }
}

/** Runs a command of the editor by its title. */
export async function run(page, title) {
  await page.keyboard.press("F1");
  const typed = page.locator(".quick-input-widget input[type=text]");
  await typed.fill(`>${title}`);
  const first = page.locator(".quick-input-list .monaco-list-row").first();
  await first.filter({ hasText: title }).waitFor();
  await typed.press("Enter");
}

/** Returns the frame in which the motion is shown. */
export async function preview(page) {
  const outer = page.frameLocator("iframe.webview.ready");
  const inner = outer.frameLocator("iframe#active-frame");
  await inner.locator('html[data-state="ready"]').waitFor({ timeout: 120_000 });
  return inner;
}

async function serve(home, user, ends) {
  const own = { HOME: home, XDG_CONFIG_HOME: join(home, "config"), XDG_DATA_HOME: join(home, "data") };
  const environment = { ...process.env, ...own, EXTENSIONS_GALLERY: "{}" };
  const shared = ["--user-data-dir", user, "--extensions-dir", join(home, "extensions")];
  await promisify(execFile)(codeServer(), [...shared, "--install-extension", VSIX], { env: environment });
  const port = await freePort();
  const address = `http://127.0.0.1:${port}`;
  const quiet = ["--auth", "none", "--disable-telemetry", "--disable-update-check", "--disable-workspace-trust"];
  const server = spawn(codeServer(), [...shared, ...quiet, "--bind-addr", `127.0.0.1:${port}`], {
    env: environment,
    detached: true,
    stdio: ["ignore", "pipe", "ignore"],
  });
  ends.push(() => ended(server));
  await new Promise((resolve, reject) => {
    server.stdout.on("data", (said) => String(said).includes("HTTP server listening") && resolve());
    server.once("exit", (code) => reject(new Error(`code-server ended with ${code}`)));
  });
  return address;
}

async function ended(server) {
  if (server.exitCode === null) {
    const gone = once(server, "exit");
    process.kill(-server.pid, "SIGTERM");
    await gone;
  }
}

async function freePort() {
  const server = createServer().listen(0, "127.0.0.1");
  await once(server, "listening");
  const { port } = server.address();
  server.close();
  await once(server, "close");
  return port;
}

async function write(folder, files) {
  await mkdir(folder, { recursive: true });
  for (const [name, text] of Object.entries(files)) {
    await writeFile(join(folder, name), text);
  }
}

function codeServer() {
  return process.env.CODE_SERVER ?? onSearchPath("code-server");
}

function chromiumHere() {
  return process.env.CHROMIUM ?? onSearchPath("chromium") ?? onSearchPath("google-chrome");
}

function onSearchPath(name) {
  const places = (process.env.PATH ?? "").split(delimiter).map((folder) => join(folder, name));
  return places.find((place) => existsSync(place));
}
