// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "validation/suite.h"

namespace lorgnette::validation {
namespace {

constexpr const char* kStyle = R"css(
:root { color-scheme: light dark; --ink: #1b2430; --paper: #fcfcfa; --line: #c9d0d8;
  --good: #1d7a4c; --bad: #b3261e; --quiet: #5b6673; }
@media (prefers-color-scheme: dark) { :root { --ink: #e6eaef; --paper: #14181d; --line: #39424d;
  --good: #5fd39a; --bad: #ff8a80; --quiet: #9aa6b2; } }
body { font: 16px/1.45 system-ui, sans-serif; color: var(--ink); background: var(--paper);
  margin: 0 auto; padding: 1rem; max-width: 62rem; }
h1 { font-size: 1.5rem; } h2 { font-size: 1.1rem; margin: 2rem 0 .25rem; }
p { margin: .25rem 0 .5rem; } .source { color: var(--quiet); }
.wide { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th, td { text-align: left; padding: .25rem .6rem .25rem 0; border-bottom: 1px solid var(--line); }
td.number, th.number { text-align: right; white-space: nowrap; }
.pass { color: var(--good); } .fail { color: var(--bad); font-weight: 700; }
svg text { fill: var(--ink); font: 11px system-ui, sans-serif; }
svg a:hover rect { opacity: .75; }
)css";

std::string Escape(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

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
        one.definition->id, Escape(one.definition->title), digits, y + 11, kLeft, y + 2,
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
      one.definition->id, Escape(one.definition->title), one.run.passed() ? "pass" : "fail",
      skipped ? "skipped" : (one.run.passed() ? "pass" : "fail"), Escape(one.definition->source),
      one.definition->group);
  if (skipped) return html + "<p>" + Escape(one.run.skipped()) + "</p>\n";
  html +=
      "<div class=\"wide\"><table><tr><th>quantity</th><th class=\"number\">expected</th>"
      "<th class=\"number\">measured</th><th>unit</th><th class=\"number\">digits</th>"
      "<th class=\"number\">tolerance</th><th>why</th></tr>\n";
  for (const Check& check : one.run.checks()) {
    html += fmt::format(
        "<tr class=\"{}\"><td>{}</td><td class=\"number\">{:.12g}</td><td class=\"number\">{:.12g}"
        "</td><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{:.2g}</td><td>{}</td>"
        "</tr>\n",
        check.passed() ? "" : "fail", Escape(check.quantity), check.expected, check.measured,
        Escape(check.unit),
        check.certainty == Certainty::kBound ? "-" : fmt::format("{:.1f}", check.matching_digits()),
        check.tolerance, Escape(check.reason));
  }
  return html + "</table></div>\n";
}

}  // namespace

std::string HtmlReport(const SuiteResult& result) {
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
      "<title>Lorgnette: validation</title><style>{}</style></head><body>\n"
      "<h1>Lorgnette: validation</h1>\n<p>{} cases pass, <span class=\"{}\">{} fail</span>, {} are "
      "skipped. The bars show the least number of matching digits of each case; a case whose "
      "source is rounded can show no more digits than were printed.</p>\n",
      kStyle, result.passed, result.failed > 0 ? "fail" : "pass", result.failed, result.skipped);
  html += DigitsPlot(result);
  for (const CaseResult& one : result.cases) html += CaseSection(one);
  return html + "</body></html>\n";
}

}  // namespace lorgnette::validation
