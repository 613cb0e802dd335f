// SPDX-License-Identifier: MIT
// The obstacles as three.js objects: solids with flat faces, wires as lines, lone points as dots. Their geometry is
// made once; a frame only places the objects, and moves the points of those that deform. Marks are what crosses at
// time 0: they shine through whatever covers them.

import {
  BufferAttribute, BufferGeometry, DoubleSide, Group, Mesh, MeshBasicMaterial, MeshStandardMaterial, Points,
} from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import { palette } from "./colours.js";
import { makeDotMaterial } from "./cloth.js";

const kMarkOpacity = 0.7; // the cloth's folds can be seen below

function gather(positions, points) {
  const result = new Float32Array(3 * points.length);
  points.forEach((point, i) => result.set(positions.subarray(3 * point, 3 * point + 3), 3 * i));
  return result;
}

export class Obstacles {
  group = new Group();
  marks = new Group();
  #run;
  #placed = []; // { index, object, move }; `move` takes the points of one that deforms
  // Pushed back by some thousandths of the distance to the camera: faces of the cloth that cut a little into a round
  // obstacle, and cloth lying 1 mm above, stay whole at every angle.
  #solid = new MeshStandardMaterial({
    side: DoubleSide, roughness: 0.9, metalness: 0, flatShading: true,
    polygonOffset: true, polygonOffsetFactor: 4, polygonOffsetUnits: 140,
  });
  #wire = new LineMaterial({ linewidth: 3 });
  #dot = makeDotMaterial(8);
  #mark = {
    solid: new MeshBasicMaterial({ side: DoubleSide, depthTest: false, transparent: true, opacity: kMarkOpacity }),
    wire: new LineMaterial({ linewidth: 4, depthTest: false }),
    dot: Object.assign(makeDotMaterial(10), { depthTest: false }),
  };

  constructor(run) {
    this.#run = run;
    this.usePalette();
  }

  usePalette() {
    const { obstacle, obstacleLine, mark } = palette();
    for (const material of Object.values(this.#mark)) material.color.set(mark);
    this.#solid.color.set(obstacle);
    this.#wire.color.set(obstacleLine);
    this.#dot.color.set(obstacleLine);
  }

  /** Decodes all obstacles. A damaged obstacle is left out; after all others are added, the first error is thrown. */
  async load() {
    const results = await Promise.allSettled(this.#run.meshes.map((_, index) => this.#run.loadMesh(index)));
    results.forEach(({ value }, index) => {
      if (value) this.#add(index, value);
    });
    const failed = results.find(({ status }) => status === "rejected");
    if (failed) throw failed.reason;
  }

  /** Shows all obstacles as in the `position`-th frame. Without its `poses` none that deforms is shown. */
  show(position, poses) {
    for (const { index, object, move } of this.#placed) {
      const mesh = this.#run.meshes[index];
      object.matrix.set(...this.#run.placement(mesh, position), 0, 0, 0, 1);
      object.matrixWorldNeedsUpdate = true;
      if (!mesh.poses) continue;
      object.visible = poses !== undefined;
      if (poses) move(poses[index]);
    }
  }

  #add(index, { positions, faces, segments, lonePoints }) {
    const isMark = this.#run.meshes[index].mark;
    const { solid: solidMaterial, wire, dot } =
      isMark ? this.#mark : { solid: this.#solid, wire: this.#wire, dot: this.#dot };
    const object = new Group();
    object.matrixAutoUpdate = false;
    const moves = [];
    const add = (child, setPoints) => {
      child.frustumCulled = false;
      if (isMark) child.renderOrder = 1; // after the cloth
      object.add(child);
      moves.push(setPoints);
      setPoints(positions);
    };
    if (faces.length > 0) {
      const solid = new Mesh(new BufferGeometry(), solidMaterial);
      solid.geometry.setAttribute("position", new BufferAttribute(new Float32Array(positions.length), 3));
      solid.geometry.setIndex(new BufferAttribute(faces, 1));
      solid.castShadow = solid.receiveShadow = !isMark;
      add(solid, (points) => {
        const { position } = solid.geometry.attributes;
        position.array.set(points);
        position.needsUpdate = true;
      });
    }
    if (segments.length > 0) {
      const lines = new LineSegments2(new LineSegmentsGeometry(), wire);
      add(lines, (points) => {
        lines.geometry.dispose();
        lines.geometry = new LineSegmentsGeometry().setPositions(gather(points, segments));
      });
    }
    if (lonePoints.length > 0) {
      const dots = new Points(new BufferGeometry(), dot);
      add(dots, (points) => {
        dots.geometry.dispose();
        dots.geometry = new BufferGeometry();
        dots.geometry.setAttribute("position", new BufferAttribute(gather(points, lonePoints), 3));
      });
    }
    this.#placed.push({ index, object, move: (points) => moves.forEach((setPoints) => setPoints(points)) });
    (isMark ? this.marks : this.group).add(object);
  }
}
