// SPDX-License-Identifier: Apache-2.0
#include "optics/power_vector.h"
#include "optics/wear.h"
#include "validation/case.h"

namespace lorgnette::validation {
namespace {

void RunV049(CaseRun& run) {
  // The source's axis is TABO in axes (viewer's right, up).
  const Eigen::Matrix2d f =
      LongMatrix(PowerVectorOf({Diopters(-5), Diopters(-3), AxisDegrees(25)}));
  const Eigen::Matrix2d tilted = ThinTilted(f, RadiansFromDegrees(18), 0, 1.6);
  run.Exact("F xx", "D", -5.70944766, tilted(0, 0), 8);
  run.Exact("F xy", "D", 1.24609498, tilted(0, 1), 8);
  run.Exact("F yy", "D", -8.51102334, tilted(1, 1), 8);
}

}  // namespace

extern const Case kV049;
const Case kV049 = {
    "V049", "wear", "C9: -5.00 -3.00 x 25 tilted by 18 deg about the horizontal, n 1.6",
    "derived; thin lens, chief ray through the vertex, checked by skew rays", RunV049};

}  // namespace lorgnette::validation
