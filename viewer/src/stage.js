// SPDX-License-Identifier: MIT
// The 3D scene: camera and its controls, lights, ground. Up is z; positions are relative to the run's centre.

import {
  DirectionalLight, DoubleSide, HemisphereLight, Mesh, PCFShadowMap, PerspectiveCamera, PlaneGeometry, Scene,
  ShaderMaterial, ShadowMaterial, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { joined } from "./boxes.js";
import { linear, palette } from "./colours.js";

const kFieldOfView = 32; // degrees, vertical
const kAzimuth = -62; // degrees from +x of the first view
const kElevation = 24; // degrees above the horizon
const kVesselElevation = 50; // the same where the rim of a vessel would hide the cloth
const kShadowMap = 2048; // texels a side
const kShadowTexels = 3; // lift of a surface above its own shadow
const kKeyLight = new Vector3(-0.8, -0.55, 1.15).normalize();
const kMargin = 0.9; // share of the free half width or height of the view that a fitted box may fill
const kViews = { // directions of the preset views: azimuth, elevation
  first: [kAzimuth, kElevation], front: [-90, 4], side: [0, 4], top: [-90, 89.9],
};

/** Centre and radius of the ball around a box { least, size }, relative to `origin`; the radius is at least 1 mm. */
function ballAround(box, origin) {
  const centre = new Vector3(...box.least.map((least, axis) => least + box.size[axis] / 2 - origin[axis]));
  return { centre, radius: Math.max(Math.hypot(...box.size) / 2, 5e-4) };
}

const kGridShader = {
  vertexShader: `
    varying vec2 vPlace;
    void main() {
      vPlace = position.xy;
      gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
    }`,
  fragmentShader: `
    uniform float uCell, uReach, uStrength;
    uniform vec3 uColour;
    uniform vec2 uOffset;
    varying vec2 vPlace;
    float lines(vec2 place, float cell) {
      vec2 at = (place + uOffset) / cell;
      vec2 slope = max(fwidth(at), vec2(1e-9));
      vec2 distance = abs(fract(at - 0.5) - 0.5) / slope;
      vec2 line = (1.0 - smoothstep(0.2, 1.2, distance)) * (1.0 - smoothstep(0.15, 0.5, slope));
      return max(line.x, line.y);
    }
    void main() {
      float strength = max(0.4 * lines(vPlace, uCell), lines(vPlace, 10.0 * uCell));
      float fade = 1.0 - smoothstep(0.35, 1.0, length(vPlace) / uReach);
      gl_FragColor = vec4(uColour, strength * fade * uStrength * (gl_FrontFacing ? 1.0 : 0.4));
      #include <colorspace_fragment>
    }`,
};

export class Stage {
  #renderer;
  #scene = new Scene();
  #camera = new PerspectiveCamera(kFieldOfView, 1, 0.01, 100);
  #controls;
  #run;
  #sky = new HemisphereLight(0xffffff, 0xffffff, 1.25);
  #key = new DirectionalLight(0xffffff, 2.2);
  #fill = new DirectionalLight(0xffffff, 0.8);
  #grid;
  #floor;
  #drift = new Vector3();
  #isFixed = false;
  #insets = [0.06, 0.06];
  isStale = true;
  isTurned = false; // by the reader, since the last fit

  /** Throws if the browser has no WebGL 2. */
  constructor(canvas, run) {
    this.#run = run;
    this.#renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.#renderer.shadowMap.enabled = true;
    this.#renderer.shadowMap.type = PCFShadowMap;
    this.#camera.up.set(0, 0, 1);
    this.#controls = new OrbitControls(this.#camera, canvas);
    this.#controls.enableDamping = true;
    this.#controls.dampingFactor = 0.16;
    this.#controls.zoomToCursor = true;
    this.#controls.addEventListener("start", () => (this.isTurned = true));
    this.#controls.addEventListener("change", () => (this.isStale = true));
    this.#addLights();
    this.#addGround();
    this.usePalette();
    this.fit(run.viewBoxes(), { view: "first" });
  }

  /** The grid's spacing in metres, for the read-out; null without a ground. */
  get cell() {
    return !this.#grid.visible ? null : this.#grid.material.uniforms.uCell.value;
  }

  add(object) {
    this.#scene.add(object);
  }

  usePalette() {
    const colours = palette();
    this.#sky.color.set(colours.sky);
    this.#sky.groundColor.set(colours.floor);
    this.#grid.material.uniforms.uColour.value = linear(colours.gridLine);
    this.#grid.material.uniforms.uStrength.value = colours.gridStrength;
    this.#floor.material.opacity = colours.shadow;
    this.isStale = true;
  }

  /**
   * Turns the camera so that boxes { least, size } fill the view. The direction is the present one unless a preset
   * `view`, `azimuth` (degrees from +x about z) or `elevation` (degrees) are given. A `zoom` above 1 comes nearer.
   * `isWhole`: the boxes are those of the whole run, so the view goes on following cloth that leaves them.
   * `isFixed`: the view follows nothing.
   */
  fit(boxes, { view, azimuth, elevation, zoom = 1, isWhole = true, isFixed = false, drift } = {}) {
    const direction = this.#camera.position.clone().sub(this.#controls.target).normalize();
    if (view !== undefined || azimuth !== undefined || elevation !== undefined) {
      const [firstAzimuth, usualElevation] = kViews[view ?? "first"];
      const isFirst = (view ?? "first") === "first";
      const firstElevation = isFirst && this.#run.endsInVessel() ? kVesselElevation : usualElevation;
      const a = ((azimuth ?? firstAzimuth) * Math.PI) / 180;
      const e = (Math.min(Math.max(elevation ?? firstElevation, -89.9), 89.9) * Math.PI) / 180;
      direction.set(Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e));
    }
    const { centre, distance } = this.#fitted(boxes, direction);
    this.isTurned = false;
    this.#isFixed = isFixed;
    if (drift) this.#drift.set(...drift); // the boxes are where the cloth has drifted to
    if (isWhole) centre.add(this.#drift);
    this.#controls.target.copy(centre);
    this.#camera.position.copy(centre).addScaledVector(direction, distance / zoom);
    this.#controls.update();
    this.isStale = true;
  }

  /** The nearest camera against `direction` that sees all corners of the boxes within the part free of panels. */
  #fitted(boxes, direction) {
    const right = this.#camera.up.clone().cross(direction).normalize();
    const up = direction.clone().cross(right);
    const slope = Math.tan((kFieldOfView * Math.PI) / 360);
    // The free part of the view in units of its half height, and its corners' slopes; x is even, y is not.
    const across = kMargin * slope * this.#camera.aspect;
    const [above, below] = this.#insets.map((inset) => slope * kMargin * (1 - 2 * inset));
    const most = { left: -Infinity, right: -Infinity, above: -Infinity, below: -Infinity };
    for (const { least, size } of boxes) {
      for (let corner = 0; corner < 8; ++corner) {
        const at = new Vector3(...least.map((value, axis) =>
          value + ((corner >> axis) & 1 ? size[axis] : 0) - this.#run.origin[axis]));
        const [x, y, z] = [at.dot(right), at.dot(up), at.dot(direction)];
        // A corner is within the view from distance d if |x - centre| <= across (d - z), and for y likewise.
        most.right = Math.max(most.right, x + across * z);
        most.left = Math.max(most.left, -x + across * z);
        most.above = Math.max(most.above, y + above * z);
        most.below = Math.max(most.below, -y + below * z);
      }
    }
    const far = Math.max((most.right + most.left) / (2 * across), (most.above + most.below) / (above + below));
    const x = (most.right - most.left) / 2;
    const y = (most.above - above * far + below * far - most.below) / 2;
    // The controls turn about a point in the middle of the boxes' depth.
    const box = boxes.reduce(joined);
    const { centre: middle, radius } = ballAround(box, this.#run.origin);
    const depth = middle.dot(direction);
    const centre = right.multiplyScalar(x).addScaledVector(up, y).addScaledVector(direction, depth);
    return { centre, distance: Math.max(far - depth, 2 * radius * 0.5, 1e-3) };
  }

  /** Sets the shares of the view's height that panels take at the top and the bottom. */
  setInsets(top, bottom) {
    this.#insets = [Math.min(top, 0.4), Math.min(bottom, 0.4)];
  }

  /** Moves the camera along with cloth that leaves the run's stage, by the vector `drift` of Run.drift. */
  follow(drift) {
    const change = new Vector3(...drift).sub(this.#drift);
    if (change.lengthSq() === 0) return;
    this.#drift.add(change);
    if (this.#isFixed) return;
    this.#controls.target.add(change);
    this.#camera.position.add(change);
    this.#controls.update();
    this.isStale = true;
  }

  /** Aims the shadow light at a box { least, size }: all that casts shadows now. Its view includes the way down. */
  aimShadow(box) {
    const { centre, radius } = ballAround(box, this.#run.origin);
    const camera = this.#key.shadow.camera;
    this.#key.position.copy(centre).addScaledVector(kKeyLight, 2 * radius);
    this.#key.target.position.copy(centre);
    camera.left = camera.bottom = -radius;
    camera.right = camera.top = radius;
    camera.near = 0.5 * radius;
    camera.far = 3.5 * radius + 3 * Math.hypot(...this.#run.surroundings.size);
    camera.updateProjectionMatrix();
    this.#key.shadow.normalBias = kShadowTexels * 2 * radius / kShadowMap;
    this.isStale = true;
  }

  resize(width, height, pixelRatio) {
    this.#camera.aspect = width / Math.max(height, 1);
    this.#camera.updateProjectionMatrix();
    this.#renderer.setPixelRatio(Math.min(pixelRatio, 2));
    this.#renderer.setSize(width, height, false);
    this.isStale = true;
  }

  /** Draws if anything has changed; returns whether it drew. */
  draw() {
    this.#controls.update();
    if (!this.isStale) return false;
    const distance = this.#camera.position.distanceTo(this.#controls.target);
    const reach = Math.hypot(...this.#run.surroundings.size) + this.#camera.position.length();
    this.#camera.near = 0.01 * distance;
    this.#camera.far = 8 * reach + distance;
    this.#camera.updateProjectionMatrix();
    this.#renderer.render(this.#scene, this.#camera);
    this.isStale = false;
    return true;
  }

  /** Directions of the unit vectors of x, y, z on the screen: [right, up, towards the viewer] each. */
  axes() {
    const view = this.#camera.matrixWorldInverse;
    return [0, 1, 2].map((axis) => new Vector3().setComponent(axis, 1).transformDirection(view).toArray());
  }

  #addLights() {
    this.#sky.position.set(0, 0, 1);
    this.#key.castShadow = true;
    this.#key.shadow.mapSize.set(kShadowMap, kShadowMap);
    this.#key.shadow.bias = -0.0006;
    this.#key.shadow.radius = 6;
    this.#fill.position.set(0.6, 0.2, 1); // from beside the camera, so that no view looks flat
    this.#camera.add(this.#fill, this.#fill.target);
    this.#fill.target.position.set(0, 0, -1);
    this.#scene.add(this.#sky, this.#key, this.#key.target, this.#camera);
  }

  /** Adds a grid and the shadow slightly below the run's ground, so that they cut nothing lying there. */
  #addGround() {
    const height = this.#run.groundHeight();
    const { centre, radius } = ballAround(this.#run.stage, this.#run.origin);
    const reach = 5 * radius;
    const cell = 10 ** Math.floor(Math.log10(radius / 1.5));
    // The world's origin is on a grid line: the offset is taken modulo the coarse cells, in double precision.
    const offset = ["x", "y"].map((axis, k) => this.#run.origin[k] + centre[axis])
      .map((value) => value - Math.floor(value / (10 * cell)) * 10 * cell);
    this.#grid = new Mesh(new PlaneGeometry(2 * reach, 2 * reach), new ShaderMaterial({
      ...kGridShader, transparent: true, depthWrite: false, side: DoubleSide,
      uniforms: {
        uCell: { value: cell }, uReach: { value: reach }, uStrength: { value: 1 }, uColour: { value: null },
        uOffset: { value: offset },
      },
    }));
    this.#floor = new Mesh(new PlaneGeometry(2 * reach, 2 * reach), new ShadowMaterial({ depthWrite: false }));
    this.#floor.receiveShadow = true;
    this.#floor.renderOrder = -1;
    for (const plane of [this.#grid, this.#floor]) {
      plane.position.set(centre.x, centre.y, (height ?? 0) - this.#run.origin[2] - 1e-3 * radius);
      plane.visible = height !== null;
      this.#scene.add(plane);
    }
  }
}
