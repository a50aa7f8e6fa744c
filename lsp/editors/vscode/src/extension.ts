// The client of `mlmg lsp`, and the commands that play, show and explain a script.
import { homedir } from "node:os";
import * as vscode from "vscode";

import { Previews, explain, newScript, play } from "./commands";
import { install } from "./installing";
import type { Machine } from "./programs";
import { Server } from "./server";
import { LANGUAGE } from "./settings";

let stop: () => Promise<void> = () => Promise.resolve();

export async function activate(context: vscode.ExtensionContext): Promise<void> {
  const log = vscode.window.createOutputChannel("Motion Script");
  const status = vscode.languages.createLanguageStatusItem("motionScript.server", { language: LANGUAGE });
  status.name = "Motion Script";
  const machine = machineHere();
  const server = new Server(log, status, machine);
  const previews = new Previews(server, log);
  stop = () => server.stop();
  const register = (name: string, run: () => unknown): vscode.Disposable =>
    vscode.commands.registerCommand(`motionScript.${name}`, run);
  context.subscriptions.push(
    log,
    status,
    register("play", () => play(server)),
    register("preview", () => previews.show()),
    register("explain", () => explain(server)),
    register("new", () => newScript()),
    register("restart", () => server.restart()),
    register("log", () => log.show(true)),
    register("install", async () => (await install(context.extensionUri, machine, log)) && (await server.restart())),
    vscode.workspace.onDidSaveTextDocument((script) => previews.renew(script)),
    vscode.workspace.onDidGrantWorkspaceTrust(() => server.restart()),
    vscode.workspace.onDidChangeConfiguration((change) => change.affectsConfiguration("mlmg.path") && server.restart()),
  );
  await server.restart();
}

export async function deactivate(): Promise<void> {
  await stop();
}

function machineHere(): Machine {
  return { windows: process.platform === "win32", home: homedir(), searchPath: process.env["PATH"] ?? "" };
}
