// SPDX-License-Identifier: MIT
// The cloth of one frame as three.js objects: lit faces, EOL edges and EOL corners.
//
// Every face has its own three corners. So strain is shown as computed, one value a face, and a normal may jump
// across an EOL edge. The faces' shader draws mesh edges from the distance to the face's sides. They have even width
// on the screen, are hidden where the cloth hides them, and need no second geometry.

import {
  BufferAttribute, BufferGeometry, DoubleSide, DynamicDrawUsage, Group, Mesh, MeshStandardMaterial, Points,
  PointsMaterial,
} from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import { kBeyond, kRamp, linear, palette } from "./colours.js";

const kMode = { none: 0, strain: 1, contact: 2, checker: 3, speed: 4 };

const kSquares = 8; // pairs of checkerboard squares along the cloth's longer side

const kVertexHead = `
attribute float value;
attribute vec2 material;
varying vec2 vMaterial;
varying float vValue;
varying vec3 vBarycentric;
`;
const kVertexBody = `
vValue = value;
vMaterial = material;
int corner = gl_VertexID % 3;
vBarycentric = vec3(corner == 0, corner == 1, corner == 2);
`;
const kFragmentHead = `
uniform int uMode;
uniform float uTop;
uniform vec3 uFront, uBack, uBeyond, uContact, uFree, uEdge;
uniform float uEdges, uCell;
varying vec2 vMaterial;
uniform vec3 uRamp[${kRamp.length}];
varying float vValue;
varying vec3 vBarycentric;

// 0 and 1 in turn by squares of the material, with edges one pixel wide.
float checker() {
  vec2 at = vMaterial / uCell;
  vec2 wave = abs(fract(at) * 2.0 - 1.0) - 0.5; // changes sign at the squares' sides, with slope 2 over one cell
  vec2 sharp = clamp(wave / max(2.0 * fwidth(at), vec2(1e-6)), -0.5, 0.5) * 2.0;
  return 0.5 + 0.5 * sharp.x * sharp.y;
}

vec3 scaleColour(float strain) {
  if (strain > uTop) return uBeyond;
  float place = clamp(strain / uTop, 0.0, 1.0) * float(${kRamp.length - 1});
  int step = min(int(place), ${kRamp.length - 2});
  return mix(uRamp[step], uRamp[step + 1], place - float(step));
}
`;
// The back of a coloured cloth is a little darker, which distinguishes the sides without changing the hue.
const kFragmentColour = `
float side = gl_FrontFacing ? 1.0 : 0.8;
if (uMode == ${kMode.strain} || uMode == ${kMode.speed}) diffuseColor.rgb = side * scaleColour(vValue);
else if (uMode == ${kMode.contact}) diffuseColor.rgb = side * mix(uFree, uContact, smoothstep(0.25, 0.75, vValue));
else diffuseColor.rgb = gl_FrontFacing ? uFront : uBack;
if (uMode == ${kMode.checker}) diffuseColor.rgb *= mix(0.5, 1.0, checker());
`;
// Distances to the three sides are in pixels; edges fade out where faces are only a few pixels high.
const kFragmentEdges = `
vec3 slope = max(fwidth(vBarycentric), vec3(1e-9));
vec3 pixels = vBarycentric / slope;
float height = 1.0 / max(slope.x, max(slope.y, slope.z));
float edge = 1.0 - smoothstep(0.3, 1.1, min(pixels.x, min(pixels.y, pixels.z)));
outgoingLight = mix(outgoingLight, uEdge, edge * uEdges * smoothstep(2.0, 7.0, height));
`;

// Lines on the cloth are drawn a little nearer, so that the cloth does not cover half of their width.
const kNearer = { polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -160 };

function makeFaceMaterial(uniforms) {
  const material = new MeshStandardMaterial({
    side: DoubleSide, roughness: 0.82, metalness: 0, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 2,
  });
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, uniforms);
    const insert = (source, chunk, before, after) => {
      if (!source.includes(chunk)) throw new Error(`three.js has no ${chunk} any more`);
      return source.replace(chunk, `${before}\n${chunk}\n${after}`);
    };
    shader.vertexShader = insert(kVertexHead + shader.vertexShader, "#include <begin_vertex>", "", kVertexBody);
    shader.fragmentShader = kFragmentHead + shader.fragmentShader;
    shader.fragmentShader = insert(shader.fragmentShader, "#include <color_fragment>", "", kFragmentColour);
    shader.fragmentShader = insert(shader.fragmentShader, "#include <opaque_fragment>", kFragmentEdges, "");
  };
  return material;
}

