// One `mlmg lsp` for the window: found, started, watched, and asked to execute commands.
import * as vscode from "vscode";
import {
  CloseAction,
  type CloseHandlerResult,
  ErrorAction,
  type ErrorHandler,
  type ErrorHandlerResult,
  LanguageClient,
  RevealOutputChannelOn,
  type ShowDocumentParams,
  State,
  type StaticFeature,
} from "vscode-languageclient/node";

import { Endings } from "./endings";
import { type Machine, locate } from "./programs";
import { LANGUAGE, type Settings, settings } from "./settings";

const OPEN_SETTING = { title: "Open the setting", command: "workbench.action.openSettings", arguments: ["mlmg.path"] };
const INSTALL = { title: "Install mlmg", command: "motionScript.install" };
const RESTART = { title: "Restart", command: "motionScript.restart" };
const SHOW_LOG = { title: "Show the log", command: "motionScript.log" };
const TRUST = { title: "Manage trust", command: "workbench.trust.manage" };

/** Leaves it to us to say, once, what has failed for good; all else is only written into the log. */
class Client extends LanguageClient {
  failed: () => void = () => undefined;

  override error(message: string, data?: unknown, shown?: boolean | "force"): void {
    super.error(message, data, false);
    if (shown === "force") {
      this.failed();
    }
  }
}

/** Tells the server that its messages can have buttons: here they keep nobody from writing on. */
const OFFERS: StaticFeature = {
  fillClientCapabilities: (capabilities) => {
    capabilities.experimental = { offers: true };
  },
  initialize: () => undefined,
  getState: () => ({ kind: "static" }),
  clear: () => undefined,
};

/** Starts again a server that has ended, unless it ends too often. What cannot be written to it, it has ended already. */
class Again implements ErrorHandler {
  private readonly endings = new Endings();

  error(): ErrorHandlerResult {
    return { action: ErrorAction.Continue, handled: true };
  }

  closed(): CloseHandlerResult {
    return this.endings.isTooMuch(Date.now())
      ? { action: CloseAction.DoNotRestart, message: "it has ended again and again." }
      : { action: CloseAction.Restart, handled: true };
  }
}

export class Server {
  private client: Client | undefined;
  private found: string | undefined;
  private missing: (() => void) | undefined;
  private turn: Promise<void> = Promise.resolve();

  constructor(
    private readonly log: vscode.OutputChannel,
    private readonly status: vscode.LanguageStatusItem,
    private readonly machine: Machine,
  ) {}

  /** Where `mlmg` is; undefined while no server runs. */
  get program(): string | undefined {
    return this.client?.state === State.Running ? this.found : undefined;
  }

  /** Starts the server anew, once what was begun before has ended. */
  restart(): Promise<void> {
    return this.next(() => this.startAnew());
  }

  stop(): Promise<void> {
    return this.next(() => this.end());
  }

  /** Returns what comes of a command of the server; undefined if nothing does, and it has been said why. */
  async ask(command: string, about: object): Promise<object | undefined> {
    if (this.client === undefined || this.program === undefined) {
      this.missing?.();
      return undefined;
    }
    try {
      return (await this.client.sendRequest("workspace/executeCommand", { command, arguments: [about] })) ?? undefined;
    } catch (error) {
      void vscode.window.showErrorMessage(error instanceof Error ? error.message : String(error));
      return undefined;
    }
  }

  private next(work: () => Promise<void>): Promise<void> {
    this.turn = this.turn.then(work).catch((error) => this.log.appendLine(String(error)));
    return this.turn;
  }

