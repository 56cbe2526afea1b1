// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <variant>

#include "validation/cost/lens_methods.h"
#include "validation/cost/studies.h"

namespace lorgnette::validation {
namespace {

// Whether the long double tracer knows the surface.
bool HasReference(const Surface& surface) {
  return std::holds_alternative<SphereSurface>(surface.shape()) ||
         std::holds_alternative<TorusSurface>(surface.shape()) ||
         std::holds_alternative<ConicSurface>(surface.shape());
}

constexpr double kSamplesPerPixel = 4, kEyes = 2;

}  // namespace

Result<CostStudy> LensStudy(const Lens& lens, const CostOptions& options) {
  if (!HasReference(lens.front) || !HasReference(lens.back)) {
    return UsageError(
        "cost: the reference has no rays for this surface; possible: spheres, tori, "
        "conics");
  }
  const CameraRays rays(lens, options.view);
  const LensReference reference = TraceReference(lens, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (rays.inside(i) && !reference.design[i].ok) {
      return Failure(
          fmt::format("cost: a ray is lost inside {} x {} mm of the lens; possible: a "
                      "smaller outline",
                      options.view.width_mm, options.view.height_mm));
    }
  }
  std::vector<LensMethod> methods = WarpMethods(lens, rays);
  LG_ASSIGN(std::vector<LensMethod> meshes, MeshMethods(lens, rays, options.most_triangles));
  for (std::vector<LensMethod> more :
       {std::move(meshes), MapMethods(lens, rays), AnalyticMethods(lens, rays)}) {
    std::move(more.begin(), more.end(), std::back_inserter(methods));
  }

  CostStudy study;
  study.name = "lens";
  study.title = "One lens: rays from the camera to the face";
  study.reference = fmt::format("long double rays, {} of them a pixel apart", rays.inside_count());
  study.time_unit = "ns/ray";
  const double per_frame = options.rays_per_frame > 0
                               ? options.rays_per_frame
                               : kEyes * kSamplesPerPixel * double(rays.inside_count());
  study.ms_per_frame = per_frame * 1e-6;
  study.units = LensUnits();
  for (const LensMethod& method : methods) {
    const Timing timing = TimeOf(method.trace, options.stopwatch);
    CostPoint point;
    point.method = method.method;
    point.parameter = method.parameter;
    point.time = timing.median_ns / double(rays.inside_count());
    point.time_spread = timing.spread_ns / double(rays.inside_count());
    SetErrors(rays, reference, method.answer(), point);
    study.points.push_back(std::move(point));
  }
  MarkFront(study);
  return study;
}

}  // namespace lorgnette::validation
