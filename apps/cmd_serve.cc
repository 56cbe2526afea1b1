// SPDX-License-Identifier: Apache-2.0
// lorgnette serve: the optician's page on this machine.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <csignal>
#include <memory>
#include <ostream>

#include "apps/commands.h"
#include "apps/page_server.h"
#include "cmake/source_dir.h"

namespace lorgnette {
namespace {

struct ServeOptions {
  std::string folder = LORGNETTE_SOURCE_DIR "/web/dist";
  std::string host = "127.0.0.1";
  int port = 8137;
};

Status Serve(const ServeOptions& options, std::ostream& out) {
  LG_ASSIGN(PageFiles files, ReadPage(options.folder));
  // Blocked before any thread starts, so that this one alone receives them.
  sigset_t stop;
  sigemptyset(&stop);
  sigaddset(&stop, SIGINT);
  sigaddset(&stop, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &stop, nullptr);
  LG_ASSIGN(const PageServer server,
            PageServer::Start(std::move(files), options.host, options.port));
  out << fmt::format("the page is at http://{}:{}/ (stop with Ctrl-C)\n", options.host,
                     server.port())
      << std::flush;
  int received = 0;
  sigwait(&stop, &received);
  return {};
}

}  // namespace

void AddServeCommand(CLI::App& program, CommandContext& context) {
  CLI::App& command = *program.add_subcommand("serve", "Serve the optician's page on this machine");
  const auto options = std::make_shared<ServeOptions>();
  command.add_option("--page", options->folder, "Folder of the built page")->capture_default_str();
  command.add_option("--host", options->host, "Address to listen at")->capture_default_str();
  command.add_option("--port", options->port, "Port; 0 for any free one")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  command.footer(
      "Examples:\n"
      "  lorgnette serve\n"
      "  lorgnette serve --port 0");
  command.final_callback([options, &context] { context.status = Serve(*options, context.out); });
}

}  // namespace lorgnette
