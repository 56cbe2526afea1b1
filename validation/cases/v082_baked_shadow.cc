// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "render/compositor.h"
#include "validation/case.h"
#include "validation/straight_eyewear.h"

namespace lorgnette::validation {
namespace {

// A bar across the brow, 90 x 4 x 4 mm, 8 mm before the face.
FramePart Bar() {
  FramePart part;
  part.name = "bar";
  part.kind = FramePartKind::kFront;
  TriangleMesh& mesh = part.mesh;
  constexpr double kHalf[] = {45, 2, 2};
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Eigen::Vector3d normal = Eigen::Vector3d::Zero();
      normal[axis] = side;
      const int first = int(mesh.positions.size());
      for (int corner = 0; corner < 4; ++corner) {
        Eigen::Vector3d p;
        p[axis] = side * kHalf[axis];
        p[(axis + 1) % 3] = (corner % 2 ? 1 : -1) * kHalf[(axis + 1) % 3];
        p[(axis + 2) % 3] = (corner / 2 ? 1 : -1) * kHalf[(axis + 2) % 3];
        mesh.positions.push_back(p + Eigen::Vector3d(-kStraightHalfPd_mm, 24, 8));
        mesh.normals.push_back(normal);
      }
      const bool outward = side > 0;
      const auto add = [&](int a, int b, int c) {
        mesh.triangles.emplace_back(first + a, first + (outward ? b : c),
                                    first + (outward ? c : b));
      };
      add(0, 1, 3);
      add(0, 3, 2);
    }
  }
  return part;
}

void RunV082(CaseRun& run) {
  constexpr int kSize = 100;
  constexpr double kShadowFocal_px = 500;
  LensOrder order;
  order.medium.index_d = 1.6;
  auto eyewear = StraightEyewear(order);
  if (!eyewear) return;
  eyewear->frame.parts.push_back(Bar());
  // A sky with a lamp, above and to one side.
  ImageRgbF map(64, 32);
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      const bool lamp = std::abs(x - 26) < 4 && std::abs(y - 8) < 3;
      for (int c = 0; c < 3; ++c) map.at(x, y)[c] = lamp ? 6.0f : 0.8f;
    }
  }
  const Environment environment(std::move(map));
  const StraightView view = ViewOnRightAxis(600, kSize, kShadowFocal_px);
  ImageRgbF grey(kSize, kSize);
  for (float& v : grey.data) v = 0.5f;
  const auto render = [&](ShadowMode mode) {
    CompositorOptions options;
    options.shadow = mode;
    options.shadow_rays = 1280;
    options.effects = EffectSet::None();
    options.effects.Set(Effect::kShadow, true);
    const auto compositor =
        Compositor::Create(*eyewear, FlatFace(0, 40), TriangleMesh{}, environment, options);
    return compositor ? compositor->Render(grey, view.camera, view.camera_from_head) : grey;
  };
  const ImageRgbF paper = render(ShadowMode::kPaper), baked = render(ShadowMode::kBaked);
  double squares = 0, darkest = 1;
  long shaded = 0;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      // Rows below the bar, above the lens: skin alone.
      const double truth = double(paper.at(x, y)[1]) / 0.5, found = double(baked.at(x, y)[1]) / 0.5;
      const double height_mm = (0.5 * kSize - y - 0.5) * 600 / kShadowFocal_px;
      if (height_mm < 18.6 || height_mm > 21.5 || std::abs(x - kSize / 2) > 25) continue;
      if (truth > 0.995) continue;
      ++shaded;
      darkest = std::min(darkest, truth);
      squares += (found - truth) * (found - truth);
    }
  }
  run.Bound("shadow pixels missing", "1", shaded > 40 ? 0 : 1, 0, "the bar shades its neighbours");
  run.Within("darkest ratio of the oracle", "1", 0.55, darkest, 0.35,
             "the bar hides part of the sky");
  run.Bound("baked against rays at every pixel, root mean square", "1",
            std::sqrt(squares / double(std::max(1L, shaded))), 0.02, "asked of the baked shadow");
}

}  // namespace

extern const Case kV082;
const Case kV082 = {"V082", "image", "the baked shadow against 1280 rays at every pixel",
                    "Algorithm 1 of Zhang et al. 2017, as the oracle", RunV082};

}  // namespace lorgnette::validation
