// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "validation/html_page.h"
#include "validation/suite.h"

namespace lorgnette::validation {
namespace {

// A bar of a plot: its case, how long it is (0..16), and what to say when pointed at.
struct Bar {
  const CaseResult* of;
  double value;
  std::string text;
};

// Horizontal bars over 0..16, as wide as the page allows with letters of one size.
std::string BarPlot(const std::vector<Bar>& bars, const std::string& label) {
  constexpr int kRow = 16, kTop = 22, kMost = 16;
  const int height = kTop + kRow * int(bars.size()) + 4;
  std::string svg;
  for (int tick = 0; tick <= kMost; tick += 4) {
    svg += fmt::format(
        "<line x1=\"{0}%\" x2=\"{0}%\" y1=\"16\" y2=\"{1}\" stroke=\"var(--line)\"/>"
        "<text x=\"{0}%\" y=\"12\" text-anchor=\"middle\">{2}</text>\n",
        100.0 * tick / kMost, height, tick);
  }
  for (std::size_t row = 0; row < bars.size(); ++row) {
    const Bar& bar = bars[row];
    const int y = kTop + kRow * int(row);
    svg += fmt::format(
        "<a href=\"#{0}\"><title>{0} {1}: {2}</title><text x=\"-46\" y=\"{3}\">{0}</text>"
        "<rect x=\"0\" y=\"{4}\" width=\"{5:.2f}%\" height=\"{6}\" fill=\"var(--{7})\"/></a>\n",
        bar.of->definition->id, HtmlEscape(bar.of->definition->title), HtmlEscape(bar.text), y + 11,
        y + 2, std::clamp(100 * bar.value / kMost, 0.3, 100.0), kRow - 4,
        bar.of->run.passed() ? "good" : "bad");
  }
  return fmt::format("<svg class=\"bars\" role=\"img\" aria-label=\"{}\" height=\"{}\">{}</svg>\n",
                     HtmlEscape(label), height, svg);
}

// Each case's least matching digits.
std::vector<Bar> DigitBars(const SuiteResult& result) {
  std::vector<Bar> bars;
  for (const CaseResult& one : result.cases) {
    const auto& checks = one.run.checks();
    if (std::all_of(checks.begin(), checks.end(),
                    [](const Check& c) { return c.certainty == Certainty::kBound; })) {
      continue;
    }
    const double digits = one.run.least_digits();
    bars.push_back({&one, digits, fmt::format("{:.1f} digits", digits)});
  }
  return bars;
}

// By how many powers of two each case stays below the bound that it comes nearest to.
std::vector<Bar> MarginBars(const SuiteResult& result) {
  std::vector<Bar> bars;
  for (const CaseResult& one : result.cases) {
    double nearest = -1;  // error over bound, the greatest
    for (const Check& check : one.run.checks()) {
      if (check.certainty != Certainty::kBound || check.tolerance <= 0) continue;
      nearest = std::max(nearest, check.measured / check.tolerance);
    }
    if (nearest < 0) continue;
    bars.push_back(
        {&one, -std::log2(std::max(nearest, 1e-9)), fmt::format("{:.3g} of its bound", nearest)});
  }
  return bars;
}

std::string SummaryTable(const SuiteResult& result) {
  std::string html =
      "<div class=\"wide summary\"><table><tr><th>case</th><th></th><th "
      "class=\"number\">digits</th>"
      "<th class=\"group\">group</th><th>title</th></tr>\n";
  for (const CaseResult& one : result.cases) {
    const bool skipped = !one.run.skipped().empty();
    html += fmt::format(
        "<tr><td><a href=\"#{0}\">{0}</a></td><td class=\"{1}\">{2}</td>"
        "<td class=\"number\">{3}</td><td class=\"group\">{4}</td><td>{5}</td></tr>\n",
        one.definition->id,
        skipped            ? "quiet"
        : one.run.passed() ? "pass"
                           : "fail",
        skipped            ? "skipped"
        : one.run.passed() ? "pass"
                           : "fail",
        DigitsText(one.run), one.definition->group, HtmlEscape(one.definition->title));
  }
  return html + "</table></div>\n";
}

std::string CaseSection(const CaseResult& one) {
  const bool skipped = !one.run.skipped().empty();
  std::string html = fmt::format(
      "<h2 id=\"{0}\">{0} · {1} <span class=\"{2}\">{3}</span></h2>\n<p class=\"source\">{4} · "
      "group {5}</p>\n",
      one.definition->id, HtmlEscape(one.definition->title),
      skipped ? "quiet" : (one.run.passed() ? "pass" : "fail"),
      skipped ? "skipped" : (one.run.passed() ? "pass" : "fail"),
      HtmlEscape(one.definition->source), one.definition->group);
  if (skipped) return html + "<p>" + HtmlEscape(one.run.skipped()) + "</p>\n";
  html +=
      "<div class=\"wide\"><table><tr><th>quantity</th><th class=\"number\">expected</th>"
      "<th class=\"number\">measured</th><th>unit</th><th class=\"number\">digits</th>"
      "<th class=\"number\">tolerance</th><th>why</th></tr>\n";
  for (const Check& check : one.run.checks()) {
    html += fmt::format(
        "<tr class=\"{}\"><td>{}</td><td class=\"number\">{:.12g}</td><td class=\"number\">{:.12g}"
        "</td><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{:.2g}</td><td>{}</td>"
        "</tr>\n",
        check.passed() ? "" : "fail", HtmlEscape(check.quantity), check.expected, check.measured,
        HtmlEscape(check.unit),
        check.certainty == Certainty::kBound ? "-" : fmt::format("{:.1f}", check.matching_digits()),
        check.tolerance, HtmlEscape(check.reason));
  }
  return html + "</table></div>\n";
}

}  // namespace

std::string HtmlReport(const SuiteResult& result) {
  std::string body = fmt::format(
      "<h1>Lorgnette: validation</h1>\n<p>{} cases pass, <span class=\"{}\">{} fail</span>, {} are "
      "skipped.</p>\n",
      result.passed, result.failed > 0 ? "fail" : "pass", result.failed, result.skipped);
  body += SummaryTable(result);
  body +=
      "<h2>Matching digits</h2>\n<p class=\"quiet\">The least of each case, 0 to 16. A case whose "
      "source is rounded can show no more digits than were printed.</p>\n";
  body += BarPlot(DigitBars(result), "Matching digits of each case");
  body +=
      "<h2>Errors and their bounds</h2>\n<p class=\"quiet\">How many times the error of each case "
      "could double before it meets the nearest of its bounds; 16 stands for more, too.</p>\n";
  body += BarPlot(MarginBars(result), "Doublings between error and bound of each case");
  for (const CaseResult& one : result.cases) body += CaseSection(one);
  return HtmlPage("Lorgnette: validation", body);
}

}  // namespace lorgnette::validation
