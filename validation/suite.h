// SPDX-License-Identifier: Apache-2.0
// Runs validation cases and writes what they found.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "validation/case.h"

namespace lorgnette::validation {

struct CaseResult {
  const Case* definition = nullptr;
  CaseRun run;
  double seconds = 0;
};

struct SuiteResult {
  std::vector<CaseResult> cases;
  int passed = 0, failed = 0, skipped = 0;
  int left_out = 0;  // slow ones that nobody asked for
};

// Cases by exact id and group; an empty string takes all. Fails when nothing matches.
//   slow  also those that take seconds; a case that is named by its id always runs
Result<SuiteResult> RunSuite(const std::string& id, const std::string& group, bool slow = false);

// The least matching digits of a case, or "-" when it has only bounds.
std::string DigitsText(const CaseRun& run);
// One line a case: number, group, matching digits, verdict, title; failed checks below their case.
std::string TextTable(const SuiteResult& result);
// Everything, for machines (docs/validation.md has the keys).
std::string JsonReport(const SuiteResult& result);
// One page that needs no network: a summary, plots of digits and margins, a table a case; light and
// dark.
std::string HtmlReport(const SuiteResult& result);

}  // namespace lorgnette::validation
