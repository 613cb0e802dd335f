// SPDX-License-Identifier: GPL-3.0-or-later
//
// Prints, as JSON, the objects of OBJ files as three.js reads them: name, type, corners of cells.
// usage: node read_obj.mjs FILE...
import fs from 'node:fs';
import { OBJLoader } from 'three/examples/jsm/loaders/OBJLoader.js';

const read = (file) =>
  new OBJLoader().parse(fs.readFileSync(file, 'utf8')).children.map((object) => ({
    name: object.name,
    type: object.type,
    corners: Array.from(object.geometry.attributes.position.array),
    uv: Array.from(object.geometry.attributes.uv?.array ?? []),
  }));
console.log(JSON.stringify(process.argv.slice(2).map(read)));