/** Round dots, `size` pixels wide. */
export function makeDotMaterial(size) {
  const material = new PointsMaterial({ size, sizeAttenuation: false });
  material.onBeforeCompile = (shader) => {
    shader.fragmentShader = shader.fragmentShader.replace(
      "#include <clipping_planes_fragment>",
      "#include <clipping_planes_fragment>\nif (length(gl_PointCoord - 0.5) > 0.5) discard;");
  };
  return material;
}

/** Makes the vectors of an array of triples unit vectors; zero vectors stay. */
function normalise(vectors) {
  for (let g = 0; g < vectors.length; g += 3) {
    const length = Math.hypot(vectors[g], vectors[g + 1], vectors[g + 2]);
    const scale = length > 0 ? 1 / length : 0;
    for (let k = 0; k < 3; ++k) vectors[g + k] *= scale;
  }
}

/** One round of averaging with the neighbours, which takes out shading at the size of single faces. */
function smoothNormals(normals, groups) {
  const result = new Float32Array(normals.length);
  for (let c = 0; c < groups.length; c += 3) {
    for (let k = 0; k < 3; ++k) {
      const sum = normals[3 * groups[c] + k] + normals[3 * groups[c + 1] + k] + normals[3 * groups[c + 2] + k];
      for (let corner = c; corner < c + 3; ++corner) result[3 * groups[corner] + k] += sum;
    }
  }
  normalise(result);
  return result;
}

/** Unit normals of the groups of corners: the faces' normals weighted by area, then smoothed. */
function computeNormals(positions, faces, groups, groupCount) {
  const normals = new Float32Array(3 * groupCount);
  for (let c = 0; c < faces.length; c += 3) {
    const [a, b, d] = [3 * faces[c], 3 * faces[c + 1], 3 * faces[c + 2]];
    const ux = positions[b] - positions[a], uy = positions[b + 1] - positions[a + 1], uz = positions[b + 2] - positions[a + 2];
    const vx = positions[d] - positions[a], vy = positions[d + 1] - positions[a + 1], vz = positions[d + 2] - positions[a + 2];
    const nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    for (let k = 0; k < 3; ++k) {
      const group = 3 * groups[c + k];
      normals[group] += nx;
      normals[group + 1] += ny;
      normals[group + 2] += nz;
    }
  }
  normalise(normals);
  return smoothNormals(normals, groups);
}

