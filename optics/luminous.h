// SPDX-License-Identifier: Apache-2.0
// What the eye makes of a spectrum: luminous transmittance, and the colour of a coat's residual
// reflection, in daylight.
//
// Sums over 380..780 nm in steps of 10 nm with the CIE 1931 2-degree colour-matching functions
// (their y is V(lambda)) and the relative spectral power of CIE standard illuminant D65, as CIE 15
// and ISO 11664-1/-2 tabulate them at these wavelengths.
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>

namespace lorgnette {

inline constexpr int kSpectrumSize = 41;
inline constexpr double SpectrumWavelength_nm(int i) { return 380.0 + 10.0 * i; }
// One value a wavelength.
using Spectrum = std::array<double, kSpectrumSize>;

const Spectrum& LuminousEfficiency();  // V(lambda), 1 near 555 nm
const Spectrum& DaylightD65();         // 100 at 560 nm

Spectrum Sampled(const std::function<double(double wavelength_nm)>& of);

// Fraction of D65's light, as the eye weighs it, that a filter or mirror of this spectrum leaves.
double LuminousFraction(const Spectrum& spectrum);

// XYZ under D65, with Y = LuminousFraction.
Eigen::Vector3d XyzUnderD65(const Spectrum& spectrum);
// The same as linear Rec.709 components, relative to white = (1, 1, 1); may lie outside 0..1.
Eigen::Vector3d LinearRgbUnderD65(const Spectrum& spectrum);
// CIE 1931 chromaticity (x, y); that of D65 itself for a spectrum without light.
Eigen::Vector2d ChromaticityUnderD65(const Spectrum& spectrum);

}  // namespace lorgnette
