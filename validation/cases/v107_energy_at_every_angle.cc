// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "optics/thin_film.h"
#include "optics/trace.h"
#include "validation/random_lens.h"
#include "validation/worst.h"

namespace lorgnette::validation {
namespace {

void RunV107(CaseRun& run) {
  Worst energy, reciprocity, bare;
  Sampler random(107);
  for (int i = 0; i < 5000; ++i) {
    FilmStack stack;
    stack.index_after = random.Uniform(1.45, 1.9);
    const int layers = int(random.Uniform(0, 4));
    for (int k = 0; k < layers; ++k) {
      stack.layers.push_back({random.Uniform(1.3, 2.4), random.Uniform(5, 400), 0});
    }
    const double wavelength = random.Uniform(380, 780), cosine = random.Log(1e-3, 1);
    const auto where = [&] {
      return fmt::format("{} layers, {:.0f} nm, cosine {:.3g}", layers, wavelength, cosine);
    };
    const auto power = FilmPower(stack, wavelength, cosine);
    energy.Add(std::max(std::abs(power.rs + power.ts - 1), std::abs(power.rp + power.tp - 1)),
               where);
    // Met from the other side, along the same ray, it lets through as much.
    const double sine = std::sqrt(1 - cosine * cosine) / stack.index_after;
    const auto other = FilmPower(Reversed(stack), wavelength, std::sqrt(1 - sine * sine));
    reciprocity.Add(std::max(std::abs(power.ts - other.ts), std::abs(power.tp - other.tp)), where);
    FilmStack none;
    none.index_after = stack.index_after;
    const auto fresnel = FilmPower(none, wavelength, cosine);
    bare.Add(fresnel.reflectance() - FresnelReflectance(cosine, 1 / none.index_after), where);
  }
  energy.Report(run, "R + T - 1, both polarisations", "1", 1e-12, "roundings of complex products");
  reciprocity.Report(run, "transmittance from the other side", "1", 1e-10,
                     "the cosine inside from the sine loses digits at grazing incidence");
  bare.Report(run, "no layers against Fresnel's formulas", "1", 1e-14, "a few roundings");
}

}  // namespace

extern const Case kV107;
const Case kV107 = {"V107", "hard", "coats neither make nor lose light at any angle",
                    "optics reference section 13b", RunV107};

}  // namespace lorgnette::validation
