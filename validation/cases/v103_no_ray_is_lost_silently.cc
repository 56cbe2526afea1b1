// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "optics/trace.h"
#include "validation/random_lens.h"
#include "validation/worst.h"

namespace lorgnette::validation {
namespace {

void RunV103(CaseRun& run) {
  // Grazing rays, rays beside the sag, rays past the critical angle: each has a status and no
  // number that is none; total reflection happens where Snell's law says so, and only there.
  Sampler random(103);
  long not_numbers = 0, wrong_status = 0, reflected = 0, missed = 0;
  for (int i = 0; i < 20000; ++i) {
    Lens lens;
    lens.medium.index_d = random.Uniform(1.3, 1.9);
    lens.front = SphereSurface{random.Signed(1e-4, 1 / 14.0)};
    lens.back = SphereSurface{random.Signed(1e-4, 1 / 14.0)};
    lens.center_thickness_mm = random.Uniform(0.5, 12);
    const Ray ray = RandomRay(random, 18);
    const LensTrace trace = TraceThrough(lens, ray);
    not_numbers += !trace.exit.origin.allFinite() || !trace.exit.direction.allFinite();
    missed += trace.status == RayStatus::kMissesSurface;
    if (trace.status == RayStatus::kMissesSurface) continue;
    const double c = std::abs(trace.inside_direction.dot(trace.second.normal));
    const double sine = lens.medium.index_d * std::sqrt(std::max(0.0, 1 - c * c));
    const bool past = trace.status == RayStatus::kTotalInternalReflection;
    reflected += past;
    if (std::abs(sine - 1) > 1e-12) wrong_status += past != (sine > 1);
  }
  run.Exact("rays with a number that is none", "1", 0, double(not_numbers));
  run.Exact("rays whose total reflection is misjudged", "1", 0, double(wrong_status));
  run.Bound("the sample holds no ray that reflects", "1", reflected > 50 ? 0 : 1, 0, "of 20,000");
  run.Bound("the sample holds no ray that misses", "1", missed > 50 ? 0 : 1, 0, "of 20,000");
  // Into the glass nothing reflects totally, whatever the angle.
  Worst grazing;
  for (double cosine = 1; cosine > 1e-12; cosine /= 3) {
    const double sine = std::sqrt(1 - cosine * cosine);
    const auto in = Refract({sine, 0, cosine}, {0, 0, 1}, 1 / 1.5);
    grazing.Add(in ? in->x() * 1.5 - sine : 1,
                [&] { return fmt::format("cosine {:.1e}", cosine); });
  }
  grazing.Report(run, "Snell's law at grazing incidence", "1", 1e-15, "a few roundings");
}

}  // namespace

extern const Case kV103;
const Case kV103 = {"V103", "hard", "grazing rays, lost rays, total reflection",
                    "optics reference section 13, rows 3 and 11", RunV103};

}  // namespace lorgnette::validation
