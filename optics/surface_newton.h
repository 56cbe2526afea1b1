// SPDX-License-Identifier: Apache-2.0
// What every surface that is not a sphere shares: Newton's method on z - sag(x, y) along a ray.
#pragma once

#include <optional>

#include "optics/surface.h"

namespace lorgnette {

// Intersection of `ray` with the graph of `surface`. Starts on the sphere of the mean vertex
// curvature and takes Newton steps (about 4); where a step leaves the surface's domain or the
// iteration does not settle within 20, a scan of the ray brackets the crossing and bisection
// finishes. Of several crossings the one whose normal . direction has the sign of direction.z.
// Tested: within 1e-12 mm of the surface; sphere as a torus equals the closed form.
std::optional<SurfaceHit> IntersectGraph(const Surface& surface, const Ray& ray);

}  // namespace lorgnette
