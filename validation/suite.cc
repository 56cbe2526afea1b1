// SPDX-License-Identifier: Apache-2.0
#include "validation/suite.h"

#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>

namespace lorgnette::validation {
namespace {

const char* Verdict(const CaseRun& run) {
  if (!run.skipped().empty()) return "skip";
  return run.passed() ? "pass" : "FAIL";
}

const char* Name(Certainty certainty) {
  switch (certainty) {
    case Certainty::kExact:
      return "exact";
    case Certainty::kRounded:
      return "rounded";
    case Certainty::kEstimated:
      return "estimated";
    case Certainty::kBound:
      return "bound";
  }
  return "";
}

}  // namespace

std::string DigitsText(const CaseRun& run) {
  for (const Check& check : run.checks()) {
    if (check.certainty != Certainty::kBound) return fmt::format("{:4.1f}", run.least_digits());
  }
  return "   -";
}

Result<SuiteResult> RunSuite(const std::string& id, const std::string& group, bool slow) {
  SuiteResult result;
  for (const Case* definition : AllCases()) {
    if (!id.empty() && id != definition->id) continue;
    if (!group.empty() && group != definition->group) continue;
    if (definition->slow && !slow && id.empty()) {
      ++result.left_out;
      continue;
    }
    CaseResult one{definition, {}, 0};
    const auto start = std::chrono::steady_clock::now();
    definition->run(one.run);
    one.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (!one.run.skipped().empty()) {
      ++result.skipped;
    } else if (one.run.passed()) {
      ++result.passed;
    } else {
      ++result.failed;
    }
    result.cases.push_back(std::move(one));
  }
  if (result.cases.empty() && result.left_out == 0) {
    return UsageError(fmt::format(
        "--case/--group: no validation case matches case '{}', group '{}'; cases run from {} to {}",
        id, group, AllCases().front()->id, AllCases().back()->id));
  }
  return result;
}

std::string TextTable(const SuiteResult& result) {
  std::string text =
      fmt::format("{:<5} {:<14} {:>6} {:<5} {}\n", "case", "group", "digits", "", "title");
  for (const CaseResult& one : result.cases) {
    text += fmt::format("{:<5} {:<14} {:>6} {:<5} {}\n", one.definition->id, one.definition->group,
                        DigitsText(one.run), Verdict(one.run), one.definition->title);
    if (!one.run.skipped().empty()) text += fmt::format("      {}\n", one.run.skipped());
    for (const Check& check : one.run.checks()) {
      if (check.passed()) continue;
      text +=
          fmt::format("      {}: expected {:.12g} {}, measured {:.12g}, tolerance {:.3g} ({})\n",
                      check.quantity, check.expected, check.unit, check.measured, check.tolerance,
                      check.reason);
    }
  }
  text += fmt::format("{} passed, {} failed, {} skipped\n", result.passed, result.failed,
                      result.skipped);
  if (result.left_out > 0) text += fmt::format("{} slow cases left out (--all)\n", result.left_out);
  return text;
}

std::string JsonReport(const SuiteResult& result) {
  using Json = nlohmann::ordered_json;
  Json cases = Json::array();
  for (const CaseResult& one : result.cases) {
    Json checks = Json::array();
    for (const Check& check : one.run.checks()) {
      checks.push_back({{"quantity", check.quantity},
                        {"unit", check.unit},
                        {"expected", check.expected},
                        {"certainty", Name(check.certainty)},
                        {"measured", check.measured},
                        {"tolerance", check.tolerance},
                        {"tolerance_reason", check.reason},
                        {"matching_digits", check.matching_digits()},
                        {"passed", check.passed()}});
    }
    cases.push_back({{"case", one.definition->id},
                     {"group", one.definition->group},
                     {"title", one.definition->title},
                     {"source", one.definition->source},
                     {"verdict", Verdict(one.run)},
                     {"skipped_because", one.run.skipped()},
                     {"seconds", one.seconds},
                     {"checks", checks}});
  }
  const Json report = {{"passed", result.passed},
                       {"failed", result.failed},
                       {"skipped", result.skipped},
                       {"left_out", result.left_out},
                       {"cases", cases}};
  return report.dump(2) + "\n";
}

}  // namespace lorgnette::validation
