// SPDX-License-Identifier: Apache-2.0
#include "apps/lens_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "optics/base_curve.h"
#include "optics/power_vector.h"

namespace lorgnette {
namespace {

constexpr int kLabelWidth = 40, kColumnWidth = 26;

std::string Row(const std::string& label, const std::vector<std::string>& cells) {
  std::string line = fmt::format("  {:<{}}", label, kLabelWidth - 2);
  for (const std::string& cell : cells) line += fmt::format("{:>{}}", cell, kColumnWidth);
  return line + '\n';
}

std::string Radius(double mm) { return std::isfinite(mm) ? fmt::format("{:.3f}", mm) : "plano"; }

// One value where both meridians agree as printed.
std::string Meridians(const MeridianPair& pair, const char* format) {
  const std::string along = fmt::format(fmt::runtime(format), pair.along);
  const std::string across = fmt::format(fmt::runtime(format), pair.across);
  return along == across ? along : along + " / " + across;
}
std::string Radii(const MeridianPair& pair) {
  const std::string along = Radius(pair.along), across = Radius(pair.across);
  return along == across ? along : along + " / " + across;
}

std::string PrismText(const EyePrescription& rx) {
  std::string text;
  const auto add = [&](double amount, const char* positive, const char* negative) {
    if (amount == 0) return;
    if (!text.empty()) text += ", ";
    text += fmt::format("{:.2f} {}", std::abs(amount), amount > 0 ? positive : negative);
  };
  add(rx.prism_in.value(), "in", "out");
  add(rx.prism_up.value(), "up", "down");
  return text.empty() ? "-" : text;
}

EyePrescription FormOf(const PowerVector& power) {
  const SphereCylinder form = MinusCylinderForm(power);
  EyePrescription rx;
  rx.sphere = form.sphere;
  rx.cylinder = form.cylinder;
  rx.axis = form.axis;
  return rx;
}

// With the digits that a compensation needs.
std::string PreciseText(const EyePrescription& rx) {
  return fmt::format("{:+.3f} {:+.3f} x {:.1f}", rx.sphere.value(), rx.cylinder.value(),
                     rx.axis.value());
}

std::string FrontName(const LensOrder& order) {
  if (order.progressive) {
    return order.progressive->design == ProgressiveDesign::kSoft ? "soft progressive"
                                                                 : "progressive";
  }
  if (!order.segment) return "distance lens";
  switch (order.segment->shape) {
    case SegmentShape::kRound:
      return fmt::format("round {:.0f}", order.segment->width_mm);
    case SegmentShape::kFlatTop:
      return fmt::format("flat-top {:.0f}", order.segment->width_mm);
    case SegmentShape::kExecutive:
      return "executive";
  }
  return "";
}

}  // namespace

std::string PowerText(const EyePrescription& rx) {
  const double sphere = rx.sphere.value(), cylinder = rx.cylinder.value();
  if (cylinder == 0) return sphere == 0 ? "plano" : fmt::format("{:+.2f}", sphere);
  return fmt::format("{:+.2f} {:+.2f} x {:.0f}", sphere, cylinder, rx.axis.value());
}

std::string LensSheetText(const std::vector<SheetColumn>& columns) {
  std::string text;
  const auto row = [&](const std::string& label,
                       const std::function<std::string(const SheetColumn&)>& cell) {
    std::vector<std::string> cells;
    for (const SheetColumn& column : columns) cells.push_back(cell(column));
    text += Row(label, cells);
  };
  const auto order = [](const SheetColumn& c) -> const LensOrder& {
    return c.lens->design().order;
  };
  row("", [&](const SheetColumn& c) {
    return order(c).eye == Eye::kRight ? "OD (right)" : "OS (left)";
  });
  text += "Order\n";
  const auto any = [&](const auto& of) { return std::any_of(columns.begin(), columns.end(), of); };
  row("power, D", [&](const SheetColumn& c) { return PowerText(c.made->written); });
  row("prism, prism D", [&](const SheetColumn& c) { return PrismText(c.made->written); });
  if (any([&](const SheetColumn& c) { return order(c).rx.add != Diopters(0); })) {
    row("addition, D", [&](const SheetColumn& c) {
      return fmt::format("{:+.2f}, {}", order(c).rx.add.value(), FrontName(order(c)));
    });
  }
  if (any([](const SheetColumn& c) { return c.made->wear.has_value(); })) {
    row("made for the wear, D", [&](const SheetColumn& c) { return PreciseText(order(c).rx); });
    row("worn without that, D", [](const SheetColumn& c) {
      return c.made->wear ? PreciseText(FormOf(c.made->wear->untouched.power)) : "-";
    });
  }
  if (any([](const SheetColumn& c) { return c.made->thinning_down.value() != 0; })) {
    row("thinning, prism D down",
        [](const SheetColumn& c) { return fmt::format("{:.2f}", c.made->thinning_down.value()); });
  }
  if (any([](const SheetColumn& c) { return c.made->prism.has_value(); })) {
    row("prism by", [](const SheetColumn& c) {
      const PrismDesign& p = *c.made->prism;
      return p.decentred ? fmt::format("decentration {:+.2f}, {:+.2f} mm", p.reference_point_mm.x(),
                                       p.reference_point_mm.y())
                         : std::string("grinding");
    });
  }
  row("medium", [&](const SheetColumn& c) {
    const Medium& medium = order(c).medium;
    return fmt::format("{}, n {:.4g}", medium.name, medium.index_d);
  });
  text += "Lens (along the cylinder axis / across it)\n";
  row("front surface F1, D",
      [](const SheetColumn& c) { return Meridians(c.sheet.front_power_D, "{:+.4f}"); });
  row("back surface F2, D",
      [](const SheetColumn& c) { return Meridians(c.sheet.back_power_D, "{:+.4f}"); });
  row("front radius, mm", [](const SheetColumn& c) { return Radii(c.sheet.radius_front_mm); });
  row("back radii, mm", [](const SheetColumn& c) { return Radii(c.sheet.radii_back_mm); });
  row("centre thickness, mm",
      [](const SheetColumn& c) { return fmt::format("{:.2f}", c.sheet.center_thickness_mm); });
  row("edge thickness, mm", [](const SheetColumn& c) {
    return Meridians({c.sheet.edge_thickness_min_mm, c.sheet.edge_thickness_max_mm}, "{:.2f}");
  });
  row("weight, g", [](const SheetColumn& c) { return fmt::format("{:.1f}", c.sheet.mass_g); });
  row("least blank, mm",
      [](const SheetColumn& c) { return fmt::format("{:.1f}", c.sheet.min_blank_mm); });
  row("base curve on a tool of 1.530, D", [](const SheetColumn& c) {
    const double n = c.lens->lens().medium.index_d;
    return Meridians({ToolPower(Diopters(c.sheet.front_power_D.along), n).value(),
                      ToolPower(Diopters(c.sheet.front_power_D.across), n).value()},
                     "{:+.2f}");
  });
  text += "Power\n";
  row("back vertex power, D",
      [](const SheetColumn& c) { return Meridians(c.sheet.back_vertex_power_D, "{:+.4f}"); });
  row("front vertex power, D",
      [](const SheetColumn& c) { return Meridians(c.sheet.front_vertex_power_D, "{:+.4f}"); });
  row("equivalent power, D",
      [](const SheetColumn& c) { return Meridians(c.sheet.equivalent_power_D, "{:+.4f}"); });
  row("paper's equation (1), D",
      [](const SheetColumn& c) { return Meridians(c.sheet.paper_power_D, "{:+.4f}"); });
  row("exact minus equation (1), D",
      [](const SheetColumn& c) { return Meridians(c.sheet.paper_power_error_D, "{:+.1e}"); });
  text += "Magnification\n";
  row("wearer (spectacle magnification)",
      [](const SheetColumn& c) { return Meridians(c.sheet.spectacle_magnification, "{:.5f}"); });
  row("the eyes as a camera sees them", [](const SheetColumn& c) {
    return fmt::format("{:.5f}", c.sheet.observer_magnification_paraxial);
  });

  text += "Light\n";
  row("luminous transmittance, %; category", [](const SheetColumn& c) {
    return fmt::format("{:.1f}; {}", 100 * c.light.luminous_transmittance,
                       c.light.filter_category ? std::to_string(*c.light.filter_category) : "-");
  });
  row("reflection of each surface, %",
      [](const SheetColumn& c) { return fmt::format("{:.2f}", 100 * c.light.reflectance); });
  row("ghost: power, D; intensity, %", [](const SheetColumn& c) {
    return fmt::format("{:+.1f}; {:.4f}", c.light.ghost_power_D, 100 * c.light.ghost_intensity);
  });

  text += "Certificate: rays against the order\n";
  for (const SheetColumn& column : columns) {
    text += fmt::format("  {} {:<{}}{:>12}{:>12}{:>12}{:>10}\n",
                        order(column).eye == Eye::kRight ? "OD" : "OS", "", 45, "predicted",
                        "measured", "difference", "within");
    for (const Measurement& m : column.lens->certificate().measurements) {
      text += fmt::format("     {:<{}}{:>12.5f}{:>12.5f}{:>12.1e}{:>10.3g}{}\n",
                          m.quantity + ", " + m.unit, 45, m.ordered, m.measured,
                          m.measured - m.ordered, m.tolerance, m.passed() ? "" : "  FAILED");
    }
  }
  return text;
}

}  // namespace lorgnette
