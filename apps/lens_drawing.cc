// SPDX-License-Identifier: Apache-2.0
#include "apps/lens_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/lens_maps.h"
#include "apps/svg.h"
#include "optics/outline.h"

namespace lorgnette {
namespace {

using Point = Svg::Point;
using Anchor = Svg::Anchor;

constexpr double kRowHeight = 400, kTitleHeight = 34, kWidth = 1120;
constexpr double kFrontX = 170, kSectionX = 430, kSectionStep = 210, kTableX = 800;
constexpr int kSectionPoints = 96;

double Of(const MeridianPair& pair, bool across) { return across ? pair.across : pair.along; }

std::string RadiusText(const char* name, double mm) {
  return std::isfinite(mm) ? fmt::format("{} {:.2f}", name, mm) : fmt::format("{} plano", name);
}

// The outline in the lens frame, closed.
std::vector<Eigen::Vector2d> OutlineOf(const LensOrder& order) {
  return order.contour_mm.empty() ? Outline::Round(order.diameter_mm).rim() : order.contour_mm;
}

// How far the outline reaches from the optical centre along a direction of the lens frame.
double Reach(const std::vector<Eigen::Vector2d>& outline, const Eigen::Vector2d& direction) {
  double reach = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d& a = outline[i];
    const Eigen::Vector2d& b = outline[(i + 1) % outline.size()];
    const Eigen::Vector2d normal(-direction.y(), direction.x());
    const double da = normal.dot(a), db = normal.dot(b);
    if (da * db > 0 || da == db) continue;
    const Eigen::Vector2d crossing = a + da / (da - db) * (b - a);
    reach = std::max(reach, direction.dot(crossing));
  }
  return reach;
}

// One row of the sheet.
class LensRow {
 public:
  LensRow(const SheetColumn& column, double top, Svg& svg)
      : column_(column),
        lens_(column.lens->lens()),
        order_(column.lens->design().order),
        outline_(OutlineOf(order_)),
        middle_y_(top + kTitleHeight + (kRowHeight - kTitleHeight) / 2),
        top_(top),
        svg_(svg) {}

  void Draw() {
    svg_.Text(
        {24, top_ + 24},
        fmt::format("{} · {} · {}, n {:.4g}", order_.eye == Eye::kRight ? "OD right" : "OS left",
                    PowerText(column_.made->written), order_.medium.name, order_.medium.index_d),
        Anchor::kStart, "title");
    DrawFront();
    const double axis = astigmatic() ? order_.rx.axis.value() : 180;
    DrawSection(kSectionX, axis, false);
    if (astigmatic()) DrawSection(kSectionX + kSectionStep, axis + 90, true);
    DrawTable();
  }

 private:
  bool astigmatic() const { return order_.rx.cylinder.value() != 0; }

  // Seen by someone who faces the wearer: the lens frame's +x, the wearer's right, is at the left.
  Point FrontPoint(const Eigen::Vector2d& p) const {
    return {kFrontX - kDrawingScale * p.x(), middle_y_ - kDrawingScale * p.y()};
  }

