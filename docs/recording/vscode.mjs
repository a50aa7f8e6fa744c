// Takes the picture of VS Code in docs/vscode.png: the packaged extension in code-server, driven in a Chromium.
//
//     make screenshot
//
// What is shown is what the editor showed. It needs code-server and Chromium: see "VS Code" in docs/editors.md.
import { DEMO, inVSCode, missing, preview, run } from "../../lsp/editors/vscode/test/vscode.mjs";

const SCRIPT = `# A stroll: she talks on her way, and waves.
let STROLL = WALK or SWING_HAND
Idle_01 for 2 sec
STROLL for 4 sec
WALK with Upper-Body TALK for 6 sec
IDLE with Left-Hand WAVE for 0 sec
Idle_01
`;
const SETTINGS = {
  "breadcrumbs.enabled": false,
  "editor.fontSize": 13,
  "editor.minimap.enabled": false,
  "workbench.activityBar.location": "hidden",
  "workbench.colorTheme": "Default Dark Modern",
  "workbench.secondarySideBar.defaultVisibility": "hidden",
};

const target = process.argv[2];
const lacking = target === undefined ? "expected the picture to write, such as docs/vscode.png" : missing();
if (lacking !== undefined) {
  console.error(lacking);
  process.exit(1);
}
await inVSCode({ files: { ...DEMO, "stroll.ms": SCRIPT }, open: "stroll.ms", settings: SETTINGS }, async (page) => {
  await page.locator(".codelens-decoration", { hasText: "candidates" }).first().waitFor({ timeout: 60_000 });
  await run(page, "View: Toggle Primary Side Bar Visibility");
  await run(page, "Motion Script: Preview the Motion");
  await stopAt(await preview(page), "TALK");
  await page.locator(".squiggly-warning").first().waitFor();
  await page.locator(".view-line").last().click();
  await page.keyboard.press("Control+End");
  await page.keyboard.press("ArrowUp");
  await page.keyboard.press("Home");
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("Control+Space");
  await page.locator(".suggest-widget .monaco-list-row").first().waitFor();
  await page.keyboard.press("Control+Space");
  await page.locator(".suggest-details-container").waitFor();
  await page.screenshot({ path: target });
});

/** Stops the figure two seconds after it has arrived in the command that has a word. */
async function stopAt(motion, word) {
  const page = motion.locator("body");
  await motion.locator('[data-do="play"]').evaluate((button) => button.click());
  const command = motion.locator("#labels .command", { hasText: word });
  await pressUntil(page, { key: "]" }, () => command.count());
  await pressUntil(page, { key: "ArrowRight", shiftKey: true }, () => command.and(motion.locator(":not(.coming)")).count());
  let left = 6;
  await pressUntil(page, { key: "ArrowRight", shiftKey: true }, () => left-- === 0);
}

/** Presses a key of the player until something is so, each time when what came of the last is drawn. */
async function pressUntil(page, key, isSo) {
  for (let n = 0; n < 100 && !(await isSo()); n += 1) {
    await page.evaluate((_, how) => {
      dispatchEvent(new KeyboardEvent("keydown", how));
      return new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn)));
    }, key);
  }
}
