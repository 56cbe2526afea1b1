// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "optics/magnification.h"
#include "optics/paraxial.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV042(CaseRun& run) {
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
  run.Exact("F'v xx", "D", -5.83095100622945443, f(0, 0), 12);
  run.Exact("F'v xy", "D", -0.362171565130867923, f(0, 1), 12);
  run.Exact("F'v yy", "D", -0.793949151470178966, f(1, 1), 12);
  const Eigen::Matrix2d e = lens.EquivalentPower();
  run.Exact("asymmetry of Fe", "D", 0.01875, std::abs(e(0, 1) - e(1, 0)), 12);
  const Eigen::Matrix2d m = SpectacleMagnification(lens, 15);
  run.Exact("SM xx", "1", 0.939448055719134886, m(0, 0), 12);
  run.Exact("SM xy", "1", -0.00898222934930535638, m(0, 1), 12);
  run.Exact("SM yx", "1", -0.00925024338818408985, m(1, 0), 12);
  run.Exact("SM yy", "1", 1.01444873605096509, m(1, 1), 12);
  run.Bound("symplectic defect", "1", lens.SymplecticDefect(), 1e-14, "a few roundings");
}

}  // namespace

extern const Case kV042;
const Case kV042 = {"V042", "paraxial", "C2: obliquely crossed thick cylinders, n 1.6, 5 mm",
                    "reference section 14, recomputed with 40 digits", RunV042};

}  // namespace lorgnette::validation
