// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "optics/magnification.h"
#include "optics/paraxial.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void Run(CaseRun& run) {
  // Long's matrices of +6 +3 x 30 and -9 -4 x 75, axes as drawn (math angle from +x).
  const auto power = [](double sphere, double cylinder, double axis_deg) {
    const double a = RadiansFromDegrees(axis_deg), s = std::sin(a), c = std::cos(a);
    Eigen::Matrix2d f;
    f << sphere + cylinder * s * s, -cylinder * s * c, -cylinder * s * c, sphere + cylinder * c * c;
    return f;
  };
  const AstigmaticSystem lens =
      AstigmaticSystem::ThickLens(power(6, 3, 30), power(-9, -4, 75), 5, 1.6);
  const Eigen::Matrix2d f = lens.BackVertexPower();
  run.Exact("F'v xx", "D", -5.830951006, f(0, 0), 9);
  run.Exact("F'v xy", "D", -0.3621715651, f(0, 1), 9);
  run.Exact("F'v yy", "D", -0.7939491515, f(1, 1), 9);
  const Eigen::Matrix2d e = lens.EquivalentPower();
  run.Exact("asymmetry of Fe", "D", 0.01875, std::abs(e(0, 1) - e(1, 0)), 9);
  const Eigen::Matrix2d m = SpectacleMagnification(lens, 15);
  run.Exact("SM xx", "1", 0.93944806, m(0, 0), 8);
  run.Exact("SM xy", "1", -0.0089822293, m(0, 1), 8);
  run.Exact("SM yx", "1", -0.0092502434, m(1, 0), 8);
  run.Exact("SM yy", "1", 1.0144487, m(1, 1), 7);
  run.Bound("symplectic defect", "1", lens.SymplecticDefect(), 1e-14, "a few roundings");
}

}  // namespace

extern const Case kV042;
const Case kV042 = {"V042", "paraxial", "C2: obliquely crossed thick cylinders, n 1.6, 5 mm",
                    "derived with 30 digits, skew rays to 1e-20", Run};

}  // namespace lorgnette::validation
