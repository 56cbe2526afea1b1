// SPDX-License-Identifier: Apache-2.0
// The program `lorgnette`: one subcommand a job, each in a file of its own (cmd_*.cc). The library
// does the work; a command reads options, calls it, and prints.
#pragma once

#include <iosfwd>

namespace lorgnette {

inline constexpr int kExitOk = 0, kExitFailure = 1, kExitUsage = 2;

// Runs a command line and returns its exit code. Results go to `out`; on failure one sentence goes
// to `err`. (Progress of long jobs goes to the process's standard error.)
int RunProgram(int argc, const char* const* argv, std::ostream& out, std::ostream& err);

// "0.1.0"
const char* ProgramVersion();

}  // namespace lorgnette
