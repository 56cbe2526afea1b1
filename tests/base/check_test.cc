// SPDX-License-Identifier: Apache-2.0
#include "base/check.h"

#include <gtest/gtest.h>

namespace {

int calls = 0;
int Counted(int value) {
  ++calls;
  return value;
}

TEST(Check, PassesInSilenceAndEvaluatesOperandsOnce) {
  calls = 0;
  LG_CHECK_LT(Counted(1), 2);
  LG_CHECK(Counted(1) == 1);
  EXPECT_EQ(calls, 2);
}

TEST(CheckDeathTest, PrintsTheConditionAndAborts) {
  EXPECT_DEATH(LG_CHECK(1 + 1 == 3), "check_test.cc:[0-9]+: check failed: 1 \\+ 1 == 3");
}

TEST(CheckDeathTest, PrintsBothOperandsInEveryComparison) {
  const int rows = 3;
  EXPECT_DEATH(LG_CHECK_EQ(rows, 4), "check failed: rows == 4 \\(3 against 4\\)");
  EXPECT_DEATH(LG_CHECK_NE(rows, 3), "rows != 3 \\(3 against 3\\)");
  EXPECT_DEATH(LG_CHECK_LT(rows, 3), "rows < 3 \\(3 against 3\\)");
  EXPECT_DEATH(LG_CHECK_LE(rows, 2.5), "rows <= 2.5 \\(3 against 2.5\\)");
  EXPECT_DEATH(LG_CHECK_GT(rows, 3), "rows > 3 \\(3 against 3\\)");
  EXPECT_DEATH(LG_CHECK_GE(rows, 4), "rows >= 4 \\(3 against 4\\)");
}

}  // namespace
