// SPDX-License-Identifier: Apache-2.0
// The study as plots and as a page.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "validation/cost/study.h"
#include "validation/html_page.h"

namespace lorgnette::validation {
namespace {

constexpr double kLeft = 64, kTop = 18, kPlotWidth = 600, kPlotHeight = 380, kLegendRow = 17;
constexpr int kColours = 10;

// Three digits, and no exponent where there are more before the point.
std::string Short(double value) {
  return value >= 1000 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

// What stands beside a point: the number in its parameter, or its first word.
std::string Label(const std::string& parameter) {
  const std::size_t digit = parameter.find_first_of("0123456789");
  if (digit == std::string::npos) return parameter.substr(0, parameter.find_first_of(" ,"));
  const long number = std::stol(parameter.substr(digit));
  if (number >= 1 << 20) return fmt::format("{} M", number >> 20);
  return number >= 1 << 10 && number % (1 << 10) == 0 ? fmt::format("{} k", number >> 10)
                                                      : fmt::format("{}", number);
}

// Whole decades that hold all values.
struct LogAxis {
  int low = 0, high = 1;
  LogAxis(std::vector<double> values, double floor) {
    for (double& v : values) v = std::log10(std::max(v, floor));
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    if (least == values.end()) return;
    low = int(std::floor(*least));
    high = std::max(low + 1, int(std::ceil(*most + 1e-12)));
  }
  double At(double value) const {
    return std::clamp((std::log10(std::max(value, 1e-300)) - low) / (high - low), 0.0, 1.0);
  }
};

std::string Power(int exponent) {
  if (exponent >= -2 && exponent <= 4) return fmt::format("{:g}", std::pow(10, exponent));
  return fmt::format("1e{}", exponent);
}

struct Plot {
  LogAxis time, error;
  double X(const CostPoint& p) const { return kLeft + kPlotWidth * time.At(p.time); }
  double Y(double value) const { return kTop + kPlotHeight * (1 - error.At(value)); }
};

std::string Grid(const Plot& plot, const CostStudy& study, const ErrorUnit& unit) {
  std::string svg;
  for (int e = plot.time.low; e <= plot.time.high; ++e) {
    const double x = kLeft + kPlotWidth * (e - plot.time.low) / (plot.time.high - plot.time.low);
    svg += fmt::format(
        "<line x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\" stroke=\"var(--line)\"/>"
        "<text x=\"{0:.1f}\" y=\"{3}\" text-anchor=\"middle\">{4}</text>\n",
        x, kTop, kTop + kPlotHeight, kTop + kPlotHeight + 15, Power(e));
  }
  const int step = std::max(1, (plot.error.high - plot.error.low) / 9);
  for (int e = plot.error.low; e <= plot.error.high; e += step) {
    const double y =
        kTop + kPlotHeight * (1 - double(e - plot.error.low) / (plot.error.high - plot.error.low));
    svg += fmt::format(
        "<line x1=\"{1}\" x2=\"{2}\" y1=\"{0:.1f}\" y2=\"{0:.1f}\" stroke=\"var(--line)\"/>"
        "<text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5}</text>\n",
        y, kLeft, kLeft + kPlotWidth, kLeft - 6, y + 4, Power(e));
  }
  svg += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"end\">time, {}</text>\n",
                     kLeft + kPlotWidth, kTop + kPlotHeight + 31, study.time_unit);
  svg += fmt::format("<text x=\"4\" y=\"11\">error, {}</text>\n", HtmlEscape(unit.name));
  return svg;
}

}  // namespace

std::string CostPlotSvg(const CostStudy& study, std::size_t unit, bool standalone) {
  std::vector<double> times, errors;
  for (const CostPoint& p : study.points) {
    times.push_back(p.time);
    if (p.errors[unit] > 0) errors.push_back(p.errors[unit]);
  }
  const Plot plot{LogAxis(times, 1e-12), LogAxis(errors, 1e-16)};
  std::string svg = Grid(plot, study, study.units[unit]);

  // The front, as steps: what the best is for at most so much time.
  std::vector<const CostPoint*> front;
  for (const CostPoint& p : study.points) {
    if (p.front) front.push_back(&p);
  }
  std::sort(front.begin(), front.end(),
            [](const CostPoint* a, const CostPoint* b) { return a->time < b->time; });
  std::string path;
  double least = std::numeric_limits<double>::infinity();
  for (const CostPoint* p : front) {
    if (!(p->errors[unit] < least)) continue;
    path += path.empty() ? fmt::format("M{:.1f} {:.1f}", plot.X(*p), plot.Y(p->errors[unit]))
                         : fmt::format("H{:.1f}V{:.1f}", plot.X(*p), plot.Y(p->errors[unit]));
    least = p->errors[unit];
  }
  svg += fmt::format(
      "<path d=\"{}\" fill=\"none\" stroke=\"var(--quiet)\" stroke-dasharray=\"4 3\"/>\n", path);

  std::vector<std::string> methods;
  for (const CostPoint& p : study.points) {
    const auto known = std::find(methods.begin(), methods.end(), p.method);
    const int colour = int(known - methods.begin()) % kColours;
    if (known == methods.end()) methods.push_back(p.method);
    const double x = plot.X(p), y = plot.Y(p.errors[unit]);
    svg += fmt::format(
        "<g><title>{0}: {1:.3g} {2}, {3:.3g} {4}</title><circle cx=\"{5:.1f}\" cy=\"{6:.1f}\" "
        "r=\"{7}\" fill=\"{8}\" stroke=\"var(--s{9})\" stroke-width=\"2\"/></g>\n",
        HtmlEscape(p.Name()), p.time, study.time_unit, p.errors[unit], study.units[unit].name, x, y,
        p.front ? 5.5 : 4, p.front ? fmt::format("var(--s{})", colour) : "var(--paper)", colour);
    const std::string label = p.preset.empty() ? Label(p.parameter) : p.preset;
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"9\">{}</text>\n", x + 8, y - 4,
                       HtmlEscape(label));
  }
  double y = kTop + kPlotHeight + 50;
  double x = kLeft;
  for (std::size_t i = 0; i < methods.size(); ++i) {
    const double width = 24 + 6.2 * double(methods[i].size());
    if (x + width > kLeft + kPlotWidth && x > kLeft) {
      x = kLeft;
      y += kLegendRow;
    }
    svg += fmt::format(
        "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" fill=\"var(--s{})\"/><text x=\"{:.1f}\" "
        "y=\"{:.1f}\">{}</text>\n",
        x, y - 4, i % kColours, x + 9, y, HtmlEscape(methods[i]));
    x += width;
  }
  const double width = kLeft + kPlotWidth + 56, height = y + 10;
  const std::string head = fmt::format(
      "<svg {}role=\"img\" aria-label=\"{}: error in {} against time\" viewBox=\"0 0 {} {}\" ",
      standalone ? "xmlns=\"http://www.w3.org/2000/svg\" " : "", HtmlEscape(study.title),
      study.units[unit].name, width, height);
  if (!standalone) {
    return head + "width=\"100%\" style=\"min-width:34rem\">" + svg + "</svg>\n";
  }
  return head + fmt::format(
                    "width=\"{}\" height=\"{}\"><style>{} text {{ fill: var(--ink); font: "
                    "11px sans-serif; }} svg {{ background: var(--paper); }}</style>{}"
                    "</svg>\n",
                    width, height, SeriesColours(), svg);
}

