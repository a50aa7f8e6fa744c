import assert from "node:assert/strict";
import { test } from "node:test";

import { Endings } from "../src/endings";

const MINUTE = 60_000;

test("a server that ends may start again four times within three minutes", () => {
  const endings = new Endings();
  assert.deepEqual([0, 1, 2, 3, 4].map((time) => endings.isTooMuch(time)), [false, false, false, false, true]);
});

test("one that ends now and then may always start again", () => {
  const endings = new Endings();
  assert.ok([0, 1, 2, 3, 4, 5, 6, 7].every((time) => !endings.isTooMuch(time * MINUTE)));
});
