// SPDX-License-Identifier: Apache-2.0
#include "optics/paraxial.h"
#include "optics/prism.h"
#include "validation/random_lens.h"
#include "validation/worst.h"

namespace lorgnette::validation {
namespace {

void RunV106(CaseRun& run) {
  Worst slope, cubic;
  Sampler random(106);
  for (int i = 0; i < 400; ++i) {
    const LensOrder order = RandomOrder(random);
    const auto design = DesignLens(order);
    if (!design) continue;
    const double n = order.medium.index_d;
    // Prism over the height of the ray on the front surface: the equivalent power.
    const Eigen::Matrix2d fe = SystemOf(design->lens).EquivalentPower();
    const double a = random.Uniform(0, 2 * kPi);
    const Eigen::Vector2d along(std::cos(a), std::sin(a));
    const auto departure = [&](double height_mm) -> double {
      const auto prism = PrismAt(design->lens, n, height_mm * along);
      if (!prism) return 1e9;
      // 100 tan of the deviation a cm: D.
      return (*prism / (0.1 * height_mm) + fe * along).norm();
    };
    slope.Add(departure(0.01), [&] { return Where(order); });
    if (departure(2) > 1e-3) {
      cubic.Add(departure(2) / departure(1) - 4, [&] { return Where(order); });
    }
  }
  slope.Report(run, "prism a centimetre at 0.01 mm against the equivalent power", "D", 1e-6,
               "the square of 0.01 mm over the radii, times the power");
  cubic.Report(run, "departure at 2 mm over that at 1 mm, less 4", "1", 0.1,
               "the next order is the fourth");
}

}  // namespace

extern const Case kV106;
const Case kV106 = {"V106", "hard", "Prentice's rule is the derivative of the traced prism",
                    "optics reference section 13b", RunV106};

}  // namespace lorgnette::validation
