// `npm run test:vscode`: what one sees and does, in a real VS Code. Needs code-server and Chromium; see docs/editors.md.
import assert from "node:assert/strict";
import { test } from "node:test";

import { DEMO, inVSCode, missing, preview, run } from "./vscode.mjs";

const lens = ".codelens-decoration";
const script = "# Somebody walks and talks.\nIdle_01 for 2 sec\nWALK with Uper-Body TALK for 6 sec\n";

test("a mistake is underlined, told and mended, names are offered, and the motion is shown", { skip: missing() }, () =>
  inVSCode({ files: { ...DEMO, "stroll.ms": script }, open: "stroll.ms" }, async (page) => {
    await page.locator(".squiggly-error").first().waitFor({ timeout: 60_000 });
    const wrong = page.locator(".view-line span", { hasText: /^Uper-Body$/ }).last();
    await wrong.hover();
    await page.locator(".monaco-hover", { hasText: "no graph `Uper-Body`" }).waitFor();
    await wrong.click();
    await page.keyboard.press("Control+.");
    await page.locator(".action-widget", { hasText: "Write `Upper-Body`" }).waitFor();
    await page.keyboard.press("Enter");
    await page.locator(".squiggly-error").first().waitFor({ state: "detached" });
    await page.locator(lens, { hasText: "candidates" }).first().waitFor();

    await page.keyboard.press("Control+End");
    await page.keyboard.type("WALK with Upper-Body ");
    await page.keyboard.press("Control+Space");
    await page.locator(".suggest-widget .monaco-list-row", { hasText: "TALK" }).first().waitFor();
    await page.keyboard.type("TALK");
    await page.keyboard.press("Escape");

    await run(page, "Motion Script: Preview the Motion");
    const shown = await preview(page);
    assert.match(await shown.locator("body").innerText(), /Full-Body/);
  }),
);

test("a script without a library is offered the demo library, which is used at once", { skip: missing() }, () =>
  inVSCode({ files: { "stroll.ms": "WALK for 6 sec\n" }, open: "stroll.ms" }, async (page) => {
    await page.locator(".notification-toast").getByText("Use the demo library").click({ timeout: 60_000 });
    await page.locator(lens, { hasText: "3 candidates on Full-Body" }).waitFor({ timeout: 60_000 });
  }),
);

test("where there is no mlmg it is said, and one button leads to the setting", { skip: missing() }, () =>
  inVSCode({ files: { "stroll.ms": "WALK\n" }, open: "stroll.ms", mlmg: "/nowhere/mlmg" }, async (page) => {
    const said = page.locator(".notification-toast", { hasText: "There is no program /nowhere/mlmg" });
    await said.getByText("Open the setting").click({ timeout: 60_000 });
    await page.locator(".settings-editor", { hasText: "Path" }).waitFor();
  }),
);
