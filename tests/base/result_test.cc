// SPDX-License-Identifier: Apache-2.0
#include "base/result.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace lorgnette {
namespace {

Result<int> Half(int number) {
  if (number % 2 != 0) return UsageError("number: got odd, want even");
  return number / 2;
}

Result<int> Quarter(int number, int* evaluations) {
  LG_ASSIGN(const int half, ((*evaluations)++, Half(number)));
  LG_ASSIGN(const int quarter, Half(half));
  return quarter;
}

Status Check(int number) {
  LG_RETURN_IF_ERROR(Half(number));
  return {};
}

TEST(Result, AssignBindsTheValueAndEvaluatesOnce) {
  int evaluations = 0;
  const Result<int> quarter = Quarter(12, &evaluations);
  ASSERT_TRUE(quarter.has_value());
  EXPECT_EQ(*quarter, 3);
  EXPECT_EQ(evaluations, 1);
}

TEST(Result, AssignReturnsTheFirstErrorUnchanged) {
  int evaluations = 0;
  const Result<int> quarter = Quarter(6, &evaluations);
  ASSERT_FALSE(quarter.has_value());
  EXPECT_EQ(quarter.error().message, "number: got odd, want even");
  EXPECT_EQ(quarter.error().kind, ErrorKind::kUsage);
}

TEST(Result, ReturnIfErrorPassesSuccessAndError) {
  EXPECT_TRUE(Check(4).has_value());
  ASSERT_FALSE(Check(5).has_value());
  EXPECT_EQ(Check(5).error().kind, ErrorKind::kUsage);
}

TEST(Result, AssignMovesValuesThatCannotBeCopied) {
  const auto make = []() -> Result<std::unique_ptr<int>> { return std::make_unique<int>(7); };
  const auto use = [&]() -> Result<int> {
    LG_ASSIGN(const std::unique_ptr<int> pointer, make());
    return *pointer;
  };
  EXPECT_EQ(use().value(), 7);
}

TEST(Result, FailureIsNotAUsageError) {
  const Status status = Failure("disk full");
  ASSERT_FALSE(status.has_value());
  EXPECT_EQ(status.error().kind, ErrorKind::kFailure);
}

}  // namespace
}  // namespace lorgnette
