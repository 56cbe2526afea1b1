// SPDX-License-Identifier: Apache-2.0
#include "apps/program.h"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

#include "apps/commands.h"

namespace lorgnette {
namespace {

// One line, without the full stop that some messages of the parser have.
std::string Sentence(std::string message) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  while (!message.empty() && (message.back() == ' ' || message.back() == '.')) message.pop_back();
  return message;
}

}  // namespace

const char* ProgramVersion() { return LORGNETTE_VERSION; }

int RunProgram(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
  CLI::App program(
      "Lorgnette puts prescription eyeglasses on a face in a video: it designs the two lenses, "
      "measures them by tracing rays, cuts them to the frame, and shows the wearer with them on.",
      "lorgnette");
  program.set_version_flag("--version", std::string("lorgnette ") + ProgramVersion(),
                           "Print the version and exit");
  program.set_help_flag("-h,--help", "Print this help and exit");
  program.require_subcommand(1);
  program.footer(
      "`lorgnette COMMAND --help` explains a command, with examples.\n"
      "Exit codes: 0 done, 1 it failed, 2 the request cannot be meant.");

  CommandContext context{out, {}, {}};
  for (int i = 1; i < argc; ++i) context.command_line += std::string(argv[i]) + '\n';
  AddTryonCommand(program, context);
  AddTrackCommand(program, context);
  AddCalibrateCommand(program, context);
  AddLensCommand(program, context);
  AddMeasureCommand(program, context);
  AddFramesCommand(program, context);
  AddComposeCommand(program, context);
  AddProbeCommand(program, context);
  AddValidateCommand(program, context);
  AddCostCommand(program, context);
  AddServeCommand(program, context);

  std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
  std::reverse(arguments.begin(), arguments.end());  // the order that the parser takes
  try {
    program.parse(std::move(arguments));
  } catch (const CLI::Success& request) {  // --help or --version
    std::ostringstream ignored;
    program.exit(request, out, ignored);
    return kExitOk;
  } catch (const CLI::ParseError& error) {
    const auto chosen = program.get_subcommands();
    err << "lorgnette" << (chosen.empty() ? "" : " " + chosen.front()->get_name()) << ": "
        << Sentence(error.what()) << " (--help explains)\n";
    return kExitUsage;
  } catch (const std::exception& error) {
    err << "lorgnette: " << Sentence(error.what()) << '\n';
    return kExitFailure;
  }
  if (context.status) return kExitOk;
  const Error& error = context.status.error();
  err << "lorgnette: " << Sentence(error.message) << '\n';
  return error.kind == ErrorKind::kUsage ? kExitUsage : kExitFailure;
}

}  // namespace lorgnette