  private async startAnew(): Promise<void> {
    await this.end();
    if (!vscode.workspace.isTrusted) {
      const what = "No server is started before the folder is trusted.";
      this.needs(vscode.LanguageStatusSeverity.Warning, what, [TRUST]);
      return;
    }
    const said = settings();
    const folders = (vscode.workspace.workspaceFolders ?? []).map((folder) => folder.uri.fsPath);
    this.found = await locate(said.path, folders, this.machine);
    if (this.found !== undefined) {
      await this.start(this.found, said);
    } else if (said.path === "mlmg") {
      const what = "mlmg is neither in the folder's .venv nor on the search path: scripts are only coloured.";
      this.lacks(what, INSTALL, OPEN_SETTING);
    } else {
      this.lacks(`There is no program ${said.path}, as mlmg.path says: scripts are only coloured.`, OPEN_SETTING);
    }
  }

  private async start(program: string, said: Settings): Promise<void> {
    const client = this.clientOf(program, said);
    client.registerFeature(OFFERS);
    client.failed = () => {
      if (this.client === client) {
        this.lacks(`${program} lsp could not be started, or ends again and again; the log says why.`, SHOW_LOG, RESTART);
      }
    };
    client.onDidChangeState(({ newState }) => {
      if (this.client === client && newState !== State.Stopped) {
        this.tell(newState);
      }
    });
    this.client = client;
    // What goes wrong is told by `failed`.
    await client.start().catch(() => undefined);
  }

  private clientOf(program: string, said: Settings): Client {
    const watched = vscode.workspace.createFileSystemWatcher("**/{*.ms,*.mlmg,library.toml,mlmg.toml}");
    const command = { command: program, args: ["lsp", "--stdio"] };
    return new Client("mlmg", "Motion Script", command, {
      documentSelector: [{ language: LANGUAGE }],
      initializationOptions: { ...said, library: said.library || undefined },
      errorHandler: new Again(),
      initializationFailedHandler: () => false,
      outputChannel: this.log,
      revealOutputChannelOn: RevealOutputChannelOn.Never,
      synchronize: { configurationSection: "mlmg", fileEvents: watched },
      middleware: { window: { showDocument: beside } },
    });
  }

  private async end(): Promise<void> {
    const client = this.client;
    this.client = this.found = this.missing = undefined;
    await client?.dispose().catch((error: unknown) => this.log.appendLine(String(error)));
  }

  private tell(state: State): void {
    const running = state === State.Running;
    this.missing = running ? undefined : this.missing;
    this.status.busy = !running;
    this.status.severity = vscode.LanguageStatusSeverity.Information;
    const version = this.client?.initializeResult?.serverInfo?.version ?? "";
    this.status.text = running ? `mlmg ${version}` : "mlmg is starting";
    this.status.detail = this.found;
    this.status.command = RESTART;
    void vscode.commands.executeCommand("setContext", "motionScript.running", running);
  }

  /** Says what is missing, and what one can do; again whenever a command needs it. */
  private lacks(what: string, ...ways: vscode.Command[]): void {
    const again = this.missing !== undefined;
    this.needs(vscode.LanguageStatusSeverity.Error, what, ways);
    if (!again) {
      this.missing?.();
    }
  }

  private needs(severity: vscode.LanguageStatusSeverity, what: string, ways: readonly vscode.Command[]): void {
    this.log.appendLine(what);
    this.status.busy = false;
    this.status.severity = severity;
    this.status.text = what;
    this.status.detail = undefined;
    this.status.command = ways[0];
    this.missing = () => void offer(what, ways);
    void vscode.commands.executeCommand("setContext", "motionScript.running", false);
  }
}

async function offer(what: string, ways: readonly vscode.Command[]): Promise<void> {
  const title = await vscode.window.showErrorMessage(what, ...ways.map((way) => way.title));
  const way = ways.find((one) => one.title === title);
  if (way !== undefined) {
    await vscode.commands.executeCommand(way.command, ...(way.arguments ?? []));
  }
}

/** Shows what the server has to say of a script beside it; one goes on writing. */
async function beside(params: ShowDocumentParams): Promise<{ success: boolean }> {
  try {
    const options = { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true, preview: true };
    await vscode.window.showTextDocument(vscode.Uri.parse(params.uri), options);
    return { success: true };
  } catch {
    return { success: false };
  }
}
