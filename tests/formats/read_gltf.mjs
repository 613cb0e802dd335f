// SPDX-License-Identifier: GPL-3.0-or-later
//
// Reads a .glb with three.js and prints, as JSON, what its animation shows at each time: world positions of the cloth's
// vertices, its faces and UVs, the world matrix (column-major) of every other node, and world positions of the vertices of
// every other mesh.
// usage: node read_gltf.mjs FILE TIME...
import { readFile } from "node:fs/promises";
import { AnimationMixer, Vector3 } from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";

globalThis.self = globalThis;
const [path, ...times] = process.argv.slice(2);
const bytes = await readFile(path);
const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
const { scene, animations } = await new GLTFLoader().parseAsync(buffer, "");
const mixer = new AnimationMixer(scene);
for (const clip of animations) mixer.clipAction(clip).play();

function pointsOf(mesh) {
  const point = new Vector3();
  return Array.from({ length: mesh.geometry.attributes.position.count }, (_, v) =>
    mesh.getVertexPosition(v, point).applyMatrix4(mesh.matrixWorld).toArray());
}

const shown = {};
for (const time of times) {
  // At its end a clip starts again, so its last frame is read just before.
  const end = Math.max(0, ...animations.map((clip) => clip.duration));
  mixer.setTime(Math.min(Number(time), end * (1 - 1e-6)));
  scene.updateMatrixWorld(true);
  const cloth = scene.getObjectByName("cloth");
  const nodes = {}, meshes = {};
  scene.traverse((node) => {
    nodes[node.name] = node.matrixWorld.toArray();
    if (node.isMesh && node !== cloth) meshes[node.name] = pointsOf(node);
  });
  shown[time] = {
    points: pointsOf(cloth), nodes, meshes, faces: [...cloth.geometry.index.array], uv: [...cloth.geometry.attributes.uv.array],
  };
}
process.stdout.write(JSON.stringify(shown));
