// SPDX-License-Identifier: MIT
// The obstacles as three.js objects: solids with flat faces, wires as lines, lone points as dots. Their geometry is
// made once; a frame only places the objects.

import { BufferAttribute, BufferGeometry, DoubleSide, Group, Mesh, MeshStandardMaterial, Points } from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import { palette } from "./colours.js";
import { makeDotMaterial } from "./cloth.js";

function gather(positions, points) {
  const result = new Float32Array(3 * points.length);
  points.forEach((point, i) => result.set(positions.subarray(3 * point, 3 * point + 3), 3 * i));
  return result;
}

export class Obstacles {
  group = new Group();
  #run;
  #placed = []; // { mesh, object }
  // Pushed back by some thousandths of the distance to the camera: faces of the cloth that cut a little into a round
  // obstacle, and cloth lying 1 mm above, stay whole at every angle.
  #solid = new MeshStandardMaterial({
    side: DoubleSide, roughness: 0.9, metalness: 0, flatShading: true,
    polygonOffset: true, polygonOffsetFactor: 4, polygonOffsetUnits: 140,
  });
  #wire = new LineMaterial({ linewidth: 3 });
  #dot = makeDotMaterial(8);

  constructor(run) {
    this.#run = run;
    this.usePalette();
  }

  usePalette() {
    const { obstacle, obstacleLine } = palette();
    this.#solid.color.set(obstacle);
    this.#wire.color.set(obstacleLine);
    this.#dot.color.set(obstacleLine);
  }

  /** Decodes all obstacles. A damaged obstacle is left out; after all others are added, the first error is thrown. */
  async load() {
    const results = await Promise.allSettled(this.#run.meshes.map((_, index) => this.#run.loadMesh(index)));
    results.forEach(({ value }, index) => {
      if (value) this.#add(this.#run.meshes[index], value);
    });
    const failed = results.find(({ status }) => status === "rejected");
    if (failed) throw failed.reason;
  }

  /** Places all obstacles as in the `position`-th frame. */
  show(position) {
    for (const { mesh, object } of this.#placed) {
      object.matrix.set(...this.#run.placement(mesh, position), 0, 0, 0, 1);
      object.matrixWorldNeedsUpdate = true;
    }
  }

  #add(mesh, { positions, faces, segments, lonePoints }) {
    const object = new Group();
    object.matrixAutoUpdate = false;
    if (faces.length > 0) {
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", new BufferAttribute(positions, 3));
      geometry.setIndex(new BufferAttribute(faces, 1));
      const solid = new Mesh(geometry, this.#solid);
      solid.castShadow = solid.receiveShadow = true;
      object.add(solid);
    }
    if (segments.length > 0) {
      const geometry = new LineSegmentsGeometry();
      geometry.setPositions(gather(positions, segments));
      object.add(new LineSegments2(geometry, this.#wire));
    }
    if (lonePoints.length > 0) {
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", new BufferAttribute(gather(positions, lonePoints), 3));
      object.add(new Points(geometry, this.#dot));
    }
    for (const child of object.children) child.frustumCulled = false;
    this.#placed.push({ mesh, object });
    this.group.add(object);
  }
}
