// SPDX-License-Identifier: Apache-2.0
#include "render/environment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.h"
#include "base/units.h"
#include "render/image_io.h"

namespace lorgnette {
namespace {

// Arc tangent of y / x over the full circle; at most 2e-5 rad off (a texel of a 2048-column map is
// 3e-3 rad), an odd polynomial of degree 11 on [0, 1] and symmetry.
float FastAtan2(float y, float x) {
  const float ax = std::abs(x), ay = std::abs(y);
  const float high = std::max(ax, ay), low = std::min(ax, ay);
  const float z = high > 0 ? low / high : 0.0f;
  const float s = z * z;
  float a =
      z * (0.99997726f +
           s * (-0.33262347f +
                s * (0.19354346f + s * (-0.11643287f + s * (0.05265332f - s * 0.01172120f)))));
  if (ay > ax) a = float(kPi / 2) - a;
  if (x < 0) a = float(kPi) - a;
  return y < 0 ? -a : a;
}

}  // namespace

Result<Environment> Environment::Read(const std::string& path, std::string* warning) {
  LG_ASSIGN(ImageRgbF map, ReadHighDynamicRange(path));
  long negative = 0;
  for (std::size_t i = 0; i < map.data.size(); ++i) {
    float& v = map.data[i];
    if (!std::isfinite(v)) {
      const std::size_t texel = i / 3;
      return Failure(fmt::format("{}:texel ({}, {}): got {}, want a finite radiance", path,
                                 texel % std::size_t(map.width), texel / std::size_t(map.width),
                                 v));
    }
    if (v < 0) {
      v = 0;
      ++negative;
    }
  }
  if (negative > 0 && warning != nullptr) {
    *warning = fmt::format("{}: {} negative values were taken as 0", path, negative);
  }
  return Environment(std::move(map));
}

Environment Environment::Constant(const Eigen::Vector3f& radiance) {
  ImageRgbF map(2, 1);
  for (int x = 0; x < 2; ++x) std::copy(radiance.data(), radiance.data() + 3, map.at(x, 0));
  return Environment(std::move(map));
}

Environment::Environment(ImageRgbF map) : map_(std::move(map)) {
  LG_CHECK_GT(map_.width, 0);
  LG_CHECK_GT(map_.height, 0);
}

Eigen::Vector3f Environment::Direction(double column, double row) const {
  const double lon = 2 * kPi * (column / map_.width - 0.5);
  const double lat = kPi * (0.5 - row / map_.height);
  return Eigen::Vector3d(-std::sin(lon) * std::cos(lat), std::sin(lat),
                         std::cos(lon) * std::cos(lat))
      .cast<float>();
}

Eigen::Vector3f Environment::Radiance(const Eigen::Vector3f& d) const {
  const float lon = FastAtan2(-d.x(), d.z());
  const float lat = FastAtan2(d.y(), std::sqrt(d.x() * d.x() + d.z() * d.z()));
  const float column = (lon * float(0.5 / kPi) + 0.5f) * float(map_.width) - 0.5f;
  const float row = std::clamp((0.5f - lat * float(1 / kPi)) * float(map_.height) - 0.5f, 0.0f,
                               float(map_.height - 1));
  const float column_floor = std::floor(column);
  const float fx = column - column_floor;
  int x0 = int(column_floor);
  if (x0 < 0) x0 += map_.width;
  if (x0 >= map_.width) x0 -= map_.width;
  const int x1 = x0 + 1 == map_.width ? 0 : x0 + 1;
  const int y0 = int(row);
  const int y1 = std::min(y0 + 1, map_.height - 1);
  const float fy = row - float(y0);
  using Texel = Eigen::Map<const Eigen::Vector3f>;
  return (1 - fy) * ((1 - fx) * Texel(map_.at(x0, y0)) + fx * Texel(map_.at(x1, y0))) +
         fy * ((1 - fx) * Texel(map_.at(x0, y1)) + fx * Texel(map_.at(x1, y1)));
}

Eigen::Vector3f Environment::Mean() const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double weight = 0;
  for (int y = 0; y < map_.height; ++y) {
    const double w = std::cos(kPi * (0.5 - (y + 0.5) / map_.height));
    for (int x = 0; x < map_.width; ++x) {
      sum += w * Eigen::Map<const Eigen::Vector3f>(map_.at(x, y)).cast<double>();
      weight += w;
    }
  }
  return (sum / weight).cast<float>();
}

BrightestLight::BrightestLight(const Environment& environment) {
  const ImageRgbF& map = environment.map();
  const auto cell = [](int column, int row) {
    return std::size_t(row) * std::size_t(kColumns) + std::size_t(column);
  };
  std::vector<Eigen::Vector3f> own(std::size_t(kColumns) * kRows, Eigen::Vector3f::Zero());
  // Every cell holds the texels that reach into it, and one more all around: radiance is bilinear.
  for (int row = 0; row < kRows; ++row) {
    const int y0 = std::max(0, row * map.height / kRows - 1);
    const int y1 = std::min(map.height - 1, (row + 1) * map.height / kRows + 1);
    for (int column = 0; column < kColumns; ++column) {
      Eigen::Vector3f& most = own[cell(column, row)];
      const int x0 = column * map.width / kColumns - 1;
      const int x1 = (column + 1) * map.width / kColumns + 1;
      for (int y = y0; y <= y1; ++y) {
        for (int x = x0; x <= x1; ++x) {
          const int wrapped = (x % map.width + map.width) % map.width;
          most = most.cwiseMax(Eigen::Map<const Eigen::Vector3f>(map.at(wrapped, y)));
        }
      }
      greatest_ = greatest_.cwiseMax(most);
    }
  }
  cells_.resize(own.size());
  for (int row = 0; row < kRows; ++row) {
    // Cells narrow toward the poles.
    const double lat = kPi * (0.5 - (row + 0.5) / kRows);
    const int reach = std::min(kColumns / 2, int(std::ceil(1 / std::max(std::cos(lat), 1e-3))));
    for (int column = 0; column < kColumns; ++column) {
      Eigen::Vector3f most = Eigen::Vector3f::Zero();
      for (int y = std::max(0, row - 1); y <= std::min(kRows - 1, row + 1); ++y) {
        for (int x = column - reach; x <= column + reach; ++x) {
          most = most.cwiseMax(own[cell((x + kColumns) % kColumns, y)]);
        }
      }
      cells_[cell(column, row)] = most;
    }
  }
}

const Eigen::Vector3f& BrightestLight::Near(const Eigen::Vector3f& d) const {
  const float lon = FastAtan2(-d.x(), d.z());
  const float lat = FastAtan2(d.y(), std::sqrt(d.x() * d.x() + d.z() * d.z()));
  const int column = int((lon * float(0.5 / kPi) + 0.5f) * kColumns);
  const int row = int((0.5f - lat * float(1 / kPi)) * kRows);
  return cells_[std::size_t(std::clamp(row, 0, kRows - 1)) * std::size_t(kColumns) +
                std::size_t(std::clamp(column, 0, kColumns - 1))];
}

}  // namespace lorgnette
