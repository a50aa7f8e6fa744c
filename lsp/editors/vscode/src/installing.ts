// Installs mlmg as one would by hand, in a terminal that shows each step and what comes of it.
import { readdir } from "node:fs/promises";
import { dirname, join } from "node:path";
import * as vscode from "vscode";

import { type Machine, type Step, installation, typed } from "./programs";

/** Returns the wheel that comes with the extension. */
async function wheelOf(extension: vscode.Uri): Promise<string | undefined> {
  const folder = join(extension.fsPath, "wheel");
  const names = await readdir(folder).catch(() => []);
  const name = names.find((one) => one.endsWith(".whl"));
  return name === undefined ? undefined : join(folder, name);
}

/** Installs mlmg into the environment `.venv` of the open folder; returns whether it is there now. */
export async function install(extension: vscode.Uri, machine: Machine, log: vscode.OutputChannel): Promise<boolean> {
  const [folder, wheel] = [folderOf(), await wheelOf(extension)];
  if (!vscode.workspace.isTrusted || folder === undefined || wheel === undefined) {
    const reason = wheel === undefined ? "this extension was built without it" : "open a folder that you trust first";
    void vscode.window.showInformationMessage(`mlmg cannot be installed from here: ${reason}.`);
    return false;
  }
  for (const step of installation(folder, wheel, machine)) {
    log.appendLine(`${folder}> ${typed(step)}`);
    if ((await done(step, folder)) !== 0) {
      void vscode.window.showErrorMessage(
        `\`${typed(step)}\` failed; its terminal says why. mlmg needs Python 3.11 or newer, with venv and pip.`,
      );
      return false;
    }
  }
  return true;
}

function folderOf(): string | undefined {
  const script = vscode.window.activeTextEditor?.document.uri;
  const inside = script && vscode.workspace.getWorkspaceFolder(script);
  const folder = inside ?? vscode.workspace.workspaceFolders?.[0];
  return folder?.uri.fsPath ?? (script?.scheme === "file" ? dirname(script.fsPath) : undefined);
}

/** Returns with what code a step ended; undefined if it could not begin. */
async function done(step: Step, folder: string): Promise<number | undefined> {
  const running = new vscode.ProcessExecution(step.program, [...step.options], { cwd: folder });
  const task = new vscode.Task({ type: "process" }, vscode.TaskScope.Workspace, step.title, "Motion Script", running);
  task.presentationOptions = { reveal: vscode.TaskRevealKind.Always, panel: vscode.TaskPanelKind.Shared };
  const watched: vscode.Disposable[] = [];
  try {
    return await new Promise<number | undefined>((resolve, reject) => {
      const isOurs = ({ execution }: { execution: vscode.TaskExecution }): boolean => execution.task.name === task.name;
      watched.push(vscode.tasks.onDidEndTaskProcess((ended) => isOurs(ended) && resolve(ended.exitCode)));
      watched.push(vscode.tasks.onDidEndTask((ended) => isOurs(ended) && setTimeout(() => resolve(undefined), 500)));
      vscode.tasks.executeTask(task).then(undefined, reject);
    });
  } finally {
    watched.forEach((one) => void one.dispose());
  }
}
