// SPDX-License-Identifier: Apache-2.0
// Strong types where a mix-up of units would hurt. Lengths are plain double in mm, wavelengths in
// nm, angles in radians inside the program (suffix _deg where they are degrees).
#pragma once

#include <cmath>
#include <compare>
#include <limits>
#include <numbers>

namespace lorgnette {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double RadiansFromDegrees(double degrees) { return degrees * (kPi / 180.0); }
inline constexpr double DegreesFromRadians(double radians) { return radians * (180.0 / kPi); }

// Vergence or focal power. Owns the factor 1000 between 1/m and 1/mm.
class Diopters {
 public:
  constexpr Diopters() = default;
  constexpr explicit Diopters(double value) : value_(value) {}
  static constexpr Diopters FromPerMm(double per_mm) { return Diopters(1000.0 * per_mm); }
  constexpr double value() const { return value_; }            // 1/m
  constexpr double per_mm() const { return value_ / 1000.0; }  // 1/mm

  constexpr Diopters operator-() const { return Diopters(-value_); }
  friend constexpr Diopters operator+(Diopters a, Diopters b) {
    return Diopters(a.value_ + b.value_);
  }
  friend constexpr Diopters operator-(Diopters a, Diopters b) {
    return Diopters(a.value_ - b.value_);
  }
  friend constexpr Diopters operator*(double k, Diopters a) { return Diopters(k * a.value_); }
  friend constexpr Diopters operator*(Diopters a, double k) { return Diopters(k * a.value_); }
  friend constexpr Diopters operator/(Diopters a, double k) { return Diopters(a.value_ / k); }
  friend constexpr auto operator<=>(Diopters, Diopters) = default;

 private:
  double value_ = 0;
};

// Prism power: 100 tan(deviation), centimetres a metre.
class PrismDiopters {
 public:
  constexpr PrismDiopters() = default;
  constexpr explicit PrismDiopters(double value) : value_(value) {}
  constexpr double value() const { return value_; }
  double deviation() const { return std::atan(value_ / 100.0); }  // radians
  friend constexpr auto operator<=>(PrismDiopters, PrismDiopters) = default;

 private:
  double value_ = 0;
};

// Cylinder axis in TABO notation (ISO 8429): seen by someone who faces the wearer, 0 at the
// viewer's right, counter-clockwise, the same for both eyes. Kept in (0, 180].
class AxisDegrees {
 public:
  constexpr AxisDegrees() = default;
  explicit AxisDegrees(double degrees) : value_(Wrap(degrees)) {}
  constexpr double value() const { return value_; }  // (0, 180]
  constexpr double radians() const { return RadiansFromDegrees(value_); }
  friend constexpr auto operator<=>(AxisDegrees, AxisDegrees) = default;

 private:
  static double Wrap(double degrees) {
    const double r = std::fmod(degrees, 180.0);
    return r > 0 ? r : r + 180.0;
  }
  double value_ = 180;
};

}  // namespace lorgnette
