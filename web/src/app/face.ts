// SPDX-License-Identifier: Apache-2.0
// A face to look through lenses at: drawn here, or the user's own photograph. Coordinates are mm in
// the plane of the lenses as the camera sees them, x to the viewer's right, y up, 0 between the eyes.

import type { Pupils } from "./eye_picture";
import type { EyeName } from "./order";

export const WINDOW = { left: -84, right: 84, top: 46, bottom: -46 };
export const PX_PER_MM = 6;
export const WIDTH = (WINDOW.right - WINDOW.left) * PX_PER_MM;
export const HEIGHT = (WINDOW.top - WINDOW.bottom) * PX_PER_MM;

type Context = CanvasRenderingContext2D;

function toMm(ctx: Context, perMm = PX_PER_MM): void {
  ctx.setTransform(perMm, 0, 0, -perMm, -WINDOW.left * perMm, WINDOW.top * perMm);
}

function drawEye(ctx: Context, x: number, y: number, side: 1 | -1, iris: number): void {
  ctx.save();
  ctx.translate(x, y);
  ctx.scale(side, 1); // +x toward the temple
  // Shade of the socket and the lid's crease.
  const socket = ctx.createRadialGradient(0, 2, 4, 0, 2, 22);
  socket.addColorStop(0, "rgba(140,84,62,.30)");
  socket.addColorStop(1, "rgba(140,84,62,0)");
  ctx.fillStyle = socket;
  ctx.fillRect(-26, -20, 52, 44);
  const opening = new Path2D(
    "M-14.6 -2.2C-11 1.6 -6.5 5.3 .2 5.5C7 5.6 11.6 3 14.6 .4C11.4 -3.4 6.2 -5.6 .4 -5.6C-5.6 -5.6 -10.6 -4.2 -14.6 -2.2Z");
  ctx.save();
  ctx.clip(opening);
  ctx.fillStyle = "#f1ebe4";
  ctx.fillRect(-16, -8, 32, 16);
  const ring = ctx.createRadialGradient(0, 0, 1.6, 0, 0, iris);
  ring.addColorStop(0, "#7d6a3c");
  ring.addColorStop(0.5, "#5f7d5c");
  ring.addColorStop(0.9, "#3d5f58");
  ring.addColorStop(1, "#213c3c");
  ctx.fillStyle = ring;
  ctx.beginPath();
  ctx.arc(0, 0, iris, 0, 7);
  ctx.fill();
  ctx.strokeStyle = "rgba(225,225,170,.28)";
  ctx.lineWidth = 0.18;
  ctx.beginPath();
  for (let k = 0; k < 40; ++k) {
    const a = (k / 40) * 2 * Math.PI;
    const out = iris * (0.78 + 0.14 * Math.sin(k * 2.7));
    ctx.moveTo(2.1 * Math.cos(a), 2.1 * Math.sin(a));
    ctx.lineTo(out * Math.cos(a), out * Math.sin(a));
  }
  ctx.stroke();
  ctx.fillStyle = "#0d0d0f";
  ctx.beginPath();
  ctx.arc(0, 0, 1.9, 0, 7);
  ctx.fill();
  const shade = ctx.createLinearGradient(0, 6, 0, 0);
  shade.addColorStop(0, "rgba(40,18,12,.55)");
  shade.addColorStop(1, "rgba(40,18,12,0)");
  ctx.fillStyle = shade;
  ctx.fillRect(-16, 0, 32, 8);
  ctx.restore();
  ctx.fillStyle = "rgba(255,255,255,.9)";
  ctx.beginPath();
  ctx.ellipse(-1.5 * side, 2, 1, 0.8, 0, 0, 7);
  ctx.fill();
  // Caruncle, lash line, crease.
  ctx.fillStyle = "#cf8f80";
  ctx.beginPath();
  ctx.ellipse(-13, -1.9, 1.5, 1, 0.3, 0, 7);
  ctx.fill();
  ctx.lineCap = "round";
  ctx.strokeStyle = "#2b1a15";
  ctx.lineWidth = 1.1;
  ctx.stroke(new Path2D("M-14.4 -1.9C-11 1.8 -6.5 5.5 .2 5.7C7 5.8 11.8 3.1 15.6 -.1"));
  ctx.lineWidth = 0.35;
  ctx.stroke(new Path2D("M-12.6 -3.1C-9 -5 -4.6 -5.8 .4 -5.8C6.2 -5.8 11.4 -3.5 14.6 .3"));
  ctx.lineWidth = 0.4;
  for (let k = 0; k < 15; ++k) {
    const f = k / 14;
    const px = -9 + 23.5 * f;
    const py = 5.7 - 5.2 * (f - 0.4) ** 2 * 2.6;
    ctx.beginPath();
    ctx.moveTo(px, py);
    ctx.quadraticCurveTo(px + 0.6 + f, py + 1.6, px + 0.2 + 3 * f - 0.8, py + 2.7);
    ctx.stroke();
  }
  ctx.strokeStyle = "rgba(110,58,42,.65)";
  ctx.lineWidth = 0.6;
  ctx.stroke(new Path2D("M-13 2.6C-8.5 7.4 -3 9 2 8.7C8 8.3 12.6 6 16 2.6"));
  ctx.strokeStyle = "rgba(130,74,56,.35)";
  ctx.lineWidth = 0.7;
  ctx.stroke(new Path2D("M-13.4 -5.4C-8 -10.4 4 -11.4 11 -8"));
  // Brow.
  ctx.fillStyle = "#4a3023";
  ctx.fill(new Path2D(
    "M-14.5 14.6C-8 18.4 1 19.6 9 18.6C13.5 17.9 18.4 15.2 22 11.2C16.6 15 12 16.1 7.6 16.4C0 16.9 -8 15.4 -14.9 11.9Z"));
  ctx.restore();
}

