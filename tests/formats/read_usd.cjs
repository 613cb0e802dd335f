// SPDX-License-Identifier: GPL-3.0-or-later
//
// Writes, as JSON, points, triangles and UVs of each mesh of a USD stage at each time code, as OpenUSD gives
// them to a renderer. The file is named by ARRIS_OUTPUT, since OpenUSD prints on both streams.
// usage: node --require ./browser_shim.cjs read_usd.cjs STAGE TIME...
const fs = require('fs');
const path = require('path');
const bindings = path.resolve(__dirname, 'node_modules/three-usdz-loader/external/emHdBindings.js');

function loadUsd() {
  const module = { exports: {} };
  const source = fs.readFileSync(bindings, 'utf8') + '\nmodule.exports = getUsdModule;';
  new Function('module', 'exports', 'require', '__filename', '__dirname', source)(
    module, module.exports, require, bindings, path.dirname(bindings));
  return module.exports({}, undefined, undefined);
}

// Calls of the renderer that the test does not need.
const ignored = () => new Proxy({}, { get: (_, key) => (key === 'then' ? undefined : () => {}) });

class Renderer {
  constructor() { this.meshes = {}; }
  createRPrim(type, path) {
    const mesh = (this.meshes[path] = {});
    return {
      updateIndices(indices) { mesh.faces = Array.from(indices); },
      updatePoints(points) { mesh.points = Array.from(points); },
      setTransform(matrix) { mesh.transform = Array.from(matrix); },
      updatePrimvar(name, data) { if (name === 'st') mesh.st = Array.from(data); },
      updateNormals() {}, setMaterial() {}, commit() {},
    };
  }
  createBPrim() { return ignored(); }
  createSPrim() { return ignored(); }
  CommitResources() {}
}

async function main(stage, times) {
  const usd = await loadUsd();
  await usd.ready;
  usd.FS.createDataFile('/', 'stage.usda', new Uint8Array(fs.readFileSync(stage)), true, true, true);
  const renderer = new Renderer();
  const driver = new usd.HdWebSyncDriver(renderer, 'stage.usda');
  driver.Draw();
  const read = {};
  for (const time of times) {
    driver.SetTime(Number(time));
    driver.Draw();
    read[time] = structuredClone(renderer.meshes);
  }
  fs.writeFileSync(process.env.ARRIS_OUTPUT, JSON.stringify(read));
  process.exit(0);  // the threads of OpenUSD do not end by themselves
}

main(process.argv[2], process.argv.slice(3)).catch((error) => {
  console.error(error);
  process.exit(1);
});
