// SPDX-License-Identifier: Apache-2.0
#include "optics/fresnel.h"

#include <cmath>

#include "optics/paraxial.h"

namespace lorgnette {
namespace {

// Cosine after refraction; imaginary past the critical angle, on the branch that decays.
std::complex<double> CosineAfter(double cos_incident, double n1, double n2) {
  const double eta = n1 / n2;
  const double after2 = eta * eta * cos_incident * cos_incident + (1 - eta) * (1 + eta);
  if (after2 >= 0) return std::sqrt(after2);
  return {0, -std::sqrt(-after2)};
}

// Incoherent sum over the bounces of one polarisation.
PlatePower Bounces(double r, double internal) {
  const double t = 1 - r;
  const double series = 1 / (1 - r * r * internal * internal);
  PlatePower power;
  power.single_pass = t * t * internal;
  power.transmitted = power.single_pass * series;
  power.reflected = r + t * t * r * internal * internal * series;
  return power;
}

}  // namespace

double PolarizedPower::reflected_polarization() const {
  const double sum = rs + rp;
  return sum > 0 ? (rs - rp) / sum : 0;
}

FresnelAmplitudes Fresnel(double cos_incident, double index_before, double index_after) {
  const double n1 = index_before, n2 = index_after, c1 = cos_incident;
  const std::complex<double> c2 = CosineAfter(c1, n1, n2);
  FresnelAmplitudes a;
  if (n1 == n2) {
    a.ts = a.tp = 1;
    return a;
  }
  const std::complex<double> s = n1 * c1 + n2 * c2, p = n2 * c1 + n1 * c2;
  a.rs = (n1 * c1 - n2 * c2) / s;
  a.rp = (n2 * c1 - n1 * c2) / p;
  a.ts = 2 * n1 * c1 / s;
  a.tp = 2 * n1 * c1 / p;
  return a;
}

PolarizedPower FresnelPower(double cos_incident, double index_before, double index_after) {
  const FresnelAmplitudes a = Fresnel(cos_incident, index_before, index_after);
  PolarizedPower power;
  power.rs = std::norm(a.rs);
  power.rp = std::norm(a.rp);
  if (cos_incident > 0) {
    const double across = index_after *
                          CosineAfter(cos_incident, index_before, index_after).real() /
                          (index_before * cos_incident);
    power.ts = across * std::norm(a.ts);
    power.tp = across * std::norm(a.tp);
  }
  return power;
}

double BrewsterAngle(double index_before, double index_after) {
  return std::atan2(index_after, index_before);
}

std::optional<double> CriticalAngle(double index_before, double index_after) {
  if (index_after >= index_before) return std::nullopt;
  return std::asin(index_after / index_before);
}

PlatePower PlateTransmittance(double cos_incident, double index, double internal) {
  const PolarizedPower surface = FresnelPower(cos_incident, 1, index);
  const PlatePower s = Bounces(surface.rs, internal), p = Bounces(surface.rp, internal);
  return {0.5 * (s.transmitted + p.transmitted), 0.5 * (s.reflected + p.reflected),
          0.5 * (s.single_pass + p.single_pass)};
}

Ghost GhostOf(const Lens& lens, double index, double front_reflectance, double back_reflectance) {
  const double c1 = 0.5 * lens.front.VertexCurvature().trace();
  const double c2 = 0.5 * lens.back.VertexCurvature().trace();
  const auto power = [](double per_mm) { return Diopters::FromPerMm(per_mm); };
  const auto pass = ParaxialSystem::Transfer(lens.center_thickness_mm / index);
  // Inside the glass a mirror of curvature c has power -2 n c for light along +z, +2 n c against.
  const ParaxialSystem way = ParaxialSystem::Refraction(power((1 - index) * c2)) * pass *
                             ParaxialSystem::Refraction(power(2 * index * c1)) * pass *
                             ParaxialSystem::Refraction(power(-2 * index * c2)) * pass *
                             ParaxialSystem::Refraction(power((index - 1) * c1));
  return {way.BackVertexPower(), front_reflectance * back_reflectance};
}

Ghost GhostOf(const Lens& lens, double index) {
  const double r = FresnelPower(1, index, 1).reflectance();
  return GhostOf(lens, index, r, r);
}

}  // namespace lorgnette