export function drawFace(ctx: Context, pupils: Pupils): void {
  ctx.setTransform(1, 0, 0, 1, 0, 0);
  const background = ctx.createLinearGradient(0, 0, WIDTH, HEIGHT);
  background.addColorStop(0, "#9db2b7");
  background.addColorStop(1, "#c9d3cf");
  ctx.fillStyle = background;
  ctx.fillRect(0, 0, WIDTH, HEIGHT);
  toMm(ctx);
  // A few verticals behind the head show where the outline breaks.
  ctx.fillStyle = "rgba(60,84,92,.16)";
  for (let x = -84; x < 84; x += 6) ctx.fillRect(x, -46, 1.2, 92);

  // Ears and head.
  ctx.fillStyle = "#d39d83";
  for (const side of [-1, 1]) {
    ctx.beginPath();
    ctx.ellipse(side * 69, -14, 6.5, 19, side * -0.12, 0, 7);
    ctx.fill();
  }
  // As wide as a mean head at the eyes: a frame of usual width reaches near its outline.
  const head = new Path2D(
    "M-67 60C-69.8 30 -68.4 5 -66 -14C-64 -32 -60 -50 -52 -64L52 -64C60 -50 64 -32 66 -14C68.4 5 69.8 30 67 60Z");
  const skin = ctx.createLinearGradient(-67, 0, 67, 0);
  skin.addColorStop(0, "#b97f66");
  skin.addColorStop(0.14, "#d7a187");
  skin.addColorStop(0.38, "#e9bda4");
  skin.addColorStop(0.62, "#ebc1a9");
  skin.addColorStop(0.86, "#d7a187");
  skin.addColorStop(1, "#b0765e");
  ctx.fillStyle = skin;
  ctx.fill(head);
  ctx.save();
  ctx.clip(head);
  // Cheeks, forehead light, sides of the nose.
  const glow = (x: number, y: number, r: number, colour: string): void => {
    const g = ctx.createRadialGradient(x, y, 0, x, y, r);
    g.addColorStop(0, colour);
    g.addColorStop(1, colour.replace(/[\d.]+\)$/, "0)"));
    ctx.fillStyle = g;
    ctx.fillRect(x - r, y - r, 2 * r, 2 * r);
  };
  glow(-38, -40, 26, "rgba(206,110,92,.32)");
  glow(38, -40, 26, "rgba(206,110,92,.32)");
  glow(0, 44, 40, "rgba(255,232,214,.5)");
  glow(-11, -4, 17, "rgba(150,88,66,.30)");
  glow(11, -4, 17, "rgba(150,88,66,.30)");
  // Nose.
  const bridge = ctx.createLinearGradient(-8, 0, 8, 0);
  bridge.addColorStop(0, "rgba(255,232,216,0)");
  bridge.addColorStop(0.5, "rgba(255,232,216,.75)");
  bridge.addColorStop(1, "rgba(255,232,216,0)");
  ctx.fillStyle = bridge;
  ctx.fill(new Path2D("M-8 12C-5 4 -4.5 -16 -8 -34L8 -34C4.5 -16 5 4 8 12Z"));
  glow(0, -38, 13, "rgba(255,226,208,.6)");
  ctx.strokeStyle = "rgba(120,66,50,.5)";
  ctx.lineWidth = 1;
  ctx.lineCap = "round";
  ctx.stroke(new Path2D("M-16 -37C-19 -42 -15 -46 -10 -44.5"));
  ctx.stroke(new Path2D("M16 -37C19 -42 15 -46 10 -44.5"));
  ctx.restore();
  // Hair at the temples.
  ctx.fillStyle = "#3c271d";
  for (const side of [-1, 1]) {
    ctx.save();
    ctx.scale(side, 1);
    ctx.fill(new Path2D("M75 60C75 30 74 8 70 -13C68 -7 65.6 -6 64.7 -3C64.5 12 64 26 59.5 37C57.7 43 54 48 50 60Z"));
    ctx.restore();
  }
  drawEye(ctx, pupils.right.x, pupils.right.y, -1, pupils.iris);
  drawEye(ctx, pupils.left.x, pupils.left.y, 1, pupils.iris);
  ctx.setTransform(1, 0, 0, 1, 0, 0);
}

