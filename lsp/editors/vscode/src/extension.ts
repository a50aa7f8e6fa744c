// The client of `mlmg lsp`, and the commands that play, show and explain a script.
import * as vscode from "vscode";
import { LanguageClient } from "vscode-languageclient/node";

import { explain, play, preview } from "./commands";
import { LANGUAGE, settings } from "./settings";

let client: LanguageClient | undefined;

export async function activate(context: vscode.ExtensionContext): Promise<void> {
  const output = vscode.window.createOutputChannel("Motion Script");
  const register = (name: string, run: (target?: unknown) => Promise<void>): vscode.Disposable =>
    vscode.commands.registerCommand(`motionScript.${name}`, run);
  context.subscriptions.push(
    output,
    register("play", (target) => play(output, target)),
    register("preview", (target) => preview(output, target)),
    register("explain", (target) => explain(output, target)),
    register("restart", () => restart(output)),
    vscode.workspace.onDidGrantWorkspaceTrust(() => restart(output)),
    vscode.workspace.onDidChangeConfiguration(async (change) => {
      if (change.affectsConfiguration("mlmg.path")) {
        await restart(output);
      }
    }),
  );
  await restart(output);
}

export async function deactivate(): Promise<void> {
  await client?.dispose();
  client = undefined;
}

async function restart(output: vscode.OutputChannel): Promise<void> {
  await deactivate();
  if (!vscode.workspace.isTrusted) {
    return;
  }
  const { path, library, allowUse, inlayHints } = settings();
  const fresh = new LanguageClient(
    "mlmg",
    "Motion Script",
    { command: path, args: ["lsp", "--stdio"] },
    {
      documentSelector: [{ language: LANGUAGE }],
      initializationOptions: { ...(library ? { library } : {}), allowUse, inlayHints },
      outputChannel: output,
      synchronize: {
        configurationSection: "mlmg",
        fileEvents: vscode.workspace.createFileSystemWatcher("**/{*.ms,*.mlmg,library.toml,mlmg.toml}"),
      },
    },
  );
  client = fresh;
  try {
    await fresh.start();
  } catch (error) {
    output.appendLine(String(error));
    await offerSetting(path);
  }
}

async function offerSetting(path: string): Promise<void> {
  const open = "Open the setting";
  const message = `\`${path} lsp\` could not be started, so scripts are only coloured. Install mlmg, or set mlmg.path.`;
  if ((await vscode.window.showErrorMessage(message, open)) === open) {
    await vscode.commands.executeCommand("workbench.action.openSettings", "mlmg.path");
  }
}
