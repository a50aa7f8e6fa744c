import assert from "node:assert/strict";
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { delimiter, dirname, join } from "node:path";
import { test } from "node:test";

import { type Machine, installation, locate, places, typed } from "../src/programs";

const windows = process.platform === "win32";
const executable = windows ? "mlmg.exe" : "mlmg";

type Put = (...path: string[]) => string;

function inFolder(what: (folder: string, machine: Machine, put: Put) => Promise<void>): Promise<void> {
  const folder = mkdtempSync(join(tmpdir(), "programs-"));
  const put: Put = (...path) => {
    const file = join(folder, ...path);
    mkdirSync(dirname(file), { recursive: true });
    writeFileSync(file, "", { mode: 0o755 });
    return file;
  };
  const searchPath = [join(folder, "one"), join(folder, "two")].join(delimiter);
  const machine = { windows, home: join(folder, "home"), searchPath };
  return what(folder, machine, put).finally(() => rmSync(folder, { recursive: true }));
}

test("a name alone is looked for in the folder's environment first", () =>
  inFolder(async (folder, machine, put) => {
    put("two", executable);
    const own = put("project", ".venv", windows ? "Scripts" : "bin", executable);
    assert.equal(await locate("mlmg", [join(folder, "project")], machine), own);
  }));

test("then on the search path, in its order, and last where pip puts programs of one person", () =>
  inFolder(async (folder, machine, put) => {
    const last = put("home", ".local", "bin", executable);
    assert.equal(await locate("mlmg", [folder], machine), last);
    const second = put("two", executable);
    assert.equal(await locate("mlmg", [folder], machine), second);
    const first = put("one", executable);
    assert.equal(await locate("mlmg", [folder], machine), first);
  }));

test("a path is taken as it is, from the folder or the home", () =>
  inFolder(async (folder, machine, put) => {
    const tool = put("tools", executable);
    put("one", executable);
    assert.equal(await locate(tool, [], machine), tool);
    assert.equal(await locate(`./tools/${executable}`, [folder], machine), tool);
    assert.equal(await locate(`~/tools/${executable}`, [], { ...machine, home: folder }), tool.replaceAll("\\", "/"));
    assert.equal(await locate(join(folder, "nowhere", executable), [folder], machine), undefined);
  }));

test("what cannot be executed is no program", { skip: windows }, () =>
  inFolder(async (folder, machine) => {
    mkdirSync(join(folder, "one"));
    mkdirSync(join(folder, "two", "mlmg"), { recursive: true });
    writeFileSync(join(folder, "one", "mlmg"), "", { mode: 0o644 });
    assert.equal(await locate("mlmg", [], machine), undefined);
  }));

test("on Windows programs end in .exe, and environments have Scripts", () => {
  const machine = { windows: true, home: "home", searchPath: "tools" };
  const found = places("mlmg", ["project"], machine).map((place) => place.replaceAll("\\", "/"));
  assert.deepEqual(found, [
    "project/.venv/Scripts/mlmg.exe",
    "project/venv/Scripts/mlmg.exe",
    "tools/mlmg.exe",
    "home/.local/bin/mlmg.exe",
  ]);
});

test("mlmg is installed by two commands that one could type", () => {
  const machine = { windows: false, home: "/home/me", searchPath: "" };
  assert.deepEqual(installation("/home/me/my clips", "/x/mlmg-0.1.0.whl", machine).map(typed), [
    'python3 -m venv "/home/me/my clips/.venv"',
    '"/home/me/my clips/.venv/bin/python" -m pip install --upgrade /x/mlmg-0.1.0.whl',
  ]);
});
