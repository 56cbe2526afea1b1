// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <optional>
#include <vector>

#include "optics/trace.h"
#include "validation/case.h"
#include "validation/lab_jobs.h"

namespace lorgnette::validation {
namespace {

constexpr double kTool = 530;  // mm times dioptres: tooling index 1.530

// How a lens of the job's front, generator curves, axis and centre thickness differs at the edge
// from what the lab's own software states: mean, and scatter about it.
struct EdgeDifference {
  double mean_mm = 0, scatter_mm = 0;
};
std::optional<EdgeDifference> Compare(const OmaFile& job, const OmaTrace& trace, double turn_deg,
                                      double inward) {
  const bool right = trace.eye == Eye::kRight;
  const auto number = [&](const char* label) -> double {
    const auto pair = job.Numbers(label);
    return pair ? (right ? pair->right : pair->left).value_or(NAN) : NAN;
  };
  const double axis = RadiansFromDegrees(number("AX") + turn_deg);
  Lens lens;
  lens.medium.index_d = number("LIND");
  lens.center_thickness_mm = number("CTHICK");
  lens.front = SphereSurface{OmaCurveDiopters(number("FRNT")) / kTool};
  // Minus is hollow toward the eye; a TABO meridian A lies at pi - A in the lens frame.
  lens.back =
      TorusSurface{-number("GCROS") / kTool, -number("GBASE") / kTool, kPi - axis + kPi / 2};
  // Optical centre from the boxing centre; in is toward the nose, +x of the right eye's opening.
  const Eigen::Vector2d centre((right ? 1 : -1) * inward * number("FCOCIN"), number("FCOCUP"));
  const auto stated = job.EdgeThickness(trace.eye);
  if (!stated || stated->empty()) return std::nullopt;
  std::vector<double> difference;
  const std::size_t n = stated->size(), points = trace.contour_mm.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d p = trace.contour_mm[i * points / n] - centre;
    const Ray along{{-p.x(), p.y(), -50}, {0, 0, 1}};
    const auto front = lens.front.Intersect(along);
    const auto back = IntersectBack(lens, along);
    if (!front || !back) return std::nullopt;
    difference.push_back(back->point.z() - front->point.z() - (*stated)[i]);
  }
  EdgeDifference result;
  for (const double d : difference) result.mean_mm += d / double(n);
  for (const double d : difference) {
    result.scatter_mm += std::pow(d - result.mean_mm, 2) / double(n);
  }
  result.scatter_mm = std::sqrt(result.scatter_mm);
  return result;
}

void RunV096(CaseRun& run) {
  if (!HasJobs()) return run.Skip("no lab jobs on this machine ($LORGNETTE_JOBS)");
  const auto job = ReadJob("STHKFMT.oma");
  const auto traces =
      job ? job->Traces() : Result<std::vector<OmaTrace>>(tl::unexpected<Error>(job.error()));
  if (!traces) return run.Bound(traces.error().message, "1", 1, 0, "the job can be read");
  for (const OmaTrace& trace : *traces) {
    const std::string eye = trace.eye == Eye::kRight ? "R " : "L ";
    const auto found = Compare(*job, trace, 0, 1);
    const auto turned = Compare(*job, trace, 90, 1), mirrored = Compare(*job, trace, 0, -1);
    if (!found || !turned || !mirrored) {
      return run.Bound(eye + "the job has edges", "1", 1, 0, "it states 72 thicknesses an eye");
    }
    run.Bound(eye + "edge thickness, scatter of 72 differences", "mm", found->scatter_mm, 0.25,
              "a progressive's back is not quite the torus of its generator curves");
    run.Within(eye + "edge thickness, mean difference", "mm", 0, found->mean_mm, 1,
               "the centre thickness is stated for a layout point that the file does not name");
    run.Bound(eye + "scatter over that with the axis turned by 90 deg", "1",
              found->scatter_mm / turned->scatter_mm, 0.5, "the axis is read the right way");
    run.Bound(eye + "scatter over that with the centre on the other side", "1",
              found->scatter_mm / mirrored->scatter_mm, 0.5, "in is toward the nose");
  }
}

}  // namespace

extern const Case kV096;
const Case kV096 = {"V096", "lab", "edge thickness of a real job's pair, from its curves",
                    "eeng/lens_protocol, STHKFMT.oma: a lab's own thicknesses at 72 angles",
                    RunV096};

}  // namespace lorgnette::validation
