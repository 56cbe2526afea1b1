// SPDX-License-Identifier: Apache-2.0
#include "apps/lens_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "optics/power_map.h"

namespace lorgnette {
namespace {

using Point = Svg::Point;

constexpr int kGrid = 61;         // points a side
constexpr double kBeyond = 1.05;  // the grid reaches past the disc's rim, which is cut round
constexpr double kRadius = 88, kStep = 215, kFirst = 124, kDiscY = 128;
constexpr int kBands = 7;               // about so many
constexpr double kLabelGap = 15;        // between labels along their ray
constexpr double kLabelDirection = 40;  // degrees, of that ray
constexpr int kTickEvery = 6;           // grid points between axis marks
constexpr double kTickLength = 4.5, kLeastTick_D = 0.02;

struct Quantity {
  std::string title, unit;
  std::function<double(const MapPoint&)> value;
  bool axis_marks = false;
};

// 1, 2 or 5 times a power of ten, so that some kBands steps fill the range.
double NiceStep(double range) {
  const double rough = range / kBands, decade = std::pow(10, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * decade >= rough) return factor * decade;
  }
  return 10 * decade;
}

std::string ColourAt(double t) {
  constexpr std::array<std::array<double, 3>, 3> kRamp = {
      {{250, 251, 245}, {120, 170, 205}, {32, 74, 128}}};
  const double at = 2 * std::clamp(t, 0.0, 1.0);
  const auto i = std::size_t(std::min(at, 1.0));
  std::string colour = "#";
  for (std::size_t k = 0; k < 3; ++k) {
    const double mixed = kRamp[i][k] + (at - double(i)) * (kRamp[i + 1][k] - kRamp[i][k]);
    colour += fmt::format("{:02x}", int(std::lround(mixed)));
  }
  return colour;
}

class Disc {
 public:
  Disc(const PowerMap& map, const Quantity& quantity, const Point& centre, Svg& svg)
      : map_(map), quantity_(quantity), centre_(centre), svg_(svg) {
    scale_ = kRadius / std::tan(RadiansFromDegrees(kMapHalfAngle_deg));
    reach_ = std::tan(RadiansFromDegrees(map.half_angle_deg));
    for (int j = 0; j < kGrid; ++j) {
      for (int i = 0; i < kGrid; ++i) {
        if (!Has(i, j) || (At(i, j) - centre_).norm() > kRadius) continue;
        least_ = std::min(least_, Value(i, j));
        greatest_ = std::max(greatest_, Value(i, j));
      }
    }
  }

