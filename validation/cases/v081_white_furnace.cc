// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "render/compositor.h"
#include "validation/case.h"
#include "validation/straight_eyewear.h"

namespace lorgnette::validation {
namespace {

void RunV081(CaseRun& run) {
  constexpr int kSize = 200;
  for (const double power : {-6.0, 5.0}) {
    LensOrder order;
    order.rx.sphere = Diopters(power);
    order.medium.index_d = 1.6;
    const auto eyewear = StraightEyewear(order);
    if (!eyewear) return;
    const StraightView view = ViewOnRightAxis(600, kSize, 2000);
    const auto compositor =
        Compositor::Create(*eyewear, FlatFace(-3), TriangleMesh{}, Environment::Constant({1, 1, 1}),
                           CompositorOptions{});
    if (!compositor) return;
    ImageRgbF white(kSize, kSize);
    std::fill(white.data.begin(), white.data.end(), 1.0f);
    const ImageRgbF picture = compositor->Render(white, view.camera, view.camera_from_head);
    // The middle of the lens, where no ray meets the edge wall.
    double sum = 0, worst = 0;
    long count = 0;
    for (int y = kSize / 2 - 40; y < kSize / 2 + 40; ++y) {
      for (int x = kSize / 2 - 40; x < kSize / 2 + 40; ++x) {
        const double light = double(picture.at(x, y)[1]);
        sum += light;
        worst = std::max(worst, std::abs(light - 1));
        ++count;
      }
    }
    const std::string name = fmt::format("{:+g} D: ", power);
    run.Within(name + "mean radiance through the lens", "1", 1, sum / double(count), 1e-3,
               "asked: no lens is seen in a white furnace");
    run.Bound(name + "pixel farthest from 1", "1", worst, 6e-3,
              "branches of the ray tree below 0.004 of their pixel are left out");
  }
}

}  // namespace

extern const Case kV081;
const Case kV081 = {"V081", "image", "a white furnace shows no lens: energy is conserved",
                    "R + T = 1 at every surface", RunV081};

}  // namespace lorgnette::validation
