// SPDX-License-Identifier: Apache-2.0
#include "optics/media.h"

#include <fmt/format.h>

#include <cctype>

namespace lorgnette {
namespace {

// 1/lambda_F^2 - 1/lambda_C^2, 1/nm^2.
constexpr double kSpread = 1 / (kLineF_nm * kLineF_nm) - 1 / (kLineC_nm * kLineC_nm);

std::string Simplified(std::string_view name) {
  std::string simple;
  for (const char c : name) {
    const auto u = static_cast<unsigned char>(c);
    if (std::isalnum(u)) simple += char(std::tolower(u));
  }
  return simple;
}

}  // namespace

const std::vector<MediumEntry>& StandardMedia() {
  static const std::vector<MediumEntry> media = {
      {{"CR-39", 1.498, 58, 1.32}, 2.0, 1.0, {"1.50", "1.5", "plastic"}},
      {{"crown glass", 1.523, 58.6, 2.54}, 2.0, 1.0, {"crown", "glass", "1.523"}},
      {{"Trivex", 1.532, 44, 1.11}, 1.3, 1.0, {"1.53"}},
      {{"polycarbonate", 1.586, 30, 1.20}, 1.5, 1.0, {"poly", "pc", "1.59"}},
      {{"1.60", 1.594, 41, 1.30}, 1.2, 1.0, {"1.6", "mr-8"}},
      {{"1.67", 1.660, 32, 1.36}, 1.2, 1.0, {"mr-7", "mr-10"}},
      {{"1.74", 1.732, 33, 1.47}, 1.5, 0.8, {"mr-174"}},
  };
  return media;
}

Result<MediumEntry> FindMedium(std::string_view name) {
  const std::string wanted = Simplified(name);
  std::string known;
  for (const MediumEntry& entry : StandardMedia()) {
    if (Simplified(entry.medium.name) == wanted) return entry;
    for (const std::string& alias : entry.aliases) {
      if (Simplified(alias) == wanted) return entry;
    }
    known += (known.empty() ? "" : ", ") + entry.medium.name;
  }
  return UsageError(fmt::format("material: got \"{}\", want one of {}", name, known));
}

Result<Medium> MakeMedium(const std::string& name, double index_d, double abbe,
                          double density_g_cm3) {
  const auto outside = [&](const char* what, double got, double low, double high) {
    return UsageError(
        fmt::format("material {}: {}: got {}, want {}..{}", name, what, got, low, high));
  };
  if (!(index_d >= 1.001 && index_d <= 3)) return outside("index", index_d, 1.001, 3);
  if (!(abbe >= 10 && abbe <= 100)) return outside("Abbe number", abbe, 10, 100);
  if (!(density_g_cm3 >= 0.5 && density_g_cm3 <= 8)) {
    return outside("density", density_g_cm3, 0.5, 8);
  }
  return Medium{name, index_d, abbe, density_g_cm3};
}

Result<Medium> MakeMediumFromE(const std::string& name, double index_e, double abbe,
                               double density_g_cm3) {
  // n_e - 1 = (n_d - 1) (1 + q / V): linear in n_d - 1.
  const double q = (1 / (kLineE_nm * kLineE_nm) - 1 / (kLineD_nm * kLineD_nm)) / kSpread;
  return MakeMedium(name, 1 + (index_e - 1) / (1 + q / abbe), abbe, density_g_cm3);
}

double IndexAt(const Medium& medium, double wavelength_nm) {
  const double b = (medium.index_d - 1) / medium.abbe / kSpread;
  return medium.index_d + b * (1 / (wavelength_nm * wavelength_nm) - 1 / (kLineD_nm * kLineD_nm));
}

}  // namespace lorgnette
