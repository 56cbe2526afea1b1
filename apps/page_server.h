// SPDX-License-Identifier: Apache-2.0
// The optician's page over HTTP: the files of one folder, read once at the start, and nothing else.
//
// A request is answered from that table alone, so that no path of a request ever reaches the file
// system. GET and HEAD only; a request with a body of more than kMaxBody_bytes, or one of a length
// that is no number, a request line or headers beyond kMaxHeaders_bytes, and anything that is not
// HTTP are refused. Private to apps/.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>

#include "base/result.h"

namespace lorgnette {

inline constexpr std::size_t kMaxBody_bytes = 1024;
inline constexpr std::size_t kMaxHeaders_bytes = 8192;  // all of them; one alone, too
inline constexpr std::size_t kMaxPageFile_bytes = std::size_t{16} << 20;

struct PageFile {
  std::string type;  // "text/html; charset=utf-8"
  std::string content;
};
// By the path of the request: "/", "/index.html", "/assets/x.js".
using PageFiles = std::map<std::string, PageFile>;

// Regular files under `folder`, of the kinds that a page is made of; links are not followed. Fails
// where the folder or its index.html is missing, or a file is too large.
Result<PageFiles> ReadPage(const std::string& folder);

class PageServer {
 public:
  // Listens when it returns. port 0: any free one. Fails with a sentence when it cannot bind.
  static Result<PageServer> Start(PageFiles files, const std::string& host, int port);
  PageServer(PageServer&&) noexcept;
  PageServer& operator=(PageServer&&) = delete;
  ~PageServer();  // stops, and waits for requests under way

  int port() const;

 private:
  struct Running;
  explicit PageServer(std::unique_ptr<Running> running);
  std::unique_ptr<Running> running_;
};

}  // namespace lorgnette
