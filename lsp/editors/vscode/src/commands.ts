// Each command runs the same program as a terminal would, on the file as it is saved.
import { execFile } from "node:child_process";
import { mkdtemp, readFile, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import * as vscode from "vscode";

import { compiler, LANGUAGE, settings } from "./settings";

interface Script {
  readonly file: string;
  readonly folder: string;
  readonly path: string;
  readonly options: readonly string[];
}

interface Ran {
  readonly code: number;
  readonly output: string;
  readonly errors: string;
}

/** Plays a script into a BVH file that one chooses. */
export async function play(log: vscode.OutputChannel, target?: unknown): Promise<void> {
  const script = await saved(target);
  if (script === undefined) {
    return;
  }
  const proposed = vscode.Uri.file(script.file.replace(/\.ms$/, "") + ".bvh");
  const chosen = await vscode.window.showSaveDialog({ defaultUri: proposed, filters: { Motion: ["bvh"] } });
  if (chosen === undefined) {
    return;
  }
  const report = chosen.fsPath.replace(/\.bvh$/, "") + ".json";
  if (await performed(log, script, chosen.fsPath, report)) {
    const show = "Show in folder";
    if ((await vscode.window.showInformationMessage(`Written: ${chosen.fsPath}`, show)) === show) {
      await vscode.commands.executeCommand("revealFileInOS", chosen);
    }
  }
}

/** Plays a script and shows the motion beside it. */
export async function preview(log: vscode.OutputChannel, target?: unknown): Promise<void> {
  const script = await saved(target);
  if (script === undefined) {
    return;
  }
  const folder = await mkdtemp(join(tmpdir(), "motion-script-"));
  try {
    const [motion, report, page] = ["motion.bvh", "motion.json", "motion.html"].map((name) => join(folder, name));
    const view = ["view", motion, "--report", report, "-o", page];
    if ((await performed(log, script, motion, report)) && (await succeeded(log, script.path, view, script.folder))) {
      const panel = vscode.window.createWebviewPanel(
        "motionScript.preview",
        `Motion of ${script.file.split(/[\\/]/).pop()}`,
        { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true },
        { enableScripts: true, retainContextWhenHidden: true, localResourceRoots: [] },
      );
      panel.webview.html = await readFile(page, "utf8");
    }
  } finally {
    await rm(folder, { recursive: true, force: true });
  }
}

/** Opens what `mlmg explain` says of a script beside it. */
export async function explain(log: vscode.OutputChannel, target?: unknown): Promise<void> {
  const script = await saved(target);
  if (script === undefined) {
    return;
  }
  const ran = await run(script.path, ["explain", script.file, ...script.options], script.folder);
  if (ran.code !== 0) {
    await tell(log, ran);
    return;
  }
  const content = await vscode.workspace.openTextDocument({ content: ran.output, language: "plaintext" });
  await vscode.window.showTextDocument(content, { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true });
}

/** Returns the script that a command is about, saved; the one in the editor, unless a lens says which. */
async function saved(target: unknown): Promise<Script | undefined> {
  const uri = target instanceof vscode.Uri ? target : typeof target === "string" ? vscode.Uri.parse(target) : undefined;
  const open = vscode.window.activeTextEditor?.document;
  const document = uri === undefined ? open : await vscode.workspace.openTextDocument(uri);
  if (document === undefined || document.languageId !== LANGUAGE) {
    void vscode.window.showInformationMessage("Open a Motion Script first: a file that ends in .ms.");
    return undefined;
  }
  if (!vscode.workspace.isTrusted || !(await document.save()) || document.uri.scheme !== "file") {
    return undefined;
  }
  const { path, library, allowUse } = settings(document.uri);
  const root = vscode.workspace.getWorkspaceFolder(document.uri)?.uri.fsPath ?? dirname(document.uri.fsPath);
  const uses = allowUse.flatMap((folder) => ["--allow-use", folder]);
  return {
    file: document.uri.fsPath,
    folder: root,
    path,
    options: [...(library ? ["--library", library] : []), ...uses],
  };
}

async function performed(log: vscode.OutputChannel, script: Script, motion: string, report: string): Promise<boolean> {
  const options = [script.file, "-o", motion, "--report", report, ...script.options];
  return succeeded(log, compiler(script.path), options, script.folder);
}

async function succeeded(log: vscode.OutputChannel, path: string, options: string[], folder: string): Promise<boolean> {
  const running = { location: vscode.ProgressLocation.Window, title: "Motion Script is playing" };
  const ran = await vscode.window.withProgress(running, () => run(path, options, folder));
  if (ran.code !== 0) {
    await tell(log, ran);
  }
  return ran.code === 0;
}

function run(path: string, options: readonly string[], folder: string): Promise<Ran> {
  return new Promise((resolve) => {
    const limits = { cwd: folder, maxBuffer: 1 << 28, env: { ...process.env, NO_COLOR: "1" } };
    execFile(path, options, limits, (error, output, errors) => {
      const code = error === null ? 0 : typeof error.code === "number" ? error.code : 127;
      resolve({ code, output, errors: errors || (error === null ? "" : error.message) });
    });
  });
}

async function tell(log: vscode.OutputChannel, ran: Ran): Promise<void> {
  log.appendLine(ran.errors);
  const show = "Show all";
  const first = ran.errors.split("\n", 1)[0] || `it ended with ${ran.code}`;
  if ((await vscode.window.showErrorMessage(first, show)) === show) {
    log.show(true);
  }
}
