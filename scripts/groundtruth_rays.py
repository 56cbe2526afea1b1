# SPDX-License-Identifier: Apache-2.0
"""Shapes, exact rays and files of the path-traced set; knows numpy alone, nothing of Blender.

Millimetres. Lens frame: origin at the back vertex, +z along the axis away from the face, +x to the
wearer's left (render/compose.h).
"""

import struct

import numpy as np

A_MM, B_MM, POWER = 46.0, 34.0, 2.6  # box of the lens and exponent of its superellipse


def outline(points=240, grow=0.0):
    """The lens' outline, moved outward by `grow` along its normal; (points, 2)."""
    t = 2 * np.pi * np.arange(points) / points
    c, s = np.cos(t), np.sin(t)
    p = np.stack([A_MM / 2 * np.sign(c) * np.abs(c) ** (2 / POWER),
                  B_MM / 2 * np.sign(s) * np.abs(s) ** (2 / POWER)], axis=1)
    n = np.stack([np.sign(p[:, 0]) * np.abs(2 * p[:, 0] / A_MM) ** (POWER - 1) / A_MM,
                  np.sign(p[:, 1]) * np.abs(2 * p[:, 1] / B_MM) ** (POWER - 1) / B_MM], axis=1)
    return p + grow * n / np.linalg.norm(n, axis=1, keepdims=True)


def inside(x, y):
    """Within the outline as the files state it: a polygon."""
    p = outline()
    q = np.roll(p, -1, axis=0)
    odd = np.zeros(np.shape(x), bool)
    for (ax, ay), (bx, by) in zip(p, q):
        crosses = (ay > y) != (by > y)
        with np.errstate(divide="ignore", invalid="ignore"):
            odd ^= crosses & (x < ax + (y - ay) / (by - ay) * (bx - ax))
    return odd


class SphereLens:
    """Two spheres by an order: exact back vertex power."""

    def __init__(self, sphere_D, index, front_D, thickness_mm):
        self.sphere_D, self.index, self.front_D = sphere_D, index, front_D
        self.thickness = thickness_mm
        self.back_D = sphere_D - front_D / (1 - thickness_mm / 1000 / index * front_D)
        self.r1 = 1000 * (index - 1) / front_D
        self.r2 = 1000 * (1 - index) / self.back_D

    @staticmethod
    def sag(radius, x, y):
        return (x * x + y * y) / (radius + np.sign(radius) * np.sqrt(radius**2 - x * x - y * y))

    def front(self, x, y):
        """Points and outward normals of the front."""
        z = self.thickness - self.sag(self.r1, x, y)
        return np.stack([x, y, z], -1), self._normal(self.r1, x, y)

    def back(self, x, y):
        return np.stack([x, y, -self.sag(self.r2, x, y)], -1), -self._normal(self.r2, x, y)

    @staticmethod
    def _normal(radius, x, y):
        n = np.stack([x / radius, y / radius, np.sqrt(1 - (x * x + y * y) / radius**2)], -1)
        return n / np.linalg.norm(n, axis=-1, keepdims=True)

    @staticmethod
    def _meet(origin, direction, vertex_z, radius):
        """Distance to the sheet of the vertex, and the unit normal toward +z."""
        centre = np.array([0, 0, vertex_z - radius])
        oc = origin - centre
        b = np.sum(oc * direction, -1)
        root = np.sqrt(np.maximum(0, b * b - np.sum(oc * oc, -1) + radius * radius))
        near, far = -b - root, -b + root
        # The sheet that holds the vertex: that side of the centre where the vertex lies.
        z_near = (oc + near[..., None] * direction)[..., 2]
        t = np.where(z_near * radius > 0, near, far)
        p = origin + t[..., None] * direction
        return p, (p - centre) / radius

    @staticmethod
    def _refract(d, normal, eta):
        """`normal` toward +z, d toward -z; eta = before / after. NaN on total reflection."""
        cos1 = -np.sum(d * normal, -1)
        k = 1 - eta * eta * (1 - cos1 * cos1)
        with np.errstate(invalid="ignore"):
            cos2 = np.sqrt(k)
        return eta * d + ((eta * cos1) - cos2)[..., None] * normal

    def trace(self, origin, direction):
        """Rays from before the lens, (n, 3): where they enter, where and whither they leave, and
        whether they do so within the outline (entered, left)."""
        p1, n1 = self._meet(origin, direction, self.thickness, self.r1)
        entered = inside(p1[:, 0], p1[:, 1])
        d1 = self._refract(direction, n1, 1 / self.index)
        p2, n2 = self._meet(p1, d1, 0.0, self.r2)
        d2 = self._refract(d1, n2, self.index)
        left = entered & inside(p2[:, 0], p2[:, 1]) & np.isfinite(d2).all(-1)
        return p1, p2, d2, entered, left


