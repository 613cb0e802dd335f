// SPDX-License-Identifier: GPL-3.0-or-later
//
// OpenUSD's WebAssembly build is made for browsers. These three are all that it needs of one, in the program and
// in each of its threads: load this file with `node --require`.
const fs = require('fs');
const path = require('path');
const folder = path.resolve(__dirname, 'node_modules/three-usdz-loader/external');

const read = (address) => fs.readFileSync(path.join(folder, path.basename(String(address))));
globalThis.location = { pathname: folder + '/' };
globalThis.fetch = async (address) => new Response(read(address), { headers: { 'content-type': 'application/wasm' } });
globalThis.XMLHttpRequest = class {
  open(method, address) { this.address = address; }
  send() {
    const bytes = read(this.address);
    this.status = 200;
    this.response = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
    queueMicrotask(() => this.onload({}));
  }
};
