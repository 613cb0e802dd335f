// SPDX-License-Identifier: MIT
// Bundles the page into one file: node build.mjs OUTPUT. Equal sources give equal bytes.

import { createHash } from "node:crypto";
import { readFileSync, writeFileSync } from "node:fs";
import { build } from "esbuild";

const kDataMarker = "<!-- ARRIS-DATA -->";
const here = (path) => new URL(path, import.meta.url);
const read = (path) => readFileSync(here(path), "utf8");
const hash = (text) => `sha256-${createHash("sha256").update(text).digest("base64")}`;

async function bundle(entry, options) {
  const result = await build({
    entryPoints: [here(entry).pathname], absWorkingDir: here(".").pathname, bundle: true, minify: true, write: false,
    target: ["chrome103", "firefox113", "safari16.4"], legalComments: "inline", ...options,
  });
  return result.outputFiles[0].text.trim();
}

function require(condition, what) {
  if (!condition) throw new Error(what);
}

const licences = `/*! The viewer of Arris. SPDX-License-Identifier: MIT\n\n${read("LICENSE").trim()}\n\n` +
                 `It contains three.js:\n\n${read("node_modules/three/LICENSE").trim()}\n*/`;
const script = `${licences}\n${await bundle("src/main.js", { format: "iife" })}`;
const style = await bundle("src/style.css", {});
require(!/<\/script|<!--/i.test(script), "the bundle holds what would end its script element");

const parts = { SCRIPT_HASH: hash(script), STYLE_HASH: hash(style), STYLE: style, SCRIPT: script };
const page = read("index.html").replace(/%([A-Z_]+)%/g, (whole, name) => parts[name] ?? whole);
require(page.split(kDataMarker).length === 2, "the page must hold the data marker once");
writeFileSync(process.argv[2], page);