export class Cloth {
  group = new Group();
  #mode = "none";
  #frame = null;
  #hasEol = true;
  #uniforms = {
    uMode: { value: 0 }, uCell: { value: 1 }, uTop: { value: 1 }, uEdges: { value: 0 }, uFront: { value: null }, uBack: { value: null },
    uBeyond: { value: linear(kBeyond) }, uContact: { value: null }, uFree: { value: null }, uEdge: { value: null },
    uRamp: { value: kRamp.map(linear) },
  };
  #faces = new Mesh(new BufferGeometry(), makeFaceMaterial(this.#uniforms));
  #lines = new LineSegments2(new LineSegmentsGeometry(), new LineMaterial({ 
    linewidth: 1.6, ...kNearer }));
  #dots = new Points(new BufferGeometry(), makeDotMaterial(6));

  constructor() {
    this.#faces.castShadow = this.#faces.receiveShadow = true;
    for (const object of [this.#faces, this.#lines, this.#dots]) {
      object.frustumCulled = false;
      object.visible = false;
      this.group.add(object);
    }
    this.usePalette();
  }

  usePalette() {
    const colours = palette();
    this.#uniforms.uFront.value = linear(colours.front);
    this.#uniforms.uBack.value = linear(colours.back);
    this.#uniforms.uContact.value = linear(colours.contact);
    this.#uniforms.uFree.value = linear(colours.free);
    this.#uniforms.uEdge.value = linear(colours.edge);
    this.#lines.material.color.set(colours.eol);
    this.#dots.material.color.set(colours.eol);
  }

  /** Sets what the faces' colour shows: a key of kMode. */
  setMode(mode) {
    this.#mode = mode;
    this.#uniforms.uMode.value = kMode[mode];
    if (this.#frame) this.#fillValues();
  }

  setEol(isShown) {
    this.#hasEol = isShown;
    if (this.#frame) this.#showFeatures(this.#frame.positions, this.#frame.topology);
  }

  /** Sets the value at the upper end of the scale of the mode shown. */
  setTop(top) {
    this.#uniforms.uTop.value = top;
  }

  setEdges(areShown) {
    this.#uniforms.uEdges.value = areShown ? 0.62 : 0;
  }

  hide() {
    this.#frame = null;
    this.#faces.visible = this.#lines.visible = this.#dots.visible = false;
  }

  show(frame) {
    this.#frame = frame;
    const { faces, groups, groupCount, size } = frame.topology;
    this.#reserve(faces.length);
    const position = this.#faces.geometry.attributes.position;
    const normal = this.#faces.geometry.attributes.normal;
    const material = this.#faces.geometry.attributes.material;
    this.#uniforms.uCell.value = Math.max(...size) / kSquares;
    const normals = computeNormals(frame.positions, faces, groups, groupCount);
    for (let c = 0, out = 0; c < faces.length; ++c) {
      const [vertex, group] = [3 * faces[c], 3 * groups[c]];
      material.array[2 * c] = frame.material[2 * faces[c]];
      material.array[2 * c + 1] = frame.material[2 * faces[c] + 1];
      for (let k = 0; k < 3; ++k, ++out) {
        position.array[out] = frame.positions[vertex + k];
        normal.array[out] = normals[group + k];
      }
    }
    for (const attribute of [position, normal]) this.#upload(attribute, 3 * faces.length);
    this.#upload(material, 2 * faces.length);
    this.#fillValues();
    this.#faces.geometry.setDrawRange(0, faces.length);
    this.#faces.visible = true;
    this.#showFeatures(frame.positions, frame.topology);
  }

  /** Buffers for `corners` corners plus a quarter, because adaptive meshes grow by a few faces at a time. */
  #reserve(corners) {
    const old = this.#faces.geometry;
    if (old.attributes.position?.count >= corners) return;
    const room = 3 * Math.ceil(corners / 3 * 1.25);
    old.dispose();
    const geometry = new BufferGeometry();
    for (const [name, size] of [["position", 3], ["normal", 3], ["value", 1], ["material", 2]])
      geometry.setAttribute(name, new BufferAttribute(new Float32Array(size * room), size).setUsage(DynamicDrawUsage));
    this.#faces.geometry = geometry;
  }

  #upload(attribute, count) {
    attribute.clearUpdateRanges();
    attribute.addUpdateRange(0, count);
    attribute.needsUpdate = true;
  }

  #fillValues() {
    const { topology: { faces }, strain, contact, speed } = this.#frame;
    const value = this.#faces.geometry.attributes.value;
    if (this.#mode === "strain") {
      for (let c = 0; c < faces.length; ++c) value.array[c] = strain[(c / 3) | 0];
    } else if (this.#mode === "contact") {
      for (let c = 0; c < faces.length; ++c) value.array[c] = (contact[faces[c] >> 3] >> (faces[c] & 7)) & 1;
    } else if (this.#mode === "speed") {
      for (let c = 0; c < faces.length; ++c) value.array[c] = speed[faces[c]];
    } else {
      return;
    }
    this.#upload(value, faces.length);
  }

  #showFeatures(positions, { edges, corners }) {
    const gather = (vertices) => {
      const result = new Float32Array(3 * vertices.length);
      vertices.forEach((vertex, i) => result.set(positions.subarray(3 * vertex, 3 * vertex + 3), 3 * i));
      return result;
    };
    this.#lines.visible = this.#hasEol && edges.length > 0;
    this.#dots.visible = this.#hasEol && corners.length > 0;
    this.#lines.geometry.dispose();
    this.#lines.geometry = new LineSegmentsGeometry();
    if (edges.length > 0) this.#lines.geometry.setPositions(gather(edges));
    this.#dots.geometry.dispose();
    this.#dots.geometry = new BufferGeometry();
    this.#dots.geometry.setAttribute("position", new BufferAttribute(gather(corners), 3));
  }
}
