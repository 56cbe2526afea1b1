// SPDX-License-Identifier: Apache-2.0
#include "optics/gaze.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void Run(CaseRun& run) {
  const auto sphere_lens = [](double f1, double f2, double thickness, double index) {
    Lens lens;
    lens.front = Surface(SphereSurface{f1 / 1000 / (index - 1)});
    lens.back = Surface(SphereSurface{f2 / 1000 / (1 - index)});
    lens.center_thickness_mm = thickness;
    lens.medium.index_d = index;
    return lens;
  };
  const auto at = [](const Lens& lens, double theta_deg, double stop_mm) {
    return EvaluateGaze(lens, lens.medium.index_d, EyePose::OnAxis(lens, stop_mm),
                        {RadiansFromDegrees(theta_deg), 0});
  };
  const double f1 = 8.5 / (1 + 0.004 / 1.523 * 8.5);
  const GazeVergence gaze = at(sphere_lens(f1, -4.5, 4, 1.523), 35, 27);
  run.Within("tangential power", "D", 4, gaze.tangential_D, 0.05, "n, t and s are not stated");
}

}  // namespace

extern const Case kV031;
const Case kV031 = {"V031", "gaze", "+4.00 with a -4.50 back: least tangential error at 35 deg",
                    "perret-optic.ch (Jalie, best form); n, t and s are not stated", Run};

}  // namespace lorgnette::validation
