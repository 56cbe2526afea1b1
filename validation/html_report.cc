// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "validation/html_page.h"
#include "validation/suite.h"

namespace lorgnette::validation {
namespace {

bool HasDigits(const CaseRun& run) {
  for (const Check& check : run.checks()) {
    if (check.certainty != Certainty::kBound) return true;
  }
  return false;
}

// Horizontal bars: least matching digits of each case, 0..16.
std::string DigitsPlot(const SuiteResult& result) {
  constexpr int kRow = 16, kLeft = 52, kScale = 38, kTop = 22;
  int rows = 0;
  std::string bars;
  for (const CaseResult& one : result.cases) {
    if (!HasDigits(one.run)) continue;
    const int y = kTop + kRow * rows++;
    const double digits = one.run.least_digits();
    bars += fmt::format(
        "<a href=\"#{0}\"><title>{0} {1}: {2:.1f} digits</title><text x=\"0\" y=\"{3}\">{0}</text>"
        "<rect x=\"{4}\" y=\"{5}\" width=\"{6:.1f}\" height=\"{7}\" fill=\"var(--{8})\"/></a>\n",
        one.definition->id, HtmlEscape(one.definition->title), digits, y + 11, kLeft, y + 2,
        std::max(1.0, digits * kScale), kRow - 4, one.run.passed() ? "good" : "bad");
  }
  std::string grid;
  const int height = kTop + kRow * rows + 4;
  for (int digits = 0; digits <= 16; digits += 4) {
    const int x = kLeft + digits * kScale;
    grid += fmt::format(
        "<line x1=\"{0}\" x2=\"{0}\" y1=\"16\" y2=\"{1}\" stroke=\"var(--line)\"/>"
        "<text x=\"{0}\" y=\"12\" text-anchor=\"middle\">{2}</text>\n",
        x, height, digits);
  }
  return fmt::format(
      "<div class=\"wide\"><svg role=\"img\" aria-label=\"Matching digits of each case\" "
      "viewBox=\"0 0 {} {}\" width=\"100%\" style=\"min-width:30rem\">{}{}</svg></div>\n",
      kLeft + 16 * kScale + 20, height, grid, bars);
}

std::string CaseSection(const CaseResult& one) {
  const bool skipped = !one.run.skipped().empty();
  std::string html = fmt::format(
      "<h2 id=\"{0}\">{0} · {1} <span class=\"{2}\">{3}</span></h2>\n<p class=\"source\">{4} · "
      "group {5}</p>\n",
      one.definition->id, HtmlEscape(one.definition->title), one.run.passed() ? "pass" : "fail",
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
      "skipped. The bars show the least number of matching digits of each case; a case whose "
      "source is rounded can show no more digits than were printed.</p>\n",
      result.passed, result.failed > 0 ? "fail" : "pass", result.failed, result.skipped);
  body += DigitsPlot(result);
  for (const CaseResult& one : result.cases) body += CaseSection(one);
  return HtmlPage("Lorgnette: validation", body);
}

}  // namespace lorgnette::validation
