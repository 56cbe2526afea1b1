// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <iostream>

#include "apps/program.h"

int main(int argc, char** argv) {
  // A file past the size limit is then a failed write, which has a sentence, and not a signal.
  std::signal(SIGXFSZ, SIG_IGN);
  return lorgnette::RunProgram(argc, argv, std::cout, std::cerr);
}
