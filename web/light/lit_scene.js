// SPDX-License-Identifier: Apache-2.0
// The server's scene in three.js: a copy, which follows the edits that the server tells of.
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { EDITS, TYPE } from '../../src/stream/page/protocol.js';

const MOST_SHADOWS = 4; // each takes a texture, of which WebGL has 16 for all purposes
const SHADOW_TEXELS = 2048;
const SKY_SIZES = 4; // how far the sky is, in sizes of the scene: in front of the farthest that cameras see

export class LitScene {
  /// From the bytes of /scene.glb: nodes are the instances, then the lights, each in the scene's order.
  static async make(bytes, { instances, lights, min, max }, field) {
    const gltf = await new GLTFLoader().parseAsync(bytes, '');
    const nodes = await Promise.all(Array.from({ length: instances + lights.length },
      (_, i) => gltf.parser.getDependency('node', i)));
    return new LitScene(gltf, nodes.slice(0, instances), nodes.slice(instances), { min, max }, field);
  }

  constructor(gltf, objects, lightNodes, bounds, field) {
    this.scene = new THREE.Scene().add(gltf.scene);
    this.objects = objects;
    const [min, max] = [new THREE.Vector3(...bounds.min), new THREE.Vector3(...bounds.max)];
    this.centre = min.clone().add(max).multiplyScalar(0.5);
    this.size = min.distanceTo(max);
    const sky = gltf.scene.userData.lambent_sky_radiance;
    gltf.scene.traverse((object) => {
      if (object.isMesh) this.#prepare(object, field);
    });
    if (sky) this.#addSky(new THREE.Color(...sky));
    this.lights = [];
    lightNodes.forEach((node) => node.traverse((object) => { if (object.isLight) this.lights.push(object); }));
    this.lights.slice(0, MOST_SHADOWS).forEach((light) => this.#castShadows(light));
    this.lights.filter((light) => light.isDirectionalLight).forEach((light) => this.#aim(light));
    this.sun = this.lights.find((light) => light.isDirectionalLight);
    this.fullSun = this.sun && { color: this.sun.color.clone(), intensity: this.sun.intensity };
  }

  /// Light falls on both sides of surfaces, whatever their winding.
  #prepare(mesh, field) {
    mesh.castShadow = mesh.receiveShadow = true;
    for (const material of [mesh.material].flat()) {
      material.side = THREE.DoubleSide;
      if (material.isMeshStandardMaterial) field.light(material);
    }
  }

  /// A background would not be tone mapped; this is, and is around whatever camera there is.
  #addSky(color) {
    const material = new THREE.MeshBasicMaterial({ color, side: THREE.BackSide, depthWrite: false });
    const sphere = new THREE.Mesh(new THREE.SphereGeometry(SKY_SIZES * this.size), material);
    sphere.onBeforeRender = (renderer, scene, camera) => {
      sphere.matrixWorld.copyPosition(camera.matrixWorld);
    };
    sphere.frustumCulled = false;
    sphere.renderOrder = -1;
    this.scene.add(sphere);
  }

  #castShadows(light) {
    light.castShadow = true;
    light.shadow.mapSize.setScalar(SHADOW_TEXELS);
    light.shadow.normalBias = 2e-3 * this.size;
    const { camera } = light.shadow;
    [camera.near, camera.far] = [1e-3 * this.size, 2 * this.size];
    if (!camera.isOrthographicCamera) return;
    [camera.left, camera.right, camera.bottom, camera.top] = [-0.5, 0.5, -0.5, 0.5].map((share) => share * this.size);
  }

  /// A directional light's shadows are seen from outside of the scene, the way that it shines.
  #aim(light, direction = new THREE.Vector3(0, 0, -1).applyQuaternion(light.quaternion)) {
    light.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, -1), direction);
    if (light.isDirectionalLight) light.position.copy(this.centre).addScaledVector(direction, -this.size);
  }

  /// Follows an edit that the server tells of. `sunAt` is the decoder's.
  follow(edit, sunAt) {
    if (edit.type === TYPE.object) this.#place(edit);
    if (edit.type === TYPE.light) this.#editLight(edit);
    if (edit.type === TYPE.sun) this.#aim(this.sun, new THREE.Vector3(...edit.direction));
    if (edit.type !== TYPE.timeOfDay) return;
    const { direction, share } = sunAt(edit.hours);
    this.#aim(this.sun, new THREE.Vector3(...direction));
    this.sun.color.copy(this.fullSun.color);
    this.sun.intensity = this.fullSun.intensity * share;
  }

  #place({ instance, axes: [a, b, c, d, e, f, g, h, i], position: [x, y, z] }) {
    const object = this.objects[instance];
    object.matrixAutoUpdate = false;
    object.matrix.set(a, d, g, x, b, e, h, y, c, f, i, z, 0, 0, 0, 1);
    object.matrixWorldNeedsUpdate = true;
  }

  #editLight({ light: index, edits, position, direction, intensity }) {
    const light = this.lights[index];
    if (edits & EDITS.direction) this.#aim(light, new THREE.Vector3(...direction));
    if (edits & EDITS.position && !light.isDirectionalLight) light.position.set(...position);
    if (!(edits & EDITS.intensity)) return;
    light.intensity = 1;
    light.color.setRGB(...intensity);
  }

  /// Whether light comes straight from the scene's lights, too.
  set direct(shown) { for (const light of this.lights) light.visible = shown; }
}