  void Draw() {
    svg_.Text(centre_ + Point(0, -kRadius - 12),
              quantity_.title + (quantity_.unit.empty() ? "" : ", " + quantity_.unit),
              Svg::Anchor::kMiddle, "head");
    if (!(least_ <= greatest_)) {
      svg_.Text(centre_, "no ray passes", Svg::Anchor::kMiddle, "small");
      return;
    }
    const double range = greatest_ - least_;
    // A flat map has rounding for a range.
    const bool flat = range <= 1e-9 * std::max(1.0, std::abs(greatest_));
    const double step = flat ? 1 : NiceStep(range);
    const double first = flat ? greatest_ : step * std::floor(least_ / step);
    const int bands = flat ? 1 : int(std::ceil((greatest_ - first) / step));
    svg_.BeginClip(centre_, kRadius);
    for (int k = 0; k < bands; ++k) {
      const double t = bands > 1 ? double(k) / (bands - 1) : 0;
      const double level = k == 0 ? -HUGE_VAL : first + k * step;
      svg_.Path(Above(level), fmt::format(R"(fill="{}")", ColourAt(t)));
      if (k > 0) svg_.Path(LineAt(level), R"(fill="none" stroke="#45627e" stroke-width="0.6")");
    }
    if (quantity_.axis_marks) DrawAxes();
    svg_.EndClip();
    svg_.Circle(centre_, kRadius, "edge");
    if (!flat) Label(first, step, bands);
    const int digits = flat ? 3 : std::max(0, -int(std::floor(std::log10(step))));
    svg_.Text(centre_ + Point(0, kRadius + 16),
              fmt::format("{:.{}f} to {:.{}f}", least_, digits + 1, greatest_, digits + 1),
              Svg::Anchor::kMiddle, "label");
    if (!flat) {
      svg_.Text(centre_ + Point(0, kRadius + 30), fmt::format("a line every {:g}", step),
                Svg::Anchor::kMiddle, "small");
    }
  }

 private:
  bool Has(int i, int j) const { return map_.at(i, j).status == RayStatus::kOk; }
  double Value(int i, int j) const { return quantity_.value(map_.at(i, j)); }
  // The tangents of a grid point, as the eye turns; right of the wearer is left in the drawing.
  Point At(double i, double j) const {
    const double tx = -reach_ + 2 * reach_ * i / (kGrid - 1);
    const double ty = reach_ - 2 * reach_ * j / (kGrid - 1);
    return centre_ + scale_ * Point(-tx, -ty);
  }

  // The region where the value is at least `level`, one path: whole cells of a row in one piece.
  std::string Above(double level) const {
    std::string path;
    const auto close = [&](const std::vector<Point>& polygon) {
      for (std::size_t k = 0; k < polygon.size(); ++k) {
        path += fmt::format("{}{:.1f} {:.1f}", k == 0 ? 'M' : 'L', polygon[k].x(), polygon[k].y());
      }
      path += 'Z';
    };
    for (int j = 0; j + 1 < kGrid; ++j) {
      int run = -1;
      const auto end_run = [&](int i) {
        if (run >= 0) close({At(run, j), At(i, j), At(i, j + 1), At(run, j + 1)});
        run = -1;
      };
      for (int i = 0; i + 1 < kGrid; ++i) {
        const int ci[] = {i, i + 1, i + 1, i}, cj[] = {j, j, j + 1, j + 1};
        bool known = true;
        int inside = 0;
        std::array<double, 4> v{};
        for (std::size_t k = 0; k < 4 && known; ++k) {
          known = Has(ci[k], cj[k]);
          if (!known) break;
          v[k] = Value(ci[k], cj[k]);
          inside += v[k] >= level;
        }
        if (!known || inside == 0) {
          end_run(i);
        } else if (inside == 4) {
          if (run < 0) run = i;
        } else {
          end_run(i);
          std::vector<Point> polygon;
          for (std::size_t k = 0; k < 4; ++k) {
            const std::size_t next = (k + 1) % 4;
            if (v[k] >= level) polygon.push_back(At(ci[k], cj[k]));
            if ((v[k] >= level) == (v[next] >= level)) continue;
            const double s = (level - v[k]) / (v[next] - v[k]);
            polygon.push_back(At(ci[k] + s * (ci[next] - ci[k]), cj[k] + s * (cj[next] - cj[k])));
          }
          close(polygon);
        }
      }
      end_run(kGrid - 1);
    }
    return path;
  }

  // The contour line itself, in pieces.
  std::string LineAt(double level) const {
    std::string path;
    for (int j = 0; j + 1 < kGrid; ++j) {
      for (int i = 0; i + 1 < kGrid; ++i) {
        const int ci[] = {i, i + 1, i + 1, i}, cj[] = {j, j, j + 1, j + 1};
        if (!(Has(i, j) && Has(i + 1, j) && Has(i + 1, j + 1) && Has(i, j + 1))) continue;
        bool start = true;
        for (std::size_t k = 0; k < 4; ++k) {
          const std::size_t next = (k + 1) % 4;
          const double v = Value(ci[k], cj[k]), w = Value(ci[next], cj[next]);
          if ((v >= level) == (w >= level)) continue;
          const double s = (level - v) / (w - v);
          const Point p = At(ci[k] + s * (ci[next] - ci[k]), cj[k] + s * (cj[next] - cj[k]));
          path += fmt::format("{}{:.1f} {:.1f}", start ? 'M' : 'L', p.x(), p.y());
          start = !start;
        }
      }
    }
    return path;
  }

  void DrawAxes() {
    for (int j = kTickEvery / 2; j < kGrid; j += kTickEvery) {
      for (int i = kTickEvery / 2; i < kGrid; i += kTickEvery) {
        if (!Has(i, j)) continue;
        const SphereCylinder form = MinusCylinderForm(map_.at(i, j).power);
        if (std::abs(form.cylinder.value()) < kLeastTick_D) continue;
        // Seen from the front a TABO axis is what it says: 0 at the right, counter-clockwise.
        const double a = form.axis.radians();
        const Point half = kTickLength * Point(std::cos(a), -std::sin(a));
        svg_.Line(At(i, j) - half, At(i, j) + half, "mark");
      }
    }
  }

  // Along one ray from the centre, where the lines cross it.
  void Label(double first, double step, int bands) {
    const double a = RadiansFromDegrees(kLabelDirection), middle = 0.5 * (kGrid - 1);
    const double grid_radius = middle * std::tan(RadiansFromDegrees(kMapHalfAngle_deg)) / reach_;
    double last = -kLabelGap, before = HUGE_VAL;
    for (double r = 0; r < 0.97; r += 0.01) {
      const double i = middle + r * grid_radius * std::cos(a);
      const double j = middle - r * grid_radius * std::sin(a);
      const int ii = int(std::lround(i)), jj = int(std::lround(j));
      if (!Has(ii, jj)) return;
      const double value = Value(ii, jj);
      for (int k = 1; k < bands && before != HUGE_VAL; ++k) {
        const double level = first + k * step;
        if ((before < level) == (value < level) || r * kRadius - last < kLabelGap) continue;
        last = r * kRadius;
        svg_.Text(At(i, j) + Point(0, 3),
                  fmt::format("{:g}", level == 0 ? 0.0 : Rounded(level, step)),
                  Svg::Anchor::kMiddle, "contour");
      }
      before = value;
    }
  }
  static double Rounded(double level, double step) { return step * std::round(level / step); }

  const PowerMap& map_;
  const Quantity& quantity_;
  Point centre_;
  Svg& svg_;
  double scale_ = 1, reach_ = 1, least_ = HUGE_VAL, greatest_ = -HUGE_VAL;
};

}  // namespace

void DrawMaps(const Lens& lens, double stop_mm, double top, Svg& svg) {
  PowerMapOptions options;
  options.size = kGrid;
  options.half_angle_deg = kMapHalfAngle_deg * kBeyond;
  options.stop_mm = stop_mm;
  const PowerMap map = MakePowerMap(lens, lens.medium.index_d, options);
  const std::array<Quantity, 5> quantities = {
      {{"mean power", "D", [](const MapPoint& p) { return p.power.mean; }},
       {"cylinder and its axis", "D",
        [](const MapPoint& p) { return 2 * std::hypot(p.power.j0, p.power.j45); }, true},
       {"prism", "prism D", [](const MapPoint& p) { return p.prism.norm(); }},
       {"distortion", "per cent", [](const MapPoint& p) { return 100 * p.distortion; }},
       {"lateral colour F to C", "prism D", [](const MapPoint& p) { return p.lateral_colour; }}}};
  svg.Text({24, top + 12},
           fmt::format("as the eye turns up to {:.0f}° about a point {:.0f} mm behind the lens, "
                       "distant object, seen from the front",
                       kMapHalfAngle_deg, stop_mm),
           Svg::Anchor::kStart, "small");
  for (std::size_t k = 0; k < quantities.size(); ++k) {
    Disc(map, quantities[k], {kFirst + kStep * double(k), top + kDiscY}, svg).Draw();
  }
}

}  // namespace lorgnette
