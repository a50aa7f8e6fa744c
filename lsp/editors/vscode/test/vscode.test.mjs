// `npm run test:vscode`: what one sees and does, in a real VS Code. Needs code-server and Chromium; see docs/editors.md.
import assert from "node:assert/strict";
import { test } from "node:test";

import { inVSCode, missing, preview, run } from "./vscode.mjs";

const script = "# Somebody walks and talks.\nIdle_01 for 2 sec\nWALK with Uper-Body TALK for 6 sec\n";

test("a mistake is underlined, told and mended, names are offered, and the motion is shown", { skip: missing() }, () =>
  inVSCode({ files: { "stroll.ms": script }, open: "stroll.ms" }, async (page) => {
    await page.locator(".squiggly-error").first().waitFor({ timeout: 60_000 });
    const wrong = page.locator(".view-line span", { hasText: /^Uper-Body$/ }).last();
    await wrong.hover();
    await page.locator(".monaco-hover", { hasText: "no graph `Uper-Body`" }).waitFor();
    await wrong.click();
    await page.keyboard.press("Control+.");
    await page.locator(".action-widget", { hasText: "Write `Upper-Body`" }).waitFor();
    await page.keyboard.press("Enter");
    await page.locator(".squiggly-error").first().waitFor({ state: "detached" });
    await page.locator(".codelens-decoration", { hasText: "candidates" }).first().waitFor();

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
