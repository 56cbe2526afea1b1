// SPDX-License-Identifier: Apache-2.0
#include "optics/luminous.h"

#include <Eigen/LU>

namespace lorgnette {
namespace {

// CIE 1931 standard observer, 380..780 nm by 10 nm.
constexpr Spectrum kX = {0.001368, 0.004243, 0.01431,  0.04351,  0.13438,  0.2839,  0.34828,
                         0.3362,   0.2908,   0.19536,  0.09564,  0.03201,  0.0049,  0.0093,
                         0.06327,  0.1655,   0.2904,   0.43345,  0.5945,   0.7621,  0.9163,
                         1.0263,   1.0622,   1.0026,   0.85445,  0.6424,   0.4479,  0.2835,
                         0.1649,   0.0874,   0.04677,  0.0227,   0.011359, 0.00579, 0.002899,
                         0.00144,  0.00069,  0.000332, 0.000166, 0.000083, 0.000042};
constexpr Spectrum kY = {0.000039, 0.00012,  0.000396, 0.00121, 0.004,    0.0116,   0.023,
                         0.038,    0.06,     0.09098,  0.13902, 0.20802,  0.323,    0.503,
                         0.71,     0.862,    0.954,    0.99495, 0.995,    0.952,    0.87,
                         0.757,    0.631,    0.503,    0.381,   0.265,    0.175,    0.107,
                         0.061,    0.032,    0.017,    0.00821, 0.004102, 0.002091, 0.001047,
                         0.00052,  0.000249, 0.00012,  0.00006, 0.00003,  0.000015};
constexpr Spectrum kZ = {
    0.00645, 0.02005, 0.06785, 0.2074,  0.6456,  1.3856, 1.74706, 1.77211, 1.6692, 1.28764, 0.81295,
    0.46518, 0.272,   0.1582,  0.07825, 0.04216, 0.0203, 0.00875, 0.0039,  0.0021, 0.00165, 0.0011,
    0.0008,  0.00034, 0.00019, 0.00005, 0.00002, 0,      0,       0,       0,      0,       0,
    0,       0,       0,       0,       0,       0,      0,       0};
constexpr Spectrum kD65 = {49.9755, 54.6482, 82.7549, 91.486,  93.4318, 86.6823, 104.865,
                           117.008, 117.812, 114.861, 115.923, 108.811, 109.354, 107.802,
                           104.79,  107.689, 104.405, 104.046, 100,     96.3342, 95.788,
                           88.6856, 90.0062, 89.5991, 87.6987, 83.2886, 83.6992, 80.0268,
                           80.2146, 82.2778, 78.2842, 69.7213, 71.6091, 74.349,  61.604,
                           69.8856, 75.087,  63.5927, 46.4182, 66.8054, 63.3828};

}  // namespace

const Spectrum& LuminousEfficiency() { return kY; }
const Spectrum& DaylightD65() { return kD65; }

Spectrum Sampled(const std::function<double(double wavelength_nm)>& of) {
  Spectrum spectrum;
  for (int i = 0; i < kSpectrumSize; ++i) {
    spectrum[std::size_t(i)] = of(SpectrumWavelength_nm(i));
  }
  return spectrum;
}

Eigen::Vector3d XyzUnderD65(const Spectrum& spectrum) {
  Eigen::Vector3d sum(0, 0, 0);
  double white = 0;
  for (std::size_t i = 0; i < spectrum.size(); ++i) {
    sum += spectrum[i] * kD65[i] * Eigen::Vector3d(kX[i], kY[i], kZ[i]);
    white += kD65[i] * kY[i];
  }
  return sum / white;
}

double LuminousFraction(const Spectrum& spectrum) { return XyzUnderD65(spectrum).y(); }

Eigen::Vector3d LinearRgbUnderD65(const Spectrum& spectrum) {
  // Rec.709 primaries (ITU-R BT.709) about the white of these very tables, so that an even spectrum
  // has equal components to the last bit.
  static const Eigen::Matrix3d rgb_from_xyz = [] {
    Spectrum even;
    even.fill(1);
    Eigen::Matrix3d primaries;
    primaries << 0.64, 0.30, 0.15, 0.33, 0.60, 0.06, 0.03, 0.10, 0.79;
    const Eigen::Vector3d scale = primaries.inverse() * XyzUnderD65(even);
    return Eigen::Matrix3d((primaries * scale.asDiagonal()).inverse());
  }();
  return rgb_from_xyz * XyzUnderD65(spectrum);
}

Eigen::Vector2d ChromaticityUnderD65(const Spectrum& spectrum) {
  Eigen::Vector3d xyz = XyzUnderD65(spectrum);
  if (!(xyz.sum() > 0)) {
    Spectrum even;
    even.fill(1);
    xyz = XyzUnderD65(even);
  }
  return xyz.head<2>() / xyz.sum();
}

}  // namespace lorgnette