// The photograph turned, scaled and moved so that its pupils lie on `pupils`.
export function drawPhoto(
  ctx: Context,
  photo: CanvasImageSource,
  marks: Record<EyeName, { x: number; y: number }>, // pupils in the photograph, its pixels
  pupils: Pupils,
): void {
  ctx.setTransform(1, 0, 0, 1, 0, 0);
  ctx.fillStyle = "#888";
  ctx.fillRect(0, 0, WIDTH, HEIGHT);
  const px = (p: { x: number; y: number }): [number, number] => [
    (p.x - WINDOW.left) * PX_PER_MM,
    (WINDOW.top - p.y) * PX_PER_MM,
  ];
  const [ax, ay] = px(pupils.right);
  const [bx, by] = px(pupils.left);
  const [dx, dy] = [marks.left.x - marks.right.x, marks.left.y - marks.right.y];
  const [ex, ey] = [bx - ax, by - ay];
  const square = dx * dx + dy * dy;
  const c = (ex * dx + ey * dy) / square;
  const k = (ey * dx - ex * dy) / square;
  ctx.setTransform(c, k, -k, c, ax - (c * marks.right.x - k * marks.right.y),
    ay - (k * marks.right.x + c * marks.right.y));
  ctx.drawImage(photo, 0, 0);
  ctx.setTransform(1, 0, 0, 1, 0, 0);
}

// Rim, bridge and temples over the two outlines (mm, viewer's x).
export function drawFrame(
  ctx: Context, outlines: [number, number][][], colour: string, perMm = PX_PER_MM,
): void {
  toMm(ctx, perMm);
  ctx.lineJoin = "round";
  ctx.lineCap = "round";
  ctx.strokeStyle = colour;
  for (const outline of outlines) {
    ctx.lineWidth = 2.6;
    ctx.beginPath();
    outline.forEach(([x, y], i) => (i ? ctx.lineTo(x, y) : ctx.moveTo(x, y)));
    ctx.closePath();
    ctx.stroke();
  }
  const innermost = (outline: [number, number][]): [number, number] =>
    outline.filter(([, y]) => y > 1).reduce((a, b) => (Math.abs(a[0]) < Math.abs(b[0]) ? a : b));
  const outermost = (outline: [number, number][]): [number, number] =>
    outline.filter(([, y]) => y > 4).reduce((a, b) => (Math.abs(a[0]) > Math.abs(b[0]) ? a : b));
  const [a, b] = outlines.map(innermost);
  ctx.lineWidth = 2.8;
  ctx.beginPath();
  ctx.moveTo(a[0], a[1] + 4);
  ctx.quadraticCurveTo(0, a[1] + 9, b[0], b[1] + 4);
  ctx.stroke();
  for (const outline of outlines) {
    const [x, y] = outermost(outline);
    const side = Math.sign(x);
    ctx.fillStyle = colour;
    ctx.beginPath();
    ctx.moveTo(x - side * 0.5, y + 5.2);
    ctx.lineTo(side * Math.max(71, Math.abs(x) + 5), y + 3.4);
    ctx.lineTo(side * Math.max(71, Math.abs(x) + 5), y + 0.4);
    ctx.lineTo(x - side * 0.5, y - 0.4);
    ctx.closePath();
    ctx.fill();
  }
  ctx.setTransform(1, 0, 0, 1, 0, 0);
}
