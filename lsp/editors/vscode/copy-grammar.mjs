// The editor's grammar is made from the language's; what is copied at each build cannot drift from it.
import { copyFileSync, mkdirSync } from "node:fs";

const root = new URL("../../../", import.meta.url);
const here = new URL("./", import.meta.url);
mkdirSync(new URL("syntaxes/", here), { recursive: true });
for (const [from, to] of [
  ["grammar/mlmg_grammar/motion_script.tmLanguage.json", "syntaxes/motion-script.tmLanguage.json"],
  ["grammar/mlmg_grammar/motion_script.language-configuration.json", "syntaxes/language-configuration.json"],
  ["LICENSE", "LICENSE"],
]) {
  copyFileSync(new URL(from, root), new URL(to, here));
}