  void DrawFront() {
    std::vector<Point> points;
    Eigen::Vector2d low = outline_.front(), high = outline_.front();
    for (const Eigen::Vector2d& p : outline_) {
      points.push_back(FrontPoint(p));
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    svg_.Outline(points, true, "glass");
    svg_.Outline(points, true, "edge");
    const Point left_top = FrontPoint({high.x(), high.y()});
    const Point right_bottom = FrontPoint({low.x(), low.y()});
    const Point centre = FrontPoint({0, 0});
    svg_.Line({left_top.x() - 10, centre.y()}, {right_bottom.x() + 10, centre.y()}, "thin");
    svg_.Line({centre.x(), left_top.y() - 10}, {centre.x(), right_bottom.y() + 10}, "thin");
    if (astigmatic()) {
      const double a = order_.rx.axis.radians();
      const Eigen::Vector2d along(-std::cos(a), std::sin(a));
      const double plus = Reach(outline_, along) + 4, minus = Reach(outline_, -along) + 4;
      svg_.Line(FrontPoint(-minus * along), FrontPoint(plus * along), "axis");
      const Point end = FrontPoint((plus + 3) * along);
      svg_.Text(end + Point(0, -8), fmt::format("axis {:.0f}°", order_.rx.axis.value()),
                Anchor::kMiddle);
    }
    DrawMultifocal();
    svg_.Leader(centre, centre + Point(22, 40), "optical centre", Anchor::kStart);
    if (column_.made->prism && column_.made->prism->decentred) {
      const Point pupil = FrontPoint(column_.made->prism->reference_point_mm);
      svg_.Leader(pupil, pupil + Point(34, -40), "before the pupil", Anchor::kStart);
    }
    const double below = right_bottom.y() + 26;
    svg_.Dimension({left_top.x(), below}, {right_bottom.x(), below}, {centre.x(), below - 5},
                   order_.contour_mm.empty() ? fmt::format("⌀ {:.1f}", order_.diameter_mm)
                                             : fmt::format("{:.1f}", high.x() - low.x()));
    svg_.Text({centre.x(), below + 18}, "from the front", Anchor::kMiddle, "small");
  }

  // The segment's boundary, or the near point of a progressive.
  void DrawMultifocal() {
    if (const auto* bifocal = std::get_if<BifocalSurface>(&lens_.front.shape())) {
      const double line = bifocal->center.y() + bifocal->top;
      if (bifocal->radius == 0) {
        const auto reach = [&](double sign) {
          double x = 0;
          for (std::size_t i = 0; i < outline_.size(); ++i) {
            const Eigen::Vector2d &a = outline_[i], &b = outline_[(i + 1) % outline_.size()];
            if ((a.y() < line) == (b.y() < line)) continue;
            const double at = a.x() + (line - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
            if (at * sign > x * sign) x = at;
          }
          return x;
        };
        svg_.Line(FrontPoint({reach(-1), line}), FrontPoint({reach(1), line}), "thin");
        return;
      }
      std::vector<Point> points;
      for (int i = 0; i < kSectionPoints; ++i) {
        const double a = 2 * kPi * i / kSectionPoints;
        Eigen::Vector2d p =
            bifocal->center + bifocal->radius * Eigen::Vector2d(std::cos(a), std::sin(a));
        p.y() = std::min(p.y(), line);
        points.push_back(FrontPoint(p));
      }
      svg_.Outline(points, true, "thin");
    } else if (order_.progressive) {
      const Point near = FrontPoint(NearPoint(*order_.progressive, order_.eye));
      svg_.Circle(near, 3 * kDrawingScale, "thin");
      svg_.Text(near + Point(0, 4), "near", Anchor::kMiddle, "small");
    }
  }

  // Section through the optical centre along a TABO meridian; world at the left, eye at the right.
  void DrawSection(double x, double meridian_deg, bool across) {
    const double angle = RadiansFromDegrees(meridian_deg);
    Eigen::Vector2d up(-std::cos(angle), std::sin(angle));
    if (up.y() < -1e-9) up = -up;
    const double top_reach = Reach(outline_, up), bottom_reach = Reach(outline_, -up);
    const double t = lens_.center_thickness_mm;
    const auto at = [&](double h, double z) {
      return Point(x + kDrawingScale * (z - t / 2), middle_y_ - kDrawingScale * h);
    };
    std::vector<Point> front, back;
    for (int i = 0; i <= kSectionPoints; ++i) {
      const double h = -bottom_reach + (top_reach + bottom_reach) * i / kSectionPoints;
      const Eigen::Vector2d p = h * up;
      const auto f = lens_.front.Jet(p.x(), p.y());
      const auto thickness = AxialThickness(lens_, p.x(), p.y());
      if (!f || !thickness) continue;
      front.push_back(at(h, f->z));
      back.push_back(at(h, f->z + *thickness));
    }
    std::vector<Point> solid = front;
    solid.insert(solid.end(), back.rbegin(), back.rend());
    svg_.Outline(solid, true, "glass");
    svg_.Outline(solid, true, "edge");
    svg_.Line({x - 62, middle_y_}, {x + 74, middle_y_}, "axis");

    const double axis_below = at(-bottom_reach, 0).y();
    // Centre thickness, carried down to below the lens.
    const double dimension_y = axis_below + 26;
    const Point v1 = at(0, 0), v2 = at(0, t);
    svg_.Line({v1.x(), v1.y()}, {v1.x(), dimension_y + 4}, "thin");
    svg_.Line({v2.x(), v2.y()}, {v2.x(), dimension_y + 4}, "thin");
    svg_.Dimension({v1.x(), dimension_y}, {v2.x(), dimension_y}, {v2.x() + 18, dimension_y + 4},
                   fmt::format("{:.2f} centre", t), Anchor::kStart);
    // Edge thickness at the upper end.
    const double edge = (back.back().x() - front.back().x()) / kDrawingScale;
    const double edge_y = front.back().y() - 14;
    svg_.Line(front.back(), {front.back().x(), edge_y - 4}, "thin");
    svg_.Line(back.back(), {back.back().x(), edge_y - 4}, "thin");
    svg_.Dimension({front.back().x(), edge_y}, {back.back().x(), edge_y},
                   {back.back().x() + 18, edge_y + 4}, fmt::format("{:.2f} edge", edge),
                   Anchor::kStart);
    // Radii.
    const std::size_t upper = front.size() * 7 / 10;
    svg_.Leader(front[upper], front[upper] + Point(-22, -14),
                RadiusText("r₁", Of(column_.sheet.radius_front_mm, across)), Anchor::kEnd);
    svg_.Leader(back[upper], back[upper] + Point(26, -14),
                RadiusText("r₂", Of(column_.sheet.radii_back_mm, across)), Anchor::kStart);
    svg_.Text({x + 78, middle_y_ + 4}, "eye", Anchor::kStart, "small");
    svg_.Text({x, dimension_y + 22},
              astigmatic()
                  ? fmt::format("section {} the axis ({:.0f}°)", across ? "across" : "along",
                                meridian_deg > 180 ? meridian_deg - 180 : meridian_deg)
                  : std::string("section"),
              Anchor::kMiddle, "small");
  }

  void DrawTable() {
    const LensSheet& s = column_.sheet;
    double y = top_ + kTitleHeight + 38;
    const auto number = [](double value, const char* format) {
      return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : std::string("plano");
    };
    const auto row = [&](const std::string& label, const MeridianPair& pair, const char* format) {
      svg_.Text({kTableX, y}, label);
      svg_.Text({kTableX + 235, y}, number(pair.along, format), Anchor::kEnd);
      if (astigmatic()) svg_.Text({kTableX + 300, y}, number(pair.across, format), Anchor::kEnd);
      y += 19;
    };
    if (astigmatic()) {
      svg_.Text({kTableX + 235, y - 19}, "along", Anchor::kEnd, "head");
      svg_.Text({kTableX + 300, y - 19}, "across", Anchor::kEnd, "head");
    }
    row("F₁ front, D", s.front_power_D, "{:+.3f}");
    row("F₂ back, D", s.back_power_D, "{:+.3f}");
    row("r₁, mm", s.radius_front_mm, "{:.2f}");
    row("r₂, mm", s.radii_back_mm, "{:.2f}");
    row("back vertex power, D", s.back_vertex_power_D, "{:+.3f}");
    row("spectacle magnification", s.spectacle_magnification, "{:.4f}");
    y += 8;
    const auto line = [&](const std::string& label, const std::string& value) {
      svg_.Text({kTableX, y}, label);
      svg_.Text({kTableX + 235, y}, value, Anchor::kEnd);
      y += 19;
    };
    line("centre thickness, mm", fmt::format("{:.2f}", s.center_thickness_mm));
    line("edge, least / greatest, mm",
         fmt::format("{:.2f} / {:.2f}", s.edge_thickness_min_mm, s.edge_thickness_max_mm));
    line("weight, g", fmt::format("{:.1f}", s.mass_g));
    line("eyes as a camera sees them", fmt::format("{:.4f}", s.observer_magnification_paraxial));
    y += 8;
    const Certificate& certificate = column_.lens->certificate();
    svg_.Text({kTableX, y},
              fmt::format("measured by rays: {} quantities within tolerance",
                          certificate.measurements.size()),
              Anchor::kStart, "small");
    svg_.Text({kTableX, y + 15}, "lengths in mm; drawn to one scale", Anchor::kStart, "small");
  }

  const SheetColumn& column_;
  const Lens& lens_;
  const LensOrder& order_;
  std::vector<Eigen::Vector2d> outline_;
  double middle_y_, top_;
  Svg& svg_;
};

}  // namespace

std::string LensDrawingSvg(const std::vector<SheetColumn>& lenses) {
  const double height = kRowHeight + kMapRowHeight;
  Svg svg(kWidth, height * static_cast<double>(lenses.size()) + 20);
  double top = 10;
  for (const SheetColumn& column : lenses) {
    LensRow(column, top, svg).Draw();
    DrawMaps(column.lens->lens(), column.lens->design().order.stop_mm, top + kRowHeight, svg);
    top += height;
  }
  return svg.Document();
}

}  // namespace lorgnette
