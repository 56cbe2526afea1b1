// SPDX-License-Identifier: Apache-2.0
#include "render/probe.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/units.h"
#include "render/color.h"
#include "render/exposure_tags.h"
#include "render/image_io.h"

namespace lorgnette {
namespace {

constexpr int kSearchSide = 220;  // of the reduced picture that is searched
constexpr int kPerimeter = 96;    // samples of a circle
constexpr double kLeastVisible = 0.6;
constexpr double kEvidence = 1;      // exponent
constexpr double kFar = 1e4;         // radii: as good as infinitely far
constexpr double kRimShown = 0.985;  // beyond this share of the radius the outline's blur begins

// Logarithm of the luma, reduced and slightly blurred.
struct LogPicture {
  int width = 0, height = 0;
  double step = 1;  // pixels of the photograph a pixel here
  std::vector<float> values;
  std::size_t index(int x, int y) const {
    return std::size_t(y) * std::size_t(width) + std::size_t(x);
  }
  float at(double x, double y) const {
    const double column = std::clamp(x - 0.5, 0.0, double(width - 1));
    const double row = std::clamp(y - 0.5, 0.0, double(height - 1));
    const int x0 = int(column), y0 = int(row);
    const int x1 = std::min(x0 + 1, width - 1), y1 = std::min(y0 + 1, height - 1);
    const float fx = float(column - x0), fy = float(row - y0);
    const auto v = [&](int i, int j) { return values[index(i, j)]; };
    return (1 - fy) * ((1 - fx) * v(x0, y0) + fx * v(x1, y0)) +
           fy * ((1 - fx) * v(x0, y1) + fx * v(x1, y1));
  }
};

LogPicture Reduce(const ImageRgb8& picture, int side) {
  LogPicture out;
  out.step = std::max(1.0, double(std::max(picture.width, picture.height)) / side);
  out.width = std::max(1, int(picture.width / out.step));
  out.height = std::max(1, int(picture.height / out.step));
  std::vector<float> sums(out.index(0, out.height), 0), counts(sums.size(), 0);
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const int i = std::min(int((x + 0.5) / out.step), out.width - 1);
      const int j = std::min(int((y + 0.5) / out.step), out.height - 1);
      const std::uint8_t* p = picture.at(x, y);
      sums[out.index(i, j)] += 0.2126f * LinearFromCode(p[0]) + 0.7152f * LinearFromCode(p[1]) +
                               0.0722f * LinearFromCode(p[2]);
      counts[out.index(i, j)] += 1;
    }
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    out.values.push_back(std::log(0.01f + (counts[i] > 0 ? sums[i] / counts[i] : 0)));
  }
  // A 3 x 3 mean: grain has no say.
  std::vector<float> smooth(out.values.size());
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      float sum = 0, n = 0;
      for (int j = std::max(0, y - 1); j <= std::min(out.height - 1, y + 1); ++j) {
        for (int i = std::max(0, x - 1); i <= std::min(out.width - 1, x + 1); ++i, ++n) {
          sum += out.values[out.index(i, j)];
        }
      }
      smooth[out.index(x, y)] = sum / n;
    }
  }
  out.values = std::move(smooth);
  return out;
}

// Mean of the radial jumps along a circle less that of the jumps along it, each capped, so that a
// few bright edges do not decide and a pattern counts as much one way as the other; 0 when too
// little of it lies in the picture.
double Score(const LogPicture& p, double cx, double cy, double r, float cap) {
  double sum = 0;
  int seen = 0;
  const double reach = std::max(1.0, 0.012 * r);
  const auto jump = [&](double x0, double y0, double x1, double y1) {
    return std::min(std::abs(p.at(x1, y1) - p.at(x0, y0)), cap);
  };
  for (int i = 0; i < kPerimeter; ++i) {
    const double a = 2 * kPi * i / kPerimeter;
    const double c = std::cos(a), s = std::sin(a);
    const double x = cx + r * c, y = cy + r * s;
    if (x < reach + 1 || y < reach + 1 || x > p.width - reach - 1 || y > p.height - reach - 1) {
      continue;
    }
    ++seen;
    const double dx = reach * c, dy = reach * s;
    sum +=
        double(jump(x - dx, y - dy, x + dx, y + dy)) - double(jump(x + dy, y - dx, x - dy, y + dx));
  }
  const double share = double(seen) / kPerimeter;
  return share < kLeastVisible ? 0 : sum / (2 * reach * seen) * std::sqrt(share);
}

float MeanGradient(const LogPicture& p) {
  double sum = 0;
  long count = 0;
  for (int y = 1; y + 1 < p.height; ++y) {
    for (int x = 1; x + 1 < p.width; ++x, ++count) {
      const auto v = [&](int i, int j) { return p.values[p.index(i, j)]; };
      sum += 0.5 *
             double(std::abs(v(x + 1, y) - v(x - 1, y)) + std::abs(v(x, y + 1) - v(x, y - 1))) / 2;
    }
  }
  return count > 0 ? float(sum / double(count)) : 0;
}