def skin_height(x, y):
    """Depth of the face over (x, y): cheeks, a nose, two eyeballs whose apex is at z = 0."""
    face = -x * x / 95 - np.maximum(0, np.abs(y + 15) - 35) ** 2 / 90 - 1
    down = np.minimum(y - 6, 0)
    ridge = 9.5 - 0.5 * down + 0.3 * np.maximum(y - 6, 0)
    tip = np.maximum(0, -y - 42)
    nose = ridge - (1.85 + 0.011 * down) * (np.sqrt(x * x + 10) - np.sqrt(10)) - 0.35 * tip * tip
    r2 = (np.abs(x) - 32) ** 2 + y * y
    eye = np.where(r2 < 143, np.sqrt(np.maximum(1, 144 - r2)) - 12, -100)
    return np.maximum(np.maximum(face, nose), eye)


def head_mesh(step=1.0):
    x = np.arange(-74, 74 + step / 2, step)
    y = np.arange(-80, 60 + step / 2, step)
    gx, gy = np.meshgrid(x, y)
    points = np.stack([gx, gy, skin_height(gx, gy)], -1).reshape(-1, 3)
    a = (np.arange(len(y) - 1)[:, None] * len(x) + np.arange(len(x) - 1)[None, :]).ravel()
    n = len(x)
    return points, np.concatenate([np.stack([a, a + 1, a + n + 1], 1),
                                   np.stack([a, a + n + 1, a + n], 1)])


def _sweep(rings):
    """Closed tube through rings of points, (k, m, 3), whose ends meet."""
    k, m, _ = rings.shape
    i, j = np.meshgrid(np.arange(k), np.arange(m), indexing="ij")
    at = lambda u, v: ((u % k) * m + v % m).ravel()
    quads = np.stack([at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)], 1)
    return rings.reshape(-1, 3), np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def _bar(start, end, half_y, half_z):
    """A box between two points that lie apart in x or z."""
    start, end = np.array(start, float), np.array(end, float)
    along = (end - start) / np.linalg.norm(end - start)
    across = np.cross([0, 1, 0], along)
    corners = [half_y * s * np.array([0, 1, 0]) + half_z * t * across
               for s, t in ((1, 1), (1, -1), (-1, -1), (-1, 1))]
    p = np.array([start + c for c in corners] + [end + c for c in corners])
    quads = [[0, 1, 2, 3], [7, 6, 5, 4]] + [[j, j + 4, (j + 1) % 4 + 4, (j + 1) % 4]
                                           for j in range(4)]
    q = np.array(quads)
    return p, np.concatenate([q[:, [0, 1, 2]], q[:, [0, 2, 3]]])


def frame_mesh():
    """Rims, bridge and temples in frame coordinates: lens frames of the two eyes, 64 mm apart."""
    parts = []
    section = [(-0.4, -4.0), (2.2, -4.0), (2.6, -3.6), (2.6, 0.8), (2.2, 1.2), (-0.4, 1.2)]
    for side in (-32, 32):
        rings = np.stack([np.column_stack([outline(240, grow), np.full(240, z)])
                          for grow, z in section], axis=1)
        points, triangles = _sweep(rings)
        parts.append((points + [side, 0, 0], triangles[:, ::-1]))
    parts.append(_bar((-10, 5, -0.5), (10, 5, -0.5), 1.6, 1.6))
    for side in (-1, 1):
        parts.append(_bar((side * 56, 6, -1.5), (side * 80, 6 - 4, -74), 1.8, 0.9))
    points, triangles, first = [], [], 0
    for p, t in parts:
        points.append(p)
        triangles.append(t + first)
        first += len(p)
    return np.concatenate(points), np.concatenate(triangles)


