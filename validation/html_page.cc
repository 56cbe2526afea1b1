// SPDX-License-Identifier: Apache-2.0
#include "validation/html_page.h"

#include <fmt/format.h>

namespace lorgnette::validation {
namespace {

constexpr const char* kColours = R"css(
:root { color-scheme: light dark; --ink: #1b2430; --paper: #fcfcfa; --line: #c9d0d8;
  --good: #1d7a4c; --bad: #b3261e; --quiet: #5b6673; --s0: #6b7280; --s1: #b45309; --s2: #be123c;
  --s3: #1d4ed8; --s4: #047857; --s5: #7c3aed; --s6: #0e7490; --s7: #a16207; --s8: #9d174d;
  --s9: #374151; }
@media (prefers-color-scheme: dark) { :root { --ink: #e6eaef; --paper: #14181d; --line: #39424d;
  --good: #5fd39a; --bad: #ff8a80; --quiet: #9aa6b2; --s0: #9ca3af; --s1: #fbbf24; --s2: #fb7185;
  --s3: #7dabff; --s4: #34d399; --s5: #c4a5ff; --s6: #67d8ee; --s7: #e3c56b; --s8: #f9a8d4;
  --s9: #d1d5db; } }
)css";

constexpr const char* kStyle = R"css(
body { font: 16px/1.45 system-ui, sans-serif; color: var(--ink); background: var(--paper);
  margin: 0 auto; padding: 1rem; max-width: 64rem; }
h1 { font-size: 1.5rem; } h2 { font-size: 1.1rem; margin: 2rem 0 .25rem; }
p { margin: .25rem 0 .5rem; } .source, .quiet { color: var(--quiet); }
.wide { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; min-width: 38rem; font-variant-numeric: tabular-nums; }
th, td { text-align: left; padding: .25rem .6rem .25rem 0; border-bottom: 1px solid var(--line); }
td.number, th.number { text-align: right; white-space: nowrap; }
td.name { min-width: 19rem; }
tr.front td { font-weight: 650; }
.pass { color: var(--good); } .fail { color: var(--bad); font-weight: 700; }
.summary table { min-width: 0; }
@media (max-width: 40rem) { .summary .group { display: none; } }
.bars { width: calc(100% - 3.9rem); margin: 0 .7rem 0 3.2rem; overflow: visible; }
svg text { fill: var(--ink); font: 11px system-ui, sans-serif; }
svg a:hover rect { opacity: .75; }
a { color: inherit; }
nav a { margin-right: 1rem; }
)css";

}  // namespace

const char* SeriesColours() { return kColours; }

std::string HtmlEscape(const std::string& text) {
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

std::string HtmlPage(const std::string& title, const std::string& body) {
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
      "<title>{}</title><style>{}{}</style></head><body>\n{}</body></html>\n",
      HtmlEscape(title), kColours, kStyle, body);
}

}  // namespace lorgnette::validation
