// SPDX-License-Identifier: Apache-2.0
// The subcommands, each added by one function. Private to apps/.
#pragma once

#include <iosfwd>
#include <string>

#include "base/result.h"

namespace CLI {
class App;
}

namespace lorgnette {

// Where a command prints, and what came of it.
struct CommandContext {
  std::ostream& out;
  Status status;
  std::string command_line;  // the arguments, one a line
};

void AddTryonCommand(CLI::App& program, CommandContext& context);
void AddTrackCommand(CLI::App& program, CommandContext& context);
void AddCalibrateCommand(CLI::App& program, CommandContext& context);
void AddLensCommand(CLI::App& program, CommandContext& context);
void AddMeasureCommand(CLI::App& program, CommandContext& context);
void AddFramesCommand(CLI::App& program, CommandContext& context);
void AddComposeCommand(CLI::App& program, CommandContext& context);
void AddProbeCommand(CLI::App& program, CommandContext& context);
void AddValidateCommand(CLI::App& program, CommandContext& context);
void AddCostCommand(CLI::App& program, CommandContext& context);
void AddServeCommand(CLI::App& program, CommandContext& context);

}  // namespace lorgnette
