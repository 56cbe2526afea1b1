// SPDX-License-Identifier: Apache-2.0
#include "base/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

namespace lorgnette {
namespace {

// What all the temporary names of a file begin with; the number of a process follows.
std::string TemporaryStart(const std::filesystem::path& path) {
  return "." + path.stem().string() + ".partial-";
}

std::string TemporaryName(const std::string& final_path) {
  static std::atomic<int> counter{0};
  const std::filesystem::path path(final_path);
  const std::string name = TemporaryStart(path) + std::to_string(getpid()) + "-" +
                           std::to_string(counter++) + path.extension().string();
  return (path.parent_path() / name).string();
}

// Removes what killed processes left of their work on this file.
void RemoveLeftovers(const std::string& final_path) {
  const std::filesystem::path path(final_path);
  const std::string start = TemporaryStart(path);
  std::error_code failed;
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  for (std::filesystem::directory_iterator at(folder, failed), end; !failed && at != end;
       at.increment(failed)) {
    const std::string name = at->path().filename().string();
    if (!name.starts_with(start) || at->path().extension() != path.extension()) continue;
    long process = 0;
    const char* digits = name.c_str() + start.size();
    const auto read = std::from_chars(digits, name.c_str() + name.size(), process);
    if (read.ec != std::errc() || *read.ptr != '-' || process <= 0) continue;
    if (::kill(pid_t(process), 0) != 0 && errno == ESRCH) ::unlink(at->path().c_str());
  }
}

std::string Reason() { return std::strerror(errno); }

}  // namespace

AtomicFile::AtomicFile(std::string final_path)
    : final_path_(std::move(final_path)), temporary_path_(TemporaryName(final_path_)) {
  RemoveLeftovers(final_path_);
}

AtomicFile::~AtomicFile() {
  if (!committed_) ::unlink(temporary_path_.c_str());
}

Status AtomicFile::Commit() {
  const int fd = ::open(temporary_path_.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return Failure(final_path_ + ": cannot be written: " + Reason());
  const bool synced = ::fsync(fd) == 0;
  const std::string sync_reason = synced ? "" : Reason();
  ::close(fd);
  if (!synced) return Failure(final_path_ + ": cannot be written: " + sync_reason);
  if (::rename(temporary_path_.c_str(), final_path_.c_str()) != 0) {
    return Failure(final_path_ + ": cannot be written: " + Reason());
  }
  committed_ = true;
  return {};
}

Status WriteFileAtomically(const std::string& path, std::string_view content) {
  AtomicFile file(path);
  errno = 0;
  std::ofstream out(file.temporary_path(), std::ios::binary);
  out.write(content.data(), static_cast<std::streamsize>(content.size()));
  out.close();
  if (!out) {
    return Failure(path + ": cannot be written: " + (errno != 0 ? Reason() : "write failed"));
  }
  return file.Commit();
}

Result<std::string> ReadFile(const std::string& path) {
  std::error_code ec;
  if (std::filesystem::is_directory(path, ec)) return Failure(path + ": is a folder, want a file");
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) {
    return Failure(path + ": cannot be read: " + (errno != 0 ? Reason() : "open failed"));
  }
  std::ostringstream content;
  content << in.rdbuf();
  return content.str();
}

}  // namespace lorgnette
