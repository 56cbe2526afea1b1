// SPDX-License-Identifier: Apache-2.0
#include "apps/page_server.h"

#include <fmt/format.h>
#include <httplib.h>

#include <charconv>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>
#include <utility>

namespace lorgnette {
namespace {

namespace fs = std::filesystem;

// Many short requests at once, none of them long: idle connections give their thread back soon.
constexpr std::size_t kThreads = 32;
constexpr int kIdle_s = 1;
constexpr int kTimeout_s = 5;

const std::map<std::string, std::string>& Types() {
  static const std::map<std::string, std::string> types = {
      {".html", "text/html; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".json", "application/json"},
      {".wasm", "application/wasm"},
  };
  return types;
}

Result<std::string> ReadWhole(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream content;
  content << in.rdbuf();
  if (!in || !content) return Failure(path.string() + ": cannot be read");
  return content.str();
}

void Refuse(httplib::Response& response, int status) {
  response.status = status;
  response.set_content(fmt::format("{}\n", status), "text/plain");
}

// What a request is refused with before its method or path are looked at; 0 where nothing is wrong.
int Refusal(const httplib::Request& request) {
  std::size_t headers = 0;
  for (const auto& [name, value] : request.headers) headers += name.size() + value.size();
  if (headers > kMaxHeaders_bytes) return 431;
  const auto [first, last] = request.headers.equal_range("Content-Length");
  for (auto it = first; it != last; ++it) {
    const std::string& length = it->second;
    std::size_t body = 0;
    const auto [end, error] = std::from_chars(length.data(), length.data() + length.size(), body);
    if (error != std::errc() || end != length.data() + length.size()) return 400;
    if (body > kMaxBody_bytes) return 413;
  }
  // Thousands of ranges in one line would be answered by as many copies.
  return request.ranges.size() > 1 ? 416 : 0;
}

}  // namespace

Result<PageFiles> ReadPage(const std::string& folder) {
  PageFiles files;
  std::error_code error;
  for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error)) {
    const fs::path& path = it->path();
    if (!it->is_regular_file() || it->is_symlink()) continue;
    const auto type = Types().find(path.extension().string());
    if (type == Types().end()) continue;
    if (it->file_size() > kMaxPageFile_bytes) {
      return Failure(fmt::format("{}: got {} bytes, want at most {}", path.string(),
                                 it->file_size(), kMaxPageFile_bytes));
    }
    LG_ASSIGN(std::string content, ReadWhole(path));
    const std::string name = "/" + fs::relative(path, folder).generic_string();
    files[name] = {type->second, std::move(content)};
  }
  if (error) return Failure(fmt::format("{}: {}", folder, error.message()));
  const auto index = files.find("/index.html");
  if (index == files.end()) {
    return Failure(folder + ": no index.html in it; scripts/web builds the page");
  }
  files["/"] = index->second;
  return files;
}

struct PageServer::Running {
  PageFiles files;
  httplib::Server server;
  std::thread thread;
  int port = 0;

  void Answer(const httplib::Request& request, httplib::Response& response) const {
    const auto found = files.find(request.path);
    if (found == files.end()) return Refuse(response, 404);
    response.set_content(found->second.content, found->second.type.c_str());
  }
};

PageServer::PageServer(std::unique_ptr<Running> running) : running_(std::move(running)) {}
PageServer::PageServer(PageServer&&) noexcept = default;
PageServer::~PageServer() {
  if (!running_) return;
  running_->server.stop();
  running_->thread.join();
}

int PageServer::port() const { return running_->port; }

Result<PageServer> PageServer::Start(PageFiles files, const std::string& host, int port) {
  auto running = std::make_unique<Running>();
  running->files = std::move(files);
  httplib::Server& server = running->server;
  server.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
  // Not the library's SO_REUSEPORT, by which two servers would share a port unseen.
  server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  server.set_payload_max_length(kMaxBody_bytes);
  server.set_keep_alive_timeout(kIdle_s);
  server.set_read_timeout(kTimeout_s);
  server.set_write_timeout(kTimeout_s);
  server.set_default_headers({{"X-Content-Type-Options", "nosniff"},
                              {"Referrer-Policy", "no-referrer"},
                              {"Cross-Origin-Resource-Policy", "same-origin"},
                              {"Cache-Control", "no-cache"}});
  server.set_pre_routing_handler([](const httplib::Request& request, httplib::Response& response) {
    if (const int status = Refusal(request)) {
      response.status = status;
      return httplib::Server::HandlerResponse::Handled;
    }
    if (request.method == "GET" || request.method == "HEAD") {
      return httplib::Server::HandlerResponse::Unhandled;
    }
    Refuse(response, 405);
    response.set_header("Allow", "GET, HEAD");
    return httplib::Server::HandlerResponse::Handled;
  });
  const Running& owner = *running;
  server.Get(".*", [&owner](const httplib::Request& request, httplib::Response& response) {
    owner.Answer(request, response);
  });
  running->port = port == 0                         ? server.bind_to_any_port(host)
                  : server.bind_to_port(host, port) ? port
                                                    : -1;
  if (running->port <= 0) {
    return Failure(fmt::format("{}:{}: cannot listen there; another port with --port", host, port));
  }
  running->thread = std::thread([&server] { server.listen_after_bind(); });
  while (!server.is_running()) std::this_thread::yield();
  return PageServer(std::move(running));
}

}  // namespace lorgnette