def lens_mesh(lens, around=480, rings=110):
    """Points, triangles, and a normal for each corner of each triangle."""
    rim = outline(around)
    share = np.arange(1, rings + 1) / rings
    grid = share[:, None, None] * rim[None]
    points, triangles, normals = [], [], []
    for surface, turned in ((lens.front, False), (lens.back, True)):
        first = sum(len(p) for p in points)
        xy = np.concatenate([np.zeros((1, 2)), grid.reshape(-1, 2)])
        p, n = surface(xy[:, 0], xy[:, 1])
        j = np.arange(around)
        after = (j + 1) % around
        t = [np.stack([0 * j, 1 + j, 1 + after], 1)]
        for ring in range(rings - 1):
            a, b = 1 + ring * around, 1 + (ring + 1) * around
            t += [np.stack([a + j, b + j, b + after], 1), np.stack([a + j, b + after, a + after], 1)]
        t = np.concatenate(t)
        t = t[:, ::-1] if turned else t
        points.append(p)
        triangles.append(t + first)
        normals.append(n[t])
    count = len(points[0])
    j = np.arange(around)
    after = (j + 1) % around
    f, b = 1 + (rings - 1) * around, count + 1 + (rings - 1) * around
    wall = np.concatenate([np.stack([f + j, b + j, b + after], 1),
                           np.stack([f + j, b + after, f + after], 1)])
    all_points = np.concatenate(points)
    edge = all_points[wall]
    flat = np.cross(edge[:, 1] - edge[:, 0], edge[:, 2] - edge[:, 0])
    flat /= np.linalg.norm(flat, axis=1, keepdims=True)
    triangles.append(wall)
    normals.append(np.repeat(flat[:, None], 3, axis=1))
    return all_points, np.concatenate(triangles), np.concatenate(normals)


def environment_map(width=512, height=256):
    """A sky, a soft lamp and a window; rows from the top, columns as render/environment.h has it."""
    lon = 2 * np.pi * ((np.arange(width) + 0.5) / width - 0.5)[None, :]
    lat = np.pi * (0.5 - (np.arange(height) + 0.5) / height)[:, None]
    d = np.stack(np.broadcast_arrays(-np.sin(lon) * np.cos(lat), np.sin(lat),
                                     np.cos(lon) * np.cos(lat)), -1)
    spot = lambda at, width_rad: np.exp(-0.5 * (np.arccos(np.clip(
        d @ (np.array(at) / np.linalg.norm(at)), -1, 1)) / width_rad) ** 2)
    sky = 0.45 + 0.25 * d[..., 1:2] + 0.1 * np.array([-0.3, 0.0, 0.4])
    light = sky + 6 * spot((0.55, 0.6, 0.75), 0.16)[..., None] * np.array([1, 0.93, 0.8])
    light = light + 3 * spot((-0.8, 0.25, 0.7), 0.25)[..., None] * np.array([0.8, 0.95, 1.1])
    return light.astype(np.float32)


def write_obj(path, points, triangles):
    with open(path, "w", encoding="utf-8") as file:
        for p in points:
            file.write("v %.6f %.6f %.6f\n" % tuple(p))
        for t in triangles + 1:
            file.write("f %d %d %d\n" % tuple(t))


def write_exr(path, image):
    """Rows from the top, 3 or 4 channels, 32-bit floats, not compressed."""
    height, width, channels = image.shape
    names = sorted("RGBA"[:channels])
    text = lambda s: s.encode() + b"\0"

    def attribute(name, kind, value):
        return text(name) + text(kind) + struct.pack("<i", len(value)) + value

    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = struct.pack("<ii", 20000630, 2) + attribute(
        "channels", "chlist",
        b"".join(text(n) + struct.pack("<iBxxxii", 2, 0, 1, 1) for n in names) + b"\0")
    header += attribute("compression", "compression", b"\0")
    header += attribute("dataWindow", "box2i", box) + attribute("displayWindow", "box2i", box)
    header += attribute("lineOrder", "lineOrder", b"\0")
    header += attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
    header += attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0))
    header += attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0"
    row = 4 * width * channels
    start = len(header) + 8 * height
    planes = np.stack([image[..., "RGBA".index(n)] for n in names], 1).astype("<f4")
    with open(path, "wb") as file:
        file.write(header)
        file.write(struct.pack(f"<{height}Q", *(start + y * (row + 8) for y in range(height))))
        for y in range(height):
            file.write(struct.pack("<ii", y, row) + planes[y].tobytes())
