// What one can do with a script; the server does it, with the text as it stands in the editor.
import { execFile } from "node:child_process";
import { mkdtemp, readFile, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import * as vscode from "vscode";

import type { Server } from "./server";
import { LANGUAGE } from "./settings";

const FIRST_SCRIPT = "Idle_01\nWALK for 5 sec\nWALK with Upper-Body TALK for 6 sec\nIdle_01\n";

/** Plays the script in the editor into a BVH file: beside it, or where one says if it is no file yet. */
export async function play(server: Server): Promise<void> {
  const script = scriptInEditor();
  if (script === undefined) {
    return;
  }
  const isFile = script.uri.scheme === "file";
  const to = isFile ? undefined : await vscode.window.showSaveDialog({ filters: { Motion: ["bvh"] } });
  if (isFile || to !== undefined) {
    await server.ask("mlmg.play", { uri: String(script.uri), ...(to ? { to: String(to) } : {}) });
  }
}

/** Shows what will be played, and why, beside the script in the editor. */
export async function explain(server: Server): Promise<void> {
  const script = scriptInEditor();
  if (script !== undefined) {
    await server.ask("mlmg.explain", { uri: String(script.uri) });
  }
}

/** Opens a script to begin with. */
export async function newScript(): Promise<void> {
  const script = await vscode.workspace.openTextDocument({ language: LANGUAGE, content: FIRST_SCRIPT });
  await vscode.window.showTextDocument(script);
}

/** The moving figures beside scripts, one for each. */
export class Previews {
  private readonly panels = new Map<string, vscode.WebviewPanel>();

  constructor(
    private readonly server: Server,
    private readonly log: vscode.OutputChannel,
  ) {}

  /** Plays the script in the editor, and shows the motion beside it. */
  async show(): Promise<void> {
    const script = scriptInEditor();
    const page = script && (await this.played(script));
    if (script !== undefined && page !== undefined) {
      this.panelOf(script).webview.html = page;
    }
  }

  /** Shows the motion of what has been saved, where it is shown already. */
  async renew(script: vscode.TextDocument): Promise<void> {
    if (this.panels.has(String(script.uri)) && this.server.program !== undefined && !isWrong(script)) {
      const page = await this.played(script);
      const panel = this.panels.get(String(script.uri));
      if (page !== undefined && panel !== undefined) {
        panel.webview.html = page;
      }
    }
  }

  private async played(script: vscode.TextDocument): Promise<string | undefined> {
    const folder = await mkdtemp(join(tmpdir(), "motion-script-"));
    try {
      const path = join(folder, nameOf(script));
      const [motion, report, page] = [`${path}.bvh`, `${path}.json`, `${path}.html`];
      const to = { to: String(vscode.Uri.file(motion)), report: String(vscode.Uri.file(report)), shown: false };
      const done = await this.server.ask("mlmg.play", { uri: String(script.uri), ...to });
      const program = this.server.program;
      const view = ["view", motion, "--report", report, "-o", page];
      return done && program && (await this.ran(program, view)) ? await pageFrom(page) : undefined;
    } finally {
      await rm(folder, { recursive: true, force: true });
    }
  }

  private ran(program: string, options: readonly string[]): Promise<boolean> {
    return new Promise((resolve) => {
      execFile(program, options, { env: { ...process.env, NO_COLOR: "1" } }, (error, _output, errors) => {
        if (error !== null) {
          this.log.appendLine(errors || error.message);
          void vscode.window.showErrorMessage((errors || error.message).split("\n", 1)[0] ?? "");
        }
        resolve(error === null);
      });
    });
  }

  private panelOf(script: vscode.TextDocument): vscode.WebviewPanel {
    const key = String(script.uri);
    const known = this.panels.get(key);
    if (known !== undefined) {
      known.reveal(undefined, true);
      return known;
    }
    const at = { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true };
    const how = { enableScripts: true, retainContextWhenHidden: true, localResourceRoots: [] };
    const panel = vscode.window.createWebviewPanel("motionScript.preview", `Motion of ${nameOf(script)}`, at, how);
    panel.onDidDispose(() => this.panels.delete(key));
    this.panels.set(key, panel);
    return panel;
  }
}

function scriptInEditor(): vscode.TextDocument | undefined {
  const script = vscode.window.activeTextEditor?.document;
  if (script?.languageId === LANGUAGE) {
    return script;
  }
  void vscode.window.showInformationMessage("Open a Motion Script first: a file that ends in .ms.");
  return undefined;
}

function isWrong(script: vscode.TextDocument): boolean {
  const found = vscode.languages.getDiagnostics(script.uri);
  return found.some((one) => one.severity === vscode.DiagnosticSeverity.Error);
}

function nameOf(script: vscode.TextDocument): string {
  return basename(script.uri.path).replace(/\.ms$/, "");
}

/** The player fills the panel; editors put a margin around pages. */
async function pageFrom(path: string): Promise<string> {
  return (await readFile(path, "utf8")).replace("</head>", "<style>body { padding: 0 }</style></head>");
}
