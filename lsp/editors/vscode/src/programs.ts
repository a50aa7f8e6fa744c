// Where `mlmg` is, and what installs it. Knows nothing of the editor.
import { access, constants, stat } from "node:fs/promises";
import { delimiter, isAbsolute, join, resolve } from "node:path";

export interface Machine {
  readonly windows: boolean;
  readonly home: string;
  readonly searchPath: string;
}

export interface Step {
  readonly title: string;
  readonly program: string;
  readonly options: readonly string[];
}

/** Returns where a program is, by what the setting says; undefined if it is in none of the places. */
export async function locate(said: string, folders: readonly string[], machine: Machine): Promise<string | undefined> {
  for (const place of places(said, folders, machine)) {
    if (await isProgram(place)) {
      return place;
    }
  }
  return undefined;
}

/** Returns where a program may be: a name alone is looked for in the folders' environments before the search path. */
export function places(said: string, folders: readonly string[], machine: Machine): string[] {
  const program = said.replace(/^~(?=[\\/])/, machine.home);
  if (/[\\/]/.test(program)) {
    return isAbsolute(program) ? [program] : folders.map((folder) => resolve(folder, program));
  }
  const kept = folders.flatMap((folder) => [join(folder, ".venv"), join(folder, "venv")]);
  const environments = kept.map((environment) => inEnvironment(environment, "", machine));
  // An editor that was started from a desktop often lacks the last, where pip and pipx put programs of one person.
  const searched = [...machine.searchPath.split(delimiter).filter(Boolean), join(machine.home, ".local", "bin")];
  const name = machine.windows && !/\.exe$/i.test(program) ? `${program}.exe` : program;
  return [...environments, ...searched].map((folder) => join(folder, name));
}

/** Returns what installs mlmg from a wheel into the environment `.venv` of a folder, one after the other. */
export function installation(folder: string, wheel: string, machine: Machine): Step[] {
  const environment = join(folder, ".venv");
  return [
    { title: "Make .venv", program: machine.windows ? "py" : "python3", options: ["-m", "venv", environment] },
    {
      title: "Install mlmg",
      program: inEnvironment(environment, "python", machine),
      options: ["-m", "pip", "install", "--upgrade", wheel],
    },
  ];
}

/** Returns a step as one types it. */
export function typed(step: Step): string {
  return [step.program, ...step.options].map((word) => (/[^\w./:\\=+-]/.test(word) ? `"${word}"` : word)).join(" ");
}

function inEnvironment(environment: string, program: string, machine: Machine): string {
  return join(environment, machine.windows ? "Scripts" : "bin", program);
}

async function isProgram(path: string): Promise<boolean> {
  try {
    await access(path, constants.X_OK);
    return (await stat(path)).isFile();
  } catch {
    return false;
  }
}