std::string CostHtml(const CostReport& report, const CostBudget* budget) {
  std::string body = fmt::format(
      "<h1>Lorgnette: what accuracy costs in time</h1>\n<p>{}</p>\n<p class=\"quiet\">{}, {} "
      "threads, {}. One dependent multiply-add takes {:.3g} ns; all of it took {:.0f} s. Times are "
      "medians; ± is half the distance between the quartiles. Errors are root mean squares. Filled "
      "points and bold rows are on the front: nothing is both as fast and as accurate.</p>\n<nav>",
      HtmlEscape(report.scene), HtmlEscape(report.machine), report.threads, report.kernel_target,
      report.calibration_ns, report.seconds);
  for (const CostStudy& study : report.studies) {
    body += fmt::format("<a href=\"#{0}\">{0}</a>", study.name);
  }
  body += "</nav>\n";
  for (const CostStudy& study : report.studies) {
    body += fmt::format("<h2 id=\"{}\">{}</h2>\n<p class=\"source\">Errors against {}.</p>\n",
                        study.name, HtmlEscape(study.title), HtmlEscape(study.reference));
    if (budget != nullptr) {
      const CostPoint* best = Recommend(study, *budget);
      body += best != nullptr
                  ? fmt::format("<p>For this budget: <strong>{}</strong>.</p>\n",
                                HtmlEscape(best->Name()))
                  : std::string(Applies(study, *budget)
                                    ? "<p>Nothing here keeps this budget.</p>\n"
                                    : "<p>This budget says nothing about this study.</p>\n");
    }
    for (std::size_t unit = 0; unit < study.units.size(); ++unit) {
      if (unit == 1) body += "<details><summary>The other measures of error</summary>\n";
      body +=
          fmt::format("<p class=\"quiet\">{}: {}</p>\n<div class=\"wide\">{}</div>\n",
                      HtmlEscape(study.units[unit].name), HtmlEscape(study.units[unit].description),
                      CostPlotSvg(study, unit, false));
    }
    if (study.units.size() > 1) body += "</details>\n";
    body += fmt::format(
        "<div class=\"wide\"><table><tr><th>method</th><th class=\"number\">{}</th>"
        "<th class=\"number\">±</th>",
        study.time_unit);
    const bool per_frame = study.ms_per_frame > 0 && study.time_unit != "ms/frame";
    if (per_frame) body += "<th class=\"number\">ms a frame</th>";
    for (const ErrorUnit& unit : study.units) {
      body += fmt::format("<th class=\"number\">{}</th><th class=\"number\">worst</th>", unit.name);
    }
    body += "<th></th></tr>\n";
    for (const CostPoint& p : study.points) {
      body += fmt::format(
          "<tr{}><td class=\"name\">{}</td><td class=\"number\">{}</td><td "
          "class=\"number\">{}</td>",
          p.front ? " class=\"front\"" : "", HtmlEscape(p.Name()), Short(p.time),
          Short(p.time_spread / 2));
      if (per_frame) {
        body += fmt::format("<td class=\"number\">{}</td>", Short(p.time * study.ms_per_frame));
      }
      for (std::size_t i = 0; i < p.errors.size(); ++i) {
        body += fmt::format("<td class=\"number\">{:.2g}</td><td class=\"number\">{:.2g}</td>",
                            p.errors[i], p.worst[i]);
      }
      std::string note = p.preset.empty() ? "" : "--quality " + p.preset;
      if (!p.note.empty()) note += (note.empty() ? "" : "; ") + p.note;
      body += fmt::format("<td>{}</td></tr>\n", HtmlEscape(note));
    }
    body += "</table></div>\n";
  }
  return HtmlPage("Lorgnette: what accuracy costs in time", body);
}

}  // namespace lorgnette::validation