BallCircle Refine(const LogPicture& p, BallCircle best, float cap) {
  for (double step = 2; step > 0.05; step *= 0.5) {
    bool moved = true;
    for (int rounds = 0; moved && rounds < 20; ++rounds) {
      moved = false;
      for (int k = 0; k < 6; ++k) {
        BallCircle next = best;
        (k < 2 ? next.x : k < 4 ? next.y : next.radius) += k % 2 == 0 ? step : -step;
        next.contrast = Score(p, next.x, next.y, next.radius, cap);
        if (next.contrast > best.contrast) {
          best = next;
          moved = true;
        }
      }
    }
  }
  return best;
}

// A photograph in linear light with its weights, and where the ball lies in it.
struct Exposure {
  const ProbePhoto* photo;
  BallCircle ball;
  Eigen::Vector3f Sample(double rho, double azimuth) const {
    return At(ball.x + rho * ball.radius * std::cos(azimuth),
              ball.y - rho * ball.radius * std::sin(azimuth));
  }
  // Linear light of the nearest four pixels; -1 where the picture ends.
  Eigen::Vector3f At(double x, double y) const {
    const ImageRgb8& p = photo->picture;
    if (x < 0 || y < 0 || x > p.width || y > p.height) return Eigen::Vector3f::Constant(-1);
    const double column = std::clamp(x - 0.5, 0.0, double(p.width - 1));
    const double row = std::clamp(y - 0.5, 0.0, double(p.height - 1));
    const int x0 = int(column), y0 = int(row);
    const int x1 = std::min(x0 + 1, p.width - 1), y1 = std::min(y0 + 1, p.height - 1);
    const float fx = float(column - x0), fy = float(row - y0);
    Eigen::Vector3f out;
    for (int c = 0; c < 3; ++c) {
      const auto v = [&](int i, int j) { return LinearFromCode(p.at(i, j)[c]); };
      out[c] = (1 - fy) * ((1 - fx) * v(x0, y0) + fx * v(x1, y0)) +
               fy * ((1 - fx) * v(x0, y1) + fx * v(x1, y1));
    }
    return out;
  }
};

// How alike two photographs' balls are: correlation of the log light over the disc.
double Likeness(const Exposure& a, const Exposure& b) {
  double sx = 0, sy = 0, sxx = 0, syy = 0, sxy = 0, n = 0;
  constexpr int kRings = 14, kSpokes = 40;
  for (int i = 1; i <= kRings; ++i) {
    const double rho = 0.95 * i / kRings;
    for (int j = 0; j < kSpokes; ++j) {
      const double azimuth = 2 * kPi * j / kSpokes;
      const Eigen::Vector3f u = a.Sample(rho, azimuth), v = b.Sample(rho, azimuth);
      if (u.x() < 0 || v.x() < 0) continue;
      const double x = std::log(0.01 + double(u.y())), y = std::log(0.01 + double(v.y()));
      sx += x;
      sy += y;
      sxx += x * x;
      syy += y * y;
      sxy += x * y;
      ++n;
    }
  }
  if (n < 20) return -1;
  const double xx = sxx - sx * sx / n, yy = syy - sy * sy / n;
  return xx > 0 && yy > 0 ? (sxy - sx * sy / n) / std::sqrt(xx * yy) : 0;
}

// The other photograph's ball, so that it shows what the first one's does.
BallCircle LayOnto(const Exposure& first, Exposure other) {
  double best = Likeness(first, other);
  for (double step = 0.04 * other.ball.radius; step > 0.1; step *= 0.5) {
    bool moved = true;
    for (int rounds = 0; moved && rounds < 30; ++rounds) {
      moved = false;
      for (int k = 0; k < 6; ++k) {
        Exposure next = other;
        (k < 2 ? next.ball.x : k < 4 ? next.ball.y : next.ball.radius) += k % 2 == 0 ? step : -step;
        const double likeness = Likeness(first, next);
        if (likeness > best) {
          best = likeness;
          other = next;
          moved = true;
        }
      }
    }
  }
  return other.ball;
}

