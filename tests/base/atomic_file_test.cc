// SPDX-License-Identifier: Apache-2.0
#include "base/atomic_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

namespace lorgnette {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

class AtomicFileTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "lorgnette-atomic-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string Path(const std::string& name) const { return (folder_ / name).string(); }
  long Files() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  }
  fs::path folder_;
};

TEST_F(AtomicFileTest, WritesAndReadsTheSameBytes) {
  const std::string bytes("a\0b\r\n\xff", 6);
  ASSERT_TRUE(WriteFileAtomically(Path("f.bin"), bytes).has_value());
  EXPECT_EQ(ReadFile(Path("f.bin")).value(), bytes);
  EXPECT_EQ(Files(), 1);
}

TEST_F(AtomicFileTest, ReplacesAnOlderFile) {
  ASSERT_TRUE(WriteFileAtomically(Path("f"), "a longer first version").has_value());
  ASSERT_TRUE(WriteFileAtomically(Path("f"), "second").has_value());
  EXPECT_EQ(ReadFile(Path("f")).value(), "second");
  EXPECT_EQ(Files(), 1);
}

TEST_F(AtomicFileTest, KeepsTheExtensionAndFolderOfTheFinalName) {
  const AtomicFile file(Path("clip.mp4"));
  EXPECT_EQ(fs::path(file.temporary_path()).extension(), ".mp4");
  EXPECT_EQ(fs::path(file.temporary_path()).parent_path(), folder_);
  EXPECT_NE(file.temporary_path(), file.final_path());
}

TEST_F(AtomicFileTest, TwoWritersOfOneNameDoNotMeet) {
  const AtomicFile one(Path("f")), two(Path("f"));
  EXPECT_NE(one.temporary_path(), two.temporary_path());
}

TEST_F(AtomicFileTest, ClearsUpAfterKilledProcesses) {
  // No process has the greatest number.
  const std::string left = Path(".a.partial-2147483647-0.json");
  const std::string living = Path(".a.partial-" + std::to_string(getpid()) + "-99.json");
  const std::string other = Path(".b.partial-2147483647-0.json");
  for (const std::string& path : {left, living, other}) std::ofstream(path) << "half";
  const AtomicFile file(Path("a.json"));
  EXPECT_FALSE(std::filesystem::exists(left));
  EXPECT_TRUE(std::filesystem::exists(living));
  EXPECT_TRUE(std::filesystem::exists(other));
}

TEST_F(AtomicFileTest, LeavesNothingWithoutCommit) {
  ASSERT_TRUE(WriteFileAtomically(Path("f"), "kept").has_value());
  {
    AtomicFile file(Path("f"));
    std::ofstream(file.temporary_path()) << "half of a";
    EXPECT_EQ(Files(), 2);
  }
  EXPECT_EQ(Files(), 1);
  EXPECT_EQ(ReadFile(Path("f")).value(), "kept");
}

TEST_F(AtomicFileTest, CommitFailsWhenNothingWasWritten) {
  AtomicFile file(Path("f"));
  const Status status = file.Commit();
  ASSERT_FALSE(status.has_value());
  EXPECT_THAT(status.error().message, StartsWith(Path("f") + ": cannot be written: "));
  EXPECT_EQ(Files(), 0);
}

TEST_F(AtomicFileTest, NamesTheFileWhenItsFolderIsMissing) {
  const std::string path = Path("nowhere/f");
  const Status status = WriteFileAtomically(path, "text");
  ASSERT_FALSE(status.has_value());
  EXPECT_EQ(status.error().message, path + ": cannot be written: No such file or directory");
  EXPECT_EQ(status.error().kind, ErrorKind::kFailure);
}

TEST_F(AtomicFileTest, RefusesAFolderInPlaceOfAFile) {
  ASSERT_TRUE(fs::create_directory(Path("d")));
  EXPECT_FALSE(WriteFileAtomically(Path("d"), "text").has_value());
  EXPECT_THAT(ReadFile(Path("d")).error().message, HasSubstr("is a folder"));
  EXPECT_EQ(Files(), 1);
}

TEST_F(AtomicFileTest, NamesAFileThatIsNotThere) {
  EXPECT_EQ(ReadFile(Path("f")).error().message,
            Path("f") + ": cannot be read: No such file or directory");
}

// A limit on the size of files stands in for a full disk: the write fails part of the way, with an
// errno of its own (EFBIG), and the older file survives.
TEST_F(AtomicFileTest, KeepsTheOlderFileWhenTheDiskIsFull) {
  ASSERT_TRUE(WriteFileAtomically(Path("f"), "older").has_value());
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  auto* const handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit = before;
  limit.rlim_cur = 4096;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
  const Status status = WriteFileAtomically(Path("f"), std::string(100'000, 'x'));
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);

  ASSERT_FALSE(status.has_value());
  EXPECT_EQ(status.error().message, Path("f") + ": cannot be written: File too large");
  EXPECT_EQ(ReadFile(Path("f")).value(), "older");
  EXPECT_EQ(Files(), 1);
}

}  // namespace
}  // namespace lorgnette
