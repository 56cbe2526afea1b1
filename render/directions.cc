// SPDX-License-Identifier: Apache-2.0
#include "render/directions.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/check.h"
#include "base/units.h"

namespace lorgnette {
namespace {

// Position of a direction along a Z-order curve over the octahedral map.
std::uint32_t CurvePosition(const Eigen::Vector3f& d) {
  const float scale = 1.0f / (std::abs(d.x()) + std::abs(d.y()) + std::abs(d.z()));
  float x = d.x() * scale, y = d.y() * scale;
  if (d.z() < 0) {
    const float folded = std::copysign(1 - std::abs(y), x);
    y = std::copysign(1 - std::abs(x), y);
    x = folded;
  }
  const auto u = std::uint32_t(std::clamp((x + 1) * 0.5f, 0.0f, 0.9999f) * 1024);
  const auto v = std::uint32_t(std::clamp((y + 1) * 0.5f, 0.0f, 0.9999f) * 1024);
  std::uint32_t position = 0;
  for (int bit = 0; bit < 10; ++bit) {
    position |= (u >> bit & 1u) << (2 * bit) | (v >> bit & 1u) << (2 * bit + 1);
  }
  return position;
}

// SplitMix64 (Steele, Lea, Flood 2014), to [0, 1).
float NextUniform(std::uint64_t& state) {
  std::uint64_t z = state += 0x9e3779b97f4a7c15u;
  z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
  z = (z ^ z >> 27) * 0x94d049bb133111ebu;
  return float((z ^ z >> 31) >> 40) * 0x1p-24f;
}

}  // namespace

std::vector<Eigen::Vector3f> SphereDirections(int count) {
  LG_CHECK_EQ(count % 16, 0);
  std::vector<Eigen::Vector3f> directions;
  for (int i = 0; i < count; ++i) {
    const double y = 1 - (2 * i + 1.0) / count;
    const double r = std::sqrt(1 - y * y);
    const double angle = 2 * kPi * (i / std::numbers::phi - std::floor(i / std::numbers::phi));
    directions.emplace_back(float(r * std::cos(angle)), float(y), float(r * std::sin(angle)));
  }
  std::stable_sort(directions.begin(), directions.end(), [](const auto& a, const auto& b) {
    return CurvePosition(a) < CurvePosition(b);
  });
  return directions;
}

std::vector<Eigen::Vector3f> HemisphereStrata(int rays, std::uint64_t seed) {
  LG_CHECK_GE(rays, 1);
  const int rows = std::max(1, int(std::lround(std::sqrt(rays / 10.0))));
  const int columns = std::max(1, rays / rows);
  std::uint64_t state = seed;
  std::vector<Eigen::Vector3f> directions(std::size_t(rows) * std::size_t(columns));
  // Blocks of up to 4 rows by 4 columns follow one another, so that a packet is a compact bundle.
  std::size_t next = 0;
  for (int row0 = 0; row0 < rows; row0 += 4) {
    for (int column0 = 0; column0 < columns; column0 += 4) {
      for (int row = row0; row < std::min(row0 + 4, rows); ++row) {
        for (int column = column0; column < std::min(column0 + 4, columns); ++column) {
          const float u = (float(row) + NextUniform(state)) / float(rows);
          const float angle =
              float(2 * kPi) * (float(column) + NextUniform(state)) / float(columns);
          const float r = std::sqrt(u);
          directions[next++] = {r * std::cos(angle), r * std::sin(angle),
                                std::sqrt(std::max(0.0f, 1 - u))};
        }
      }
    }
  }
  return directions;
}

Eigen::Matrix3f BasisAbout(const Eigen::Vector3f& n) {
  const float sign = std::copysign(1.0f, n.z());
  const float a = -1 / (sign + n.z());
  const float b = n.x() * n.y() * a;
  Eigen::Matrix3f basis;
  basis.col(0) = Eigen::Vector3f(1 + sign * n.x() * n.x() * a, sign * b, -sign * n.x());
  basis.col(1) = Eigen::Vector3f(b, sign + n.y() * n.y() * a, -n.y());
  basis.col(2) = n;
  return basis;
}

Harmonics EvaluateHarmonics(const Eigen::Vector3f& d) {
  const float x = d.x(), y = d.y(), z = d.z();
  const float x2 = x * x, y2 = y * y, z2 = z * z;
  Harmonics h;
  h[0] = 0.28209479f;
  h[1] = 0.48860251f * y;
  h[2] = 0.48860251f * z;
  h[3] = 0.48860251f * x;
  h[4] = 1.09254843f * x * y;
  h[5] = 1.09254843f * y * z;
  h[6] = 0.31539157f * (3 * z2 - 1);
  h[7] = 1.09254843f * x * z;
  h[8] = 0.54627422f * (x2 - y2);
  h[9] = 0.59004359f * y * (3 * x2 - y2);
  h[10] = 2.89061144f * x * y * z;
  h[11] = 0.45704580f * y * (5 * z2 - 1);
  h[12] = 0.37317633f * z * (5 * z2 - 3);
  h[13] = 0.45704580f * x * (5 * z2 - 1);
  h[14] = 1.44530572f * z * (x2 - y2);
  h[15] = 0.59004359f * x * (x2 - 3 * y2);
  h[16] = 2.50334294f * x * y * (x2 - y2);
  h[17] = 1.77013077f * y * z * (3 * x2 - y2);
  h[18] = 0.94617470f * x * y * (7 * z2 - 1);
  h[19] = 0.66904654f * y * z * (7 * z2 - 3);
  h[20] = 0.10578555f * (35 * z2 * z2 - 30 * z2 + 3);
  h[21] = 0.66904654f * x * z * (7 * z2 - 3);
  h[22] = 0.47308735f * (x2 - y2) * (7 * z2 - 1);
  h[23] = 1.77013077f * x * z * (x2 - 3 * y2);
  h[24] = 0.62583574f * (x2 * (x2 - 3 * y2) - y2 * (3 * x2 - y2));
  return h;
}

}  // namespace lorgnette
