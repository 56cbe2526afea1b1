// SPDX-License-Identifier: Apache-2.0
// The frame of the reports' pages: one file, light and dark, for wide and narrow screens, that asks
// the network for nothing.
#pragma once

#include <string>

namespace lorgnette::validation {

std::string HtmlEscape(const std::string& text);

// body: HTML. Styles that it can use: class `wide` scrolls sideways what a narrow screen cannot
// hold; `number`, `pass`, `fail`, `source`, `quiet`; colours --ink, --paper, --line, --good, --bad,
// --quiet and --s0 to --s9 for series.
std::string HtmlPage(const std::string& title, const std::string& body);

// The series colours as style rules, for drawings that stand alone.
const char* SeriesColours();

}  // namespace lorgnette::validation
