import * as vscode from "vscode";

export const LANGUAGE = "motion-script";

export interface Settings {
  readonly path: string;
  readonly library: string;
  readonly allowUse: readonly string[];
  readonly inlayHints: Readonly<Record<string, boolean>>;
}

export function settings(): Settings {
  const kept = vscode.workspace.getConfiguration("mlmg");
  return {
    path: kept.get<string>("path") || "mlmg",
    library: kept.get<string>("library") ?? "",
    allowUse: kept.get<string[]>("allowUse") ?? [],
    inlayHints: {
      motions: kept.get<boolean>("inlayHints.motions") ?? true,
      arrivals: kept.get<boolean>("inlayHints.arrivals") ?? true,
      units: kept.get<boolean>("inlayHints.units") ?? true,
      parameters: kept.get<boolean>("inlayHints.parameters") ?? true,
    },
  };
}
