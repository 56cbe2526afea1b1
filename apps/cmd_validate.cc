// SPDX-License-Identifier: Apache-2.0
// lorgnette validate: the numbered cases, what they found, and an exit code that says whether all
// hold.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <memory>
#include <ostream>
#include <string>

#include "apps/commands.h"
#include "base/atomic_file.h"
#include "validation/suite.h"

namespace lorgnette {
namespace {

struct ValidateOptions {
  std::string id, group, html_path;
  bool json = false, all = false;
};

Status Validate(const ValidateOptions& options, std::ostream& out) {
  LG_ASSIGN(const validation::SuiteResult result,
            validation::RunSuite(options.id, options.group, options.all));
  out << (options.json ? validation::JsonReport(result) : validation::TextTable(result));
  if (!options.html_path.empty()) {
    LG_RETURN_IF_ERROR(WriteFileAtomically(options.html_path, validation::HtmlReport(result)));
  }
  if (result.failed > 0) {
    return Failure(fmt::format("validation: {} of {} cases fail", result.failed,
                               result.passed + result.failed));
  }
  return {};
}

}  // namespace

void AddValidateCommand(CLI::App& program, CommandContext& context) {
  CLI::App& command = *program.add_subcommand(
      "validate", "Run the numbered validation cases: what is right, to how many digits");
  const auto options = std::make_shared<ValidateOptions>();
  command.add_option("--case", options->id, "Only this case, as V012");
  command.add_option("--group", options->group, "Only this group, as magnification");
  command.add_flag("--all", options->all, "Also the slow cases: path-traced pictures");
  command.add_flag("--json", options->json, "Print the report as JSON");
  command.add_option("--html", options->html_path, "Also write a page that needs no network");
  command.footer(
      "Examples:\n"
      "  lorgnette validate\n"
      "  lorgnette validate --group magnification --html validation.html\n"
      "Exit code 1 when a case fails. docs/validation.md explains digits and tolerances.");
  command.final_callback([options, &context] { context.status = Validate(*options, context.out); });
}

}  // namespace lorgnette
