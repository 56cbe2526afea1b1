// SPDX-License-Identifier: Apache-2.0
#include "optics/base_curve.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "cmake/source_dir.h"

namespace lorgnette {
namespace {

using testing::HasSubstr;

// The reference's front powers for n = 1.523, s = 27 mm, to the digits printed.
TEST(Tscherning, HasTheReferencesForms) {
  struct Row {
    double power, ostwalt, wollaston;
  };
  for (const Row& row : {Row{-10, 2.488, 15.256}, Row{-6, 4.475, 17.269}, Row{-4, 5.642, 18.102},
                         Row{0, 8.374, 19.370}, Row{4, 11.896, 19.849}, Row{7, 16.291, 18.453}}) {
    const auto forms = Tscherning(Diopters(row.power), 1.523);
    ASSERT_TRUE(forms);
    EXPECT_NEAR(forms->ostwalt.value(), row.ostwalt, 5.1e-4) << row.power;
    EXPECT_NEAR(forms->wollaston.value(), row.wollaston, 5.1e-4) << row.power;
  }
}

TEST(Tscherning, EndsWhereTheReferenceSays) {
  for (const auto& [n, least, greatest] :
       {std::tuple{1.5, -21.96, 7.14}, {1.523, -22.99, 7.21}, {1.6, -26.46, 7.41}}) {
    EXPECT_TRUE(Tscherning(Diopters(least + 0.01), n));
    EXPECT_FALSE(Tscherning(Diopters(least - 0.01), n));
    EXPECT_TRUE(Tscherning(Diopters(greatest - 0.01), n));
    EXPECT_FALSE(Tscherning(Diopters(greatest + 0.01), n));
  }
}

// Published case 13: polycarbonate, 0.45 D on the tool is 0.4976 D true; the back of -7.4976 D
// wants a tool of -6.781.
TEST(ToolPower, HasThePublishedTools) {
  EXPECT_NEAR(ToolPower(Diopters(0.4976), 1.586).value(), 0.45, 5e-5);
  EXPECT_NEAR(ToolPower(Diopters(-7.4976), 1.586).value(), -6.781, 5e-4);
}

// Retail rows of the reference: which of the bases 0.5, 2, 4, 6, 8, 10 serves best on either side
// of each limit (n = 1.498 with 2.0 mm centres; n = 1.60 with 1.5 mm).
TEST(BestForm, HasTheReferencesLimits) {
  const std::vector<double> bases = {0.5, 2, 4, 6, 8, 10};
  const std::vector<double> cr39 = {-9.25, -5.25, -2.00, 2.75, 5.25};
  const std::vector<double> mr8 = {-11.50, -7.25, -3.50, 1.25, 3.75};
  for (std::size_t i = 0; i < cr39.size(); ++i) {
    const auto best = [&](double power, double n, double center) {
      return BestFormBaseCurve(Diopters(power), n, center, bases).value();
    };
    // Limits are printed in quarters of a dioptre.
    EXPECT_EQ(best(cr39[i] - 0.25, 1.498, 2.0), bases[i]) << cr39[i];
    EXPECT_EQ(best(cr39[i] + 0.25, 1.498, 2.0), bases[i + 1]) << cr39[i];
    EXPECT_EQ(best(mr8[i] - 0.25, 1.60, 1.5), bases[i]) << mr8[i];
    EXPECT_EQ(best(mr8[i] + 0.25, 1.60, 1.5), bases[i + 1]) << mr8[i];
  }
}

// RMS at 30 degrees, n = 1.498: Vogel 0.13 against the best 0.09 at -6 D, 0.26 against 0.10 at +4.
TEST(BestForm, BeatsVogelByTheReferencesAmounts) {
  const auto error = [](double power, double base) {
    return *FormError(Diopters(power), Diopters(base), 1.498, 2.0);
  };
  EXPECT_NEAR(error(-6, VogelBaseCurve(Diopters(-6)).value()), 0.13, 6e-3);
  EXPECT_NEAR(error(4, VogelBaseCurve(Diopters(4)).value()), 0.26, 6e-3);
  std::vector<double> fine;
  for (double b = 0.5; b < 14; b += 0.05) fine.push_back(b);
  EXPECT_NEAR(error(-6, BestFormBaseCurve(Diopters(-6), 1.498, 2.0, fine).value()), 0.09, 6e-3);
  EXPECT_NEAR(error(4, BestFormBaseCurve(Diopters(4), 1.498, 2.0, fine).value()), 0.10, 6e-3);
}

TEST(BaseCurveChart, RoundTripsAndChooses) {
  const char* text = R"({"name": "mine", "media": [
      {"medium": "CR-39", "index": 1.498, "upper_se": [-5.25, 2.75], "base": [2, 6, 8]}]})";
  const auto chart = ParseBaseCurveChart(text, "chart.json");
  ASSERT_TRUE(chart) << chart.error().message;
  const auto again = ParseBaseCurveChart(WriteBaseCurveChart(*chart), "again.json");
  ASSERT_TRUE(again) << again.error().message;
  for (const auto& c : {*chart, *again}) {
    EXPECT_EQ(c.Choose("CR-39", 1.498, Diopters(-6))->value(), 2);
    EXPECT_EQ(c.Choose("CR-39", 1.498, Diopters(0))->value(), 6);
    EXPECT_EQ(c.Choose("CR-39", 1.498, Diopters(7))->value(), 8);
    // The same tool in another medium: the radius stays, the power does not.
    EXPECT_NEAR(c.Choose("1.60", 1.594, Diopters(0))->value(), 6 * 0.594 / 0.498, 1e-13);
  }
}

TEST(BaseCurveChart, NamesWhatIsWrong) {
  const auto problem = [](const char* text) {
    const auto chart = ParseBaseCurveChart(text, "chart.json");
    return chart ? std::string() : chart.error().message;
  };
  EXPECT_THAT(problem(R"({"name": "m", "media": [{"medium": "a", "index": 1.5, "upper_se": [1, 0],
                          "base": [1, 2, 3]}]})"),
              HasSubstr("chart.json:media[0].upper_se: not ascending"));
  EXPECT_THAT(problem(R"({"name": "m", "media": [{"medium": "a", "index": 1.5, "upper_se": [1],
                          "base": [1, 2, 3]}]})"),
              HasSubstr("media[0].base: got 3 curves for 1 limits"));
  EXPECT_FALSE(BaseCurveChart{}.Choose("CR-39", 1.498, Diopters(0)));
}

TEST(BaseCurveChart, ComputedCurvesSteepenWithThePower) {
  for (const auto& medium : ComputeBestFormChart().media) {
    for (std::size_t i = 1; i < medium.rows.size(); ++i) {
      EXPECT_GE(medium.rows[i].base_D, medium.rows[i - 1].base_D)
          << medium.medium << " at " << medium.rows[i].upper_se_D;
    }
  }
}

// The chart that ships is the computed one.
TEST(BaseCurveChart, ShipsAsComputed) {
  std::ifstream file(LORGNETTE_SOURCE_DIR "/data/base_curves.json");
  ASSERT_TRUE(file) << "data/base_curves.json is missing";
  std::stringstream text;
  text << file.rdbuf();
  EXPECT_EQ(text.str(), WriteBaseCurveChart(ComputeBestFormChart()));
}

}  // namespace
}  // namespace lorgnette
