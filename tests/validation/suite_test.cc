// SPDX-License-Identifier: Apache-2.0
#include "validation/suite.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "optics/certify.h"
#include "validation/backing.h"

namespace lorgnette::validation {
namespace {

TEST(Suite, EveryShippedCaseHolds) {
  const Result<SuiteResult> result = RunSuite("", "");
  ASSERT_TRUE(result);
  EXPECT_EQ(result->failed, 0) << TextTable(*result);
  EXPECT_GT(result->passed, 0);
}

TEST(Suite, LeavesSlowCasesOutUnlessAsked) {
  const auto quick = RunSuite("", "image");
  ASSERT_TRUE(quick);
  EXPECT_GT(quick->left_out, 0);
  for (const CaseResult& c : quick->cases) EXPECT_FALSE(c.definition->slow);
  EXPECT_THAT(TextTable(*quick), testing::HasSubstr("--all"));
}

// Orders that bring every line of a certificate about.
TEST(CasesBacking, EveryQuantityOfACertificateIsBackedByCases) {
  std::set<std::string> ids;
  for (const Case* one : AllCases()) ids.insert(one->id);
  LensOrder toric;
  toric.rx.sphere = Diopters(-3);
  toric.rx.cylinder = Diopters(-1.5);
  toric.rx.axis = AxisDegrees(30);
  toric.rx.prism_in = PrismDiopters(1);
  LensOrder progressive;
  progressive.rx.sphere = Diopters(1);
  progressive.rx.add = Diopters(2);
  progressive.progressive = ProgressiveOrder{};
  int lines = 0;
  for (const LensOrder& order : {toric, progressive}) {
    const auto design = DesignLens(order);
    ASSERT_TRUE(design) << design.error().message;
    const auto lens = Certify(*design);
    ASSERT_TRUE(lens) << lens.error().message;
    for (const Measurement& m : lens->certificate().measurements) {
      const auto cases = CasesBacking(m.quantity);
      EXPECT_FALSE(cases.empty()) << m.quantity;
      for (const std::string& id : cases) EXPECT_TRUE(ids.contains(id)) << id;
      ++lines;
    }
  }
  EXPECT_GT(lines, 12);
  EXPECT_TRUE(CasesBacking("weather").empty());
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