struct Merged {
  Eigen::Vector3f light;
  bool clipped = false, dark = false;
};
// Weighted mean of the photographs' light at one point of the ball: middle code values count most.
Merged Merge(const std::vector<Exposure>& exposures, double rho, double azimuth) {
  Merged out;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), weight = Eigen::Vector3d::Zero();
  Eigen::Vector3d shortest = Eigen::Vector3d::Zero(), longest = shortest;
  double least = 1e300, most = 0;
  for (const Exposure& e : exposures) {
    const Eigen::Vector3f v = e.Sample(rho, azimuth);
    if (v.x() < 0) continue;
    const double t = e.photo->exposure_s;
    if (t < least) shortest = v.cast<double>() / t;
    if (t > most) longest = v.cast<double>() / t;
    least = std::min(least, t);
    most = std::max(most, t);
    for (int c = 0; c < 3; ++c) {
      const double code = SrgbFromLinear(std::clamp(double(v[c]), 0.0, 1.0));
      const double w = std::max(0.0, std::min((code - 0.03) / 0.1, (0.97 - code) / 0.1));
      // Longer exposures have less grain for the same code value.
      const double share = std::min(w, 1.0) * t;
      sum[c] += share * double(v[c]) / t;
      weight[c] += share;
    }
  }
  for (int c = 0; c < 3; ++c) {
    if (weight[c] > 0) {
      out.light[c] = float(sum[c] / weight[c]);
    } else if (least < 1e300 && shortest[c] * least > 0.5) {
      out.light[c] = float(shortest[c]);
      out.clipped = true;
    } else {
      out.light[c] = float(longest[c]);
      out.dark = true;
    }
  }
  return out;
}

// A long outline that stands out says more than a short one.
double Evidence(double radius) { return std::pow(radius, kEvidence); }

}  // namespace

std::optional<BallCircle> FindBall(const ImageRgb8& picture) {
  if (picture.width < 16 || picture.height < 16) return std::nullopt;
  const LogPicture coarse = Reduce(picture, kSearchSide / 2);
  const float mean = MeanGradient(coarse);
  if (!(mean > 0)) return std::nullopt;
  const float cap = 12 * mean;
  const int shorter = std::min(coarse.width, coarse.height);
  std::vector<BallCircle> best;
  for (double r = 0.15 * shorter; r <= 0.62 * shorter; r += 1.5) {
    for (double y = 0.2 * coarse.height; y <= 0.8 * coarse.height; y += 2) {
      for (double x = 0.2 * coarse.width; x <= 0.8 * coarse.width; x += 2) {
        const double score = Score(coarse, x, y, r, cap);
        if (score > 0) best.push_back({x, y, r, score * Evidence(r)});
      }
    }
  }
  if (best.empty()) return std::nullopt;
  constexpr std::size_t kTried = 12;
  const std::size_t tried = std::min(kTried, best.size());
  std::partial_sort(
      best.begin(), best.begin() + std::ptrdiff_t(tried), best.end(),
      [](const BallCircle& a, const BallCircle& b) { return a.contrast > b.contrast; });
  const LogPicture fine = Reduce(picture, kSearchSide * 2);
  const float fine_mean = MeanGradient(fine);
  const double to_fine = coarse.step / fine.step;
  BallCircle found;
  for (std::size_t i = 0; i < tried; ++i) {
    BallCircle c = best[i];
    c.contrast /= Evidence(c.radius);
    c = Refine(coarse, c, cap);
    c = {c.x * to_fine, c.y * to_fine, c.radius * to_fine, 0};
    c.contrast = Score(fine, c.x, c.y, c.radius, 12 * fine_mean);
    c = Refine(fine, c, 12 * fine_mean);
    if (c.contrast * Evidence(c.radius) > found.contrast * Evidence(std::max(found.radius, 1.0))) {
      found = c;
    }
  }
  found.contrast /= double(fine_mean);
  if (found.contrast < kLeastBallContrast) return std::nullopt;
  found.x *= fine.step;
  found.y *= fine.step;
  found.radius *= fine.step;
  return found;
}

Result<ProbePhoto> ReadProbePhoto(const std::string& path, std::optional<double> exposure_s) {
  LG_ASSIGN(ImageRgb8 picture, ReadPicture(path));
  double exposure = exposure_s.value_or(0);
  if (!exposure_s) {
    LG_ASSIGN(const std::optional<ExposureTags> tags, ReadExposureTags(path));
    if (tags) exposure = tags->time_s / (tags->f_number * tags->f_number) * tags->iso / 100;
  }
  return ProbePhoto{path, std::move(picture), exposure};
}

double MirroredAngle(double rho, double distance_radii) {
  if (!(distance_radii > 1) || distance_radii > kFar) return 2 * std::asin(std::min(rho, 1.0));
  // The camera at the origin looks along +z at a unit ball at z = d; its outline lies at
  // tan = 1 / sqrt(d^2 - 1).
  const double d = distance_radii;
  const double tangent = std::min(rho, 1.0) / std::sqrt(d * d - 1);
  const double view = std::atan(tangent);
  // Distance to the ball along the ray, and the normal's angle there.
  const double b = d * std::cos(view);
  const double s = b - std::sqrt(std::max(0.0, b * b - d * d + 1));
  const double normal = std::atan2(s * std::sin(view), d - s * std::cos(view));
  return 2 * normal + view;
}

