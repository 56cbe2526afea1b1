// SPDX-License-Identifier: Apache-2.0
#include "optics/thin_film.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "base/units.h"

namespace lorgnette {
namespace {

using Complex = std::complex<double>;

// n cos in a medium of index n - i k, from the conserved n0 sin; the branch on which the wave goes
// on and does not grow.
Complex NormalIndex(Complex index, double conserved) {
  Complex q = std::sqrt(index * index - conserved * conserved);
  if (q.imag() > 0) q = -q;
  if (q.imag() == 0 && q.real() < 0) q = -q;
  return q;
}

// Admittance: n cos, or n / cos = n^2 / (n cos).
Complex Admittance(Complex index, Complex normal, bool s) {
  return s ? normal : index * index / normal;
}

struct OnePower {
  double reflected, transmitted;
};
OnePower Solve(const FilmStack& stack, double wavelength_nm, double cos_incident, bool s) {
  const double n0 = stack.index_before;
  const double conserved = n0 * std::sqrt(std::max(0.0, 1 - cos_incident * cos_incident));
  const Complex before = Admittance(n0, n0 * cos_incident, s);
  const Complex after = Admittance(stack.index_after, NormalIndex(stack.index_after, conserved), s);
  Complex b = 1, c = after;
  for (std::size_t k = stack.layers.size(); k-- > 0;) {
    const FilmLayer& layer = stack.layers[k];
    const Complex index(layer.index, -layer.extinction);
    const Complex normal = NormalIndex(index, conserved);
    const Complex eta = Admittance(index, normal, s);
    const Complex phase = 2 * kPi * layer.thickness_nm / wavelength_nm * normal;
    const Complex co = std::cos(phase), si = Complex(0, 1) * std::sin(phase);
    const Complex next_b = co * b + si / eta * c;
    c = si * eta * b + co * c;
    b = next_b;
  }
  const Complex sum = before * b + c;
  return {std::norm((before * b - c) / sum), 4 * before.real() * after.real() / std::norm(sum)};
}

}  // namespace

FilmStack Reversed(const FilmStack& stack) {
  FilmStack reversed{stack.index_after, stack.layers, stack.index_before};
  std::reverse(reversed.layers.begin(), reversed.layers.end());
  return reversed;
}

PolarizedPower FilmPower(const FilmStack& stack, double wavelength_nm, double cos_incident) {
  // Grazing light does not enter at all, and its p admittance is infinite.
  if (!(cos_incident > 0)) return {1, 1, 0, 0};
  const OnePower s = Solve(stack, wavelength_nm, cos_incident, true);
  const OnePower p = Solve(stack, wavelength_nm, cos_incident, false);
  return {s.reflected, p.reflected, s.transmitted, p.transmitted};
}

FilmStack CoatOn(CoatKind kind, double substrate_index, double design_nm) {
  constexpr double kFluoride = 1.38, kSilica = 1.46, kZirconia = 2.10;
  FilmStack stack{1, {}, substrate_index};
  const auto wave = [&](double index, double quarters) {
    stack.layers.push_back({index, quarters * QuarterWave_nm(index, design_nm), 0});
  };
  switch (kind) {
    case CoatKind::kNone:
      break;
    case CoatKind::kSingle:
      wave(kFluoride, 1);
      break;
    case CoatKind::kVCoat: {
      // Where two layers of given indices take the reflection to zero: real and imaginary part of
      // B = C, solved for the tangents of the phase thicknesses; the thinner inner layer of two.
      const double n1 = kSilica, n2 = kZirconia, ns = substrate_index;
      const double outer = ns - n1 * n1, inner = n2 * n2 - ns, both = n1 * n1 * ns - n2 * n2;
      const double t1 = n1 * std::sqrt((ns - 1) * inner / (both * outer));
      const double t2 = n2 * std::sqrt((ns - 1) * outer / (both * inner));
      const double unit_nm = design_nm / (2 * kPi);
      stack.layers.push_back({n1, (kPi - std::atan(t1)) * unit_nm / n1, 0});
      stack.layers.push_back({n2, std::atan(t2) * unit_nm / n2, 0});
      break;
    }
    case CoatKind::kBroadband:
      wave(kFluoride, 1);
      wave(kZirconia, 2);
      wave(kFluoride * std::sqrt(substrate_index), 1);
      break;
  }
  return stack;
}

}  // namespace lorgnette
