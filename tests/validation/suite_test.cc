// SPDX-License-Identifier: Apache-2.0
#include "validation/suite.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

namespace lorgnette::validation {
namespace {

TEST(Suite, EveryShippedCaseHolds) {
  const Result<SuiteResult> result = RunSuite("", "");
  ASSERT_TRUE(result);
  EXPECT_EQ(result->failed, 0) << TextTable(*result);
  EXPECT_GT(result->passed, 0);
}

TEST(Suite, NumbersRiseAndAreUnique) {
  std::string last;
  for (const Case* one : AllCases()) {
    EXPECT_LT(last, std::string(one->id));
    last = one->id;
    EXPECT_STRNE(one->source, "") << one->id;
  }
}

TEST(Suite, RunsOneCaseOrOneGroupAndNamesWhatItDoesNotKnow) {
  const auto one = RunSuite("V001", "");
  ASSERT_TRUE(one);
  EXPECT_EQ(one->cases.size(), 1u);
  const auto group = RunSuite("", "magnification");
  ASSERT_TRUE(group);
  for (const CaseResult& c : group->cases) EXPECT_STREQ(c.definition->group, "magnification");
  const auto none = RunSuite("V999", "");
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(none.error().message, testing::HasSubstr("V999"));
}

TEST(Check, CountsMatchingDigitsOfTheRelativeDifference) {
  EXPECT_NEAR((Check{"q", "D", -6, -6.0006, 1}).matching_digits(), 4, 1e-9);
  EXPECT_EQ((Check{"q", "D", 2.5, 2.5, 0}).matching_digits(), 16);
  EXPECT_EQ((Check{"q", "D", 2.5, std::numeric_limits<double>::quiet_NaN(), 0}).matching_digits(),
            0);
}

TEST(CaseRun, FailsOnNaNOnNothingAndOnALastPlaceOff) {
  CaseRun empty;
  EXPECT_FALSE(empty.passed());
  CaseRun nan;
  nan.Exact("q", "D", 1, std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(nan.passed());
  CaseRun rounded;
  rounded.Rounded("q", "D", 7.52, 2, 7.5249);
  EXPECT_TRUE(rounded.passed());
  rounded.Rounded("q", "D", 7.52, 2, 7.5260);
  EXPECT_FALSE(rounded.passed());
}

TEST(Reports, JsonHoldsEveryCaseAndHtmlAsksForNoNetwork) {
  const auto result = RunSuite("", "paraxial");
  ASSERT_TRUE(result);
  const auto json = nlohmann::json::parse(JsonReport(*result));
  EXPECT_EQ(json["cases"].size(), result->cases.size());
  const std::string html = HtmlReport(*result);
  for (const CaseResult& c : result->cases) {
    EXPECT_THAT(html, testing::HasSubstr(c.definition->id));
  }
  EXPECT_THAT(html, testing::Not(testing::HasSubstr("http")));
  EXPECT_THAT(html, testing::Not(testing::HasSubstr("src=")));
}

}  // namespace
}  // namespace lorgnette::validation
