// SPDX-License-Identifier: Apache-2.0
#include "apps/lens_text.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>

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
  row("power, D", [&](const SheetColumn& c) { return PowerText(order(c).rx); });
  row("prism, prism D", [&](const SheetColumn& c) { return PrismText(order(c).rx); });
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
