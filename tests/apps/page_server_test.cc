// SPDX-License-Identifier: Apache-2.0
#include "apps/page_server.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <thread>
#include <vector>

namespace lorgnette {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

namespace fs = std::filesystem;

// A page of two files with a secret beside it.
class PageServerTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(::testing::TempDir()) / ("page_server_" + std::to_string(::getpid()));
    fs::create_directories(folder_ / "page" / "assets");
    Write("page/index.html", "<title>page</title>");
    Write("page/assets/a.js", "let a = 1;");
    Write("page/notes.md", "not of the page");
    Write("secret.html", "secret");
    fs::create_symlink(folder_ / "secret.html", folder_ / "page" / "link.html");
  }
  void TearDown() override { fs::remove_all(folder_); }

  void Write(const std::string& name, const std::string& content) {
    std::ofstream(folder_ / name) << content;
  }
  PageServer Started() {
    auto files = ReadPage((folder_ / "page").string());
    EXPECT_TRUE(files);
    auto server = PageServer::Start(*std::move(files), "127.0.0.1", 0);
    EXPECT_TRUE(server);
    return *std::move(server);
  }
  fs::path folder_;
};

// What the server answers to these very bytes; empty when it closes without a word.
//   hang_up  says at once that no further request comes
std::string Ask(int port, const std::string& bytes, bool hang_up = false) {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(std::uint16_t(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  std::string answer;
  if (::connect(socket, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0) {
    for (std::size_t sent = 0; sent < bytes.size();) {
      const ssize_t n = ::send(socket, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (n <= 0) break;
      sent += std::size_t(n);
    }
    if (hang_up) ::shutdown(socket, SHUT_WR);
    char buffer[4096];
    for (ssize_t n; (n = ::recv(socket, buffer, sizeof buffer, 0)) > 0;) {
      answer.append(buffer, std::size_t(n));
    }
  }
  ::close(socket);
  return answer;
}

std::string Get(int port, const std::string& path) {
  return Ask(port, "GET " + path + " HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n");
}

TEST_F(PageServerTest, AnswersTheFilesOfItsFolderWithTheirTypes) {
  const PageServer server = Started();
  for (const char* path : {"/", "/index.html", "/?from=link", "/index.html#r=1"}) {
    const std::string answer = Get(server.port(), path);
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 200")) << path;
    EXPECT_THAT(answer, HasSubstr("<title>page</title>")) << path;
    EXPECT_THAT(answer, HasSubstr("text/html")) << path;
    EXPECT_THAT(answer, HasSubstr("nosniff")) << path;
  }
  EXPECT_THAT(Get(server.port(), "/assets/a.js"), HasSubstr("text/javascript"));
}

TEST_F(PageServerTest, OwnsNothingOutsideItsFolder) {
  const PageServer server = Started();
  for (const char* path :
       {"/../secret.html", "/%2e%2e/secret.html", "/..%2fsecret.html", "/assets/../../secret.html",
        "//etc/passwd", "/etc/passwd", "/link.html", "/notes.md", "/assets", "/assets/",
        "/index.html%00.js", "/INDEX.html"}) {
    const std::string answer = Get(server.port(), path);
    EXPECT_THAT(answer, Not(StartsWith("HTTP/1.1 200"))) << path;
    EXPECT_THAT(answer, Not(HasSubstr("secret"))) << path;
    EXPECT_THAT(answer, Not(HasSubstr("root:"))) << path;
  }
}

TEST_F(PageServerTest, RefusesOtherMethods) {
  const PageServer server = Started();
  for (const char* method : {"POST", "PUT", "DELETE", "PATCH", "OPTIONS"}) {
    const std::string answer =
        Ask(server.port(), std::string(method) +
                               " / HTTP/1.1\r\nHost: x\r\nContent-Length: 0\r\n"
                               "Connection: close\r\n\r\n");
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 405")) << method;
  }
}

TEST_F(PageServerTest, RefusesOversizedRequests) {
  const PageServer server = Started();
  const std::string head = "POST / HTTP/1.1\r\nHost: x\r\nConnection: close\r\nContent-Length: ";
  const std::string body(kMaxBody_bytes + 1, 'x');
  EXPECT_THAT(Ask(server.port(), head + std::to_string(body.size()) + "\r\n\r\n" + body),
              Not(StartsWith("HTTP/1.1 200")));
  EXPECT_THAT(Get(server.port(), "/" + std::string(9000, 'a')), Not(StartsWith("HTTP/1.1 200")));
  EXPECT_THAT(Ask(server.port(), "GET / HTTP/1.1\r\nX: " + std::string(9000, 'a') + "\r\n\r\n"),
              Not(StartsWith("HTTP/1.1 200")));
  std::string headers;
  for (int i = 0; i < 2000; ++i) headers += "X" + std::to_string(i) + ": 1\r\n";
  EXPECT_THAT(Ask(server.port(), "GET / HTTP/1.1\r\nConnection: close\r\n" + headers + "\r\n"),
              StartsWith("HTTP/1.1 431"));
}

TEST_F(PageServerTest, RefusesABodyOfAFalseOrLargeLength) {
  const PageServer server = Started();
  const auto ask = [&](const std::string& length) {
    return Ask(server.port(), "GET / HTTP/1.1\r\nHost: x\r\nConnection: close\r\nContent-Length: " +
                                  length + "\r\n\r\n");
  };
  for (const char* length : {"-5", "five", "0x5", "5 5", "99999999999999999999999"}) {
    EXPECT_THAT(ask(length), StartsWith("HTTP/1.1 400")) << length;
  }
  EXPECT_THAT(ask(std::to_string(kMaxBody_bytes + 1)), StartsWith("HTTP/1.1 413"));
  EXPECT_THAT(ask("0"), StartsWith("HTTP/1.1 200"));
}

TEST_F(PageServerTest, AnswersOneRangeAndRefusesSeveral) {
  const PageServer server = Started();
  const auto ask = [&](const std::string& range) {
    return Ask(server.port(), "GET / HTTP/1.1\r\nHost: x\r\nConnection: close\r\nRange: bytes=" +
                                  range + "\r\n\r\n");
  };
  const std::string one = ask("0-4");
  EXPECT_THAT(one, StartsWith("HTTP/1.1 206"));
  EXPECT_EQ(one.size() - one.find("\r\n\r\n"), 4 + 5u);
  EXPECT_THAT(ask("99999999-"), StartsWith("HTTP/1.1 416"));
  std::string many = "0-";
  for (int i = 0; i < 1000; ++i) many += ",0-";
  for (const std::string& several : {std::string("0-1,3-4"), many}) {
    const std::string answer = ask(several);
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 416")) << several.substr(0, 20);
    EXPECT_THAT(answer, Not(HasSubstr("<title>"))) << several.substr(0, 20);
  }
}

TEST_F(PageServerTest, SurvivesWhatIsNotHttp) {
  const PageServer server = Started();
  std::vector<std::string> strange = {"\r\n\r\n", "GET\r\n\r\n", "hello\r\n\r\n",
                                      "GET / HTTP/9.9\r\n\r\n",
                                      "GET / HTTP/1.1\r\nno colon\r\n\r\n"};
  strange.emplace_back(64, '\0');
  strange.back().append("\r\n\r\n");
  for (const std::string& bytes : strange) {
    Ask(server.port(), bytes, true);
    EXPECT_THAT(Get(server.port(), "/"), StartsWith("HTTP/1.1 200"));
  }
}

TEST_F(PageServerTest, AnswersAThousandRequestsOfFiftyClients) {
  const PageServer server = Started();
  std::atomic<int> good = 0;
  std::vector<std::thread> clients;
  for (int i = 0; i < 50; ++i) {
    clients.emplace_back([&] {
      for (int k = 0; k < 20; ++k) {
        const std::string answer = Get(server.port(), k % 2 ? "/" : "/assets/a.js");
        if (answer.rfind("HTTP/1.1 200", 0) == 0) ++good;
      }
    });
  }
  for (std::thread& client : clients) client.join();
  EXPECT_EQ(good, 1000);
}

TEST_F(PageServerTest, SaysWhenThePortIsTaken) {
  const PageServer first = Started();
  const auto second = PageServer::Start({}, "127.0.0.1", first.port());
  ASSERT_FALSE(second);
  EXPECT_THAT(second.error().message, HasSubstr("cannot listen"));
}

TEST(ReadPage, SaysWhatAFolderLacks) {
  const auto missing = ReadPage("/nonexistent");
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().message, HasSubstr("/nonexistent"));
}

}  // namespace
}  // namespace lorgnette