Result<ProbeResult> EnvironmentFromBall(const std::vector<ProbePhoto>& photos,
                                        const ProbeOptions& options) {
  if (photos.empty()) return UsageError("a probe needs one photograph or more");
  if (options.distance_radii != 0 && !(options.distance_radii > 1)) {
    return UsageError(
        fmt::format("distance: got {} radii of the ball, want more than 1, or 0 for far away",
                    options.distance_radii));
  }
  std::vector<Exposure> exposures;
  for (const ProbePhoto& photo : photos) {
    if (photos.size() > 1 && !(photo.exposure_s > 0)) {
      return Failure(fmt::format("{}: has no exposure time, and several photographs need one each",
                                 photo.name));
    }
    exposures.push_back({&photo, {}});
  }
  ProbeResult result;
  // The photograph of the middle exposure shows most of the ball.
  std::vector<std::size_t> order(exposures.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return photos[a].exposure_s < photos[b].exposure_s;
  });
  const std::size_t middle = options.ball ? 0 : order[order.size() / 2];
  Exposure& first = exposures[middle];
  if (options.ball) {
    first.ball = *options.ball;
  } else {
    const auto found = FindBall(first.photo->picture);
    if (!found) {
      return Failure(fmt::format("{}: no ball stands out; say where it is", first.photo->name));
    }
    first.ball = *found;
  }
  for (std::size_t i = 0; i < exposures.size(); ++i) {
    if (i == middle) continue;
    Exposure& e = exposures[i];
    const double scale = double(e.photo->picture.width) / first.photo->picture.width;
    const auto own = FindBall(e.photo->picture);
    e.ball = {first.ball.x * scale, first.ball.y * scale, first.ball.radius * scale, 0};
    if (own && std::abs(own->radius / e.ball.radius - 1) < 0.2) e.ball = *own;
    e.ball = LayOnto(first, e);
  }
  double longest = 0;
  for (Exposure& e : exposures) {
    result.balls.push_back(e.ball);
    longest = std::max(longest, e.photo->exposure_s);
  }
  std::vector<ProbePhoto> single;
  if (!(longest > 0)) {  // one photograph without a time
    single = photos;
    single.front().exposure_s = longest = 1;
    exposures.front().photo = &single.front();
  }

  // Distance from the outline's centre by the angle that is shown there.
  constexpr int kTable = 4096;
  std::vector<double> angle_of(kTable + 1);
  for (int i = 0; i <= kTable; ++i) {
    angle_of[std::size_t(i)] = MirroredAngle(double(i) / kTable, options.distance_radii);
  }
  const auto rho_of = [&](double angle) {
    const auto after = std::lower_bound(angle_of.begin(), angle_of.end(), angle);
    if (after == angle_of.begin()) return 0.0;
    if (after == angle_of.end()) return 1.0;
    const double f = (angle - *(after - 1)) / std::max(*after - *(after - 1), 1e-12);
    return (double(after - angle_of.begin()) - 1 + f) / kTable;
  };
  const double last_angle = MirroredAngle(kRimShown, options.distance_radii);
  // The ring around the blind cone.
  constexpr int kSpokes = 64;
  Eigen::Vector3f ring = Eigen::Vector3f::Zero();
  for (int i = 0; i < kSpokes; ++i) {
    ring += Merge(exposures, kRimShown, 2 * kPi * i / kSpokes).light / float(kSpokes);
  }
  result.map = ImageRgbF(options.width, options.width / 2);
  long clipped = 0, dark = 0;
  for (int y = 0; y < result.map.height; ++y) {
    const double lat = kPi * (0.5 - (y + 0.5) / result.map.height);
    for (int x = 0; x < result.map.width; ++x) {
      const double lon = 2 * kPi * ((x + 0.5) / result.map.width - 0.5);
      const double dx = -std::sin(lon) * std::cos(lat), dy = std::sin(lat),
                   dz = std::cos(lon) * std::cos(lat);
      const double angle = std::acos(std::clamp(dz, -1.0, 1.0)), azimuth = std::atan2(dy, dx);
      Merged m = Merge(exposures, std::min(rho_of(angle), kRimShown), azimuth);
      if (angle > last_angle) {
        // Toward the axis the colours around the cone become one.
        const double t = std::clamp((angle - last_angle) / (kPi - last_angle), 0.0, 1.0);
        const float mix = float(t * t * (3 - 2 * t));
        m.light = (1 - mix) * m.light + mix * ring;
      }
      clipped += m.clipped;
      dark += m.dark;
      const Eigen::Vector3f light = float(longest) * m.light;
      std::copy(light.data(), light.data() + 3, result.map.at(x, y));
    }
  }
  const double texels = double(result.map.width) * result.map.height;
  result.clipped = double(clipped) / texels;
  result.dark = double(dark) / texels;
  return result;
}

}  // namespace lorgnette
