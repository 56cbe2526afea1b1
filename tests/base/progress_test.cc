// SPDX-License-Identifier: Apache-2.0
#include "base/progress.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <string>

namespace lorgnette {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

TEST(Progress, WritesOneQuietLineEveryTenPerCent) {
  testing::internal::CaptureStderr();
  {
    Progress progress("rendering", "frames", 1000);
    for (long done = 1; done <= 1000; ++done) progress.Update(done);
  }
  const std::string text = testing::internal::GetCapturedStderr();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 11);  // 0 to 100 per cent
  EXPECT_THAT(text, StartsWith("rendering: 1/1000 frames, "));
  EXPECT_THAT(text, HasSubstr("rendering: 500/1000 frames, "));
  EXPECT_THAT(text, HasSubstr("rendering: 1000/1000 frames, "));
  EXPECT_EQ(text.find('\r'), std::string::npos);
}

TEST(Progress, WritesNothingWithoutAnUpdate) {
  testing::internal::CaptureStderr();
  { const Progress progress("rendering", "frames", 10); }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Progress, TakesTotalsOfZeroAndCountsPastTheEnd) {
  testing::internal::CaptureStderr();
  Progress("none", "frames", 0).Update(0);
  Progress("past", "frames", 10).Update(25);
  const std::string text = testing::internal::GetCapturedStderr();
  EXPECT_THAT(text, HasSubstr("none: 0/0 frames"));
  EXPECT_THAT(text, HasSubstr("past: 10/10 frames"));
}

TEST(Progress, DrawsABarOnATerminal) {
  const int terminal = posix_openpt(O_RDWR | O_NOCTTY);
  if (terminal < 0 || grantpt(terminal) != 0 || unlockpt(terminal) != 0) {
    GTEST_SKIP() << "no pseudo-terminal to be had here";
  }
  const int screen = open(ptsname(terminal), O_RDWR | O_NOCTTY);
  if (screen < 0) GTEST_SKIP() << "the pseudo-terminal does not open here";
  std::fflush(stderr);
  const int kept = dup(STDERR_FILENO);
  dup2(screen, STDERR_FILENO);
  {
    Progress progress("rendering", "frames", 4);
    progress.Update(2);
    progress.Update(4);
  }
  dup2(kept, STDERR_FILENO);
  close(kept);
  // A terminal hands its text over in pieces.
  std::string text;
  char buffer[4096];
  pollfd waiting{terminal, POLLIN, 0};
  while ((text.empty() || text.back() != '\n') && poll(&waiting, 1, 2000) == 1) {
    const ssize_t size = read(terminal, buffer, sizeof buffer);
    if (size <= 0) break;
    text.append(buffer, std::size_t(size));
  }
  close(screen);
  close(terminal);
  ASSERT_FALSE(text.empty());
  EXPECT_THAT(text, HasSubstr("\rrendering [###############               ] 2/4 frames"));
  EXPECT_THAT(text, HasSubstr("[##############################] 4/4 frames"));
  EXPECT_THAT(text, HasSubstr("took "));
  EXPECT_EQ(text.back(), '\n');
}

}  // namespace
}  // namespace lorgnette
