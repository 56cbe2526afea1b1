// SPDX-License-Identifier: Apache-2.0
#include "optics/paraxial.h"
#include "optics/power_vector.h"
#include "optics/trace.h"
#include "validation/random_lens.h"
#include "validation/worst.h"

namespace lorgnette::validation {
namespace {

void RunV105(CaseRun& run) {
  // Section 13b, with the worst of a random sample.
  Worst power, reversed, symplectic, turned, transposed, scaled, thin;
  Sampler random(105);
  for (int i = 0; i < 400; ++i) {
    const LensOrder order = RandomOrder(random);
    const auto design = DesignLens(order);
    if (!design) continue;
    const auto where = [&] { return Where(order); };
    const Lens& lens = design->lens;
    const AstigmaticSystem system = SystemOf(lens);
    const PowerVector ordered = PowerVectorOf({order.rx.sphere, order.rx.cylinder, order.rx.axis});
    const Eigen::Matrix2d wanted = LensFrameMatrix(ordered);
    power.Add((system.BackVertexPower() - wanted).cwiseAbs().maxCoeff(), where);
    symplectic.Add(system.SymplecticDefect(), where);

    // A ray sent back along itself returns to where it came from.
    const Ray ray = RandomRay(random, 15);
    const LensTrace there = TraceThrough(lens, ray);
    if (there.status == RayStatus::kOk) {
      const LensTrace back = TraceThrough(
          lens, {there.exit.origin + 20 * there.exit.direction, -there.exit.direction});
      reversed.Add((back.exit.origin - there.first.point).norm() +
                       (back.exit.direction + ray.direction).norm(),
                   where);
    }
    // The lens turned round has its vertex powers exchanged.
    Lens other = lens;
    const auto flipped = [](const Surface& s) -> Surface {
      if (const auto* sphere = std::get_if<SphereSurface>(&s.shape())) {
        return SphereSurface{-sphere->curvature};
      }
      TorusSurface torus = std::get<TorusSurface>(s.shape());
      torus.curvature_generator *= -1;
      torus.curvature_across *= -1;
      return torus;
    };
    other.front = flipped(lens.back);
    other.back = flipped(lens.front);
    turned.Add(
        (SystemOf(other).FrontVertexPower() - system.BackVertexPower()).cwiseAbs().maxCoeff(),
        where);
    // The transposed order is the same lens.
    LensOrder plus = order;
    plus.rx.sphere = order.rx.sphere + order.rx.cylinder;
    plus.rx.cylinder = -order.rx.cylinder;
    plus.rx.axis = AxisDegrees(order.rx.axis.value() + 90);
    plus.center_thickness_mm = lens.center_thickness_mm;
    plus.base_curve = design->front_power;
    if (const auto same = DesignLens(plus)) {
      transposed.Add(
          (SystemOf(same->lens).BackVertexPower() - system.BackVertexPower()).cwiseAbs().maxCoeff(),
          where);
    }
    // All lengths doubled: all powers halved.
    Lens twice = lens;
    const auto stretched = [](const Surface& s) -> Surface {
      if (const auto* sphere = std::get_if<SphereSurface>(&s.shape())) {
        return SphereSurface{sphere->curvature / 2};
      }
      TorusSurface torus = std::get<TorusSurface>(s.shape());
      torus.curvature_generator /= 2;
      torus.curvature_across /= 2;
      return torus;
    };
    twice.front = stretched(lens.front);
    twice.back = stretched(lens.back);
    twice.center_thickness_mm *= 2;
    scaled.Add(
        (2 * SystemOf(twice).BackVertexPower() - system.BackVertexPower()).cwiseAbs().maxCoeff(),
        where);
    // Without thickness the powers add.
    Lens flat = lens;
    flat.center_thickness_mm = 0;
    thin.Add((SystemOf(flat).BackVertexPower() - SurfacePower(lens.front, 1, lens.medium.index_d) -
              SurfacePower(lens.back, lens.medium.index_d, 1))
                 .cwiseAbs()
                 .maxCoeff(),
             where);
  }
  power.Report(run, "back vertex power against the order", "D", 1e-8,
               "kept by the design's own solution");
  symplectic.Report(run, "A'D - C'B - I", "1", 1e-13, "roundings of powers up to 20 D");
  reversed.Report(run, "a ray sent back misses itself by", "mm", 1e-11, "roundings over 2 m");
  turned.Report(run, "the lens turned round", "D", 1e-12, "the same sums in another order");
  transposed.Report(run, "the transposed order", "D", 1e-10, "two solutions of one design");
  scaled.Report(run, "all lengths doubled", "D", 1e-13, "powers of two are exact");
  thin.Report(run, "no thickness", "D", 1e-13, "a few roundings");
}

}  // namespace

extern const Case kV105;
const Case kV105 = {"V105", "hard", "properties of random designs, with the worst of each",
                    "optics reference section 13b", RunV105};

}  // namespace lorgnette::validation
