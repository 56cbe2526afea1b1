// SPDX-License-Identifier: Apache-2.0
// The three.js side of the solid view.

import {
  AmbientLight, BufferAttribute, BufferGeometry, Color, DirectionalLight, DoubleSide, EdgesGeometry,
  Group, LineBasicMaterial, LineSegments, Mesh, MeshPhongMaterial, PerspectiveCamera, Scene,
  WebGLRenderer,
} from "three";
import type { SolidMesh } from "./solid";

const EDGE_ANGLE_DEG = 35;
const FIELD_DEG = 30;
const LEAST_RADIUS_MM = 32; // in sight: lenses of usual size are shown to one scale

export interface SolidScene {
  show(mesh: SolidMesh): void;
  turn(about_y: number, about_x: number): void;
}

export function createScene(canvas: HTMLCanvasElement): SolidScene {
  const renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
  const scene = new Scene();
  const camera = new PerspectiveCamera(FIELD_DEG, 1, 10, 900);
  let radius = LEAST_RADIUS_MM;
  scene.add(new AmbientLight(0xffffff, 1.3));
  const lamp = new DirectionalLight(0xffffff, 2.4);
  lamp.position.set(-60, 80, 90);
  const fill = new DirectionalLight(0xbfe8ff, 1.1);
  fill.position.set(70, -30, -60);
  scene.add(lamp, fill);
  const group = new Group();
  group.rotation.set(0.25, -0.8, 0);
  scene.add(group);

  function render(): void {
    const width = canvas.clientWidth || 600;
    const height = canvas.clientHeight || 400;
    renderer.setPixelRatio(Math.min(2, devicePixelRatio));
    renderer.setSize(width, height, false);
    camera.aspect = width / height;
    // So far that the lens stays in sight in any turn, on a narrow canvas too.
    const half = (FIELD_DEG * Math.PI) / 360;
    camera.position.z = radius / Math.sin(Math.atan(Math.tan(half) * Math.min(1, camera.aspect)));
    camera.updateProjectionMatrix();
    renderer.render(scene, camera);
  }
  new ResizeObserver(render).observe(canvas);

  return {
    show(mesh) {
      for (const child of [...group.children]) {
        (child as Mesh).geometry.dispose();
        group.remove(child);
      }
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", new BufferAttribute(mesh.positions, 3));
      geometry.setIndex(mesh.indices);
      geometry.computeVertexNormals();
      // It turns about its own middle, not about the optical centre.
      geometry.center();
      geometry.computeBoundingSphere();
      radius = Math.max(LEAST_RADIUS_MM, geometry.boundingSphere!.radius);
      const ink = getComputedStyle(canvas).getPropertyValue("--lens-line").trim();
      const glass = new MeshPhongMaterial({ color: new Color("#9fd3d8"), transparent: true,
        opacity: 0.5, shininess: 140, specular: new Color("#ffffff"), side: DoubleSide,
        depthWrite: false });
      const lines = new LineSegments(new EdgesGeometry(geometry, EDGE_ANGLE_DEG),
        new LineBasicMaterial({ color: new Color(ink || "#0d5c63") }));
      group.add(new Mesh(geometry, glass), lines);
      render();
    },
    turn(aboutY, aboutX) {
      group.rotation.y += aboutY;
      group.rotation.x += aboutX;
      render();
    },
  };
}
