// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "validation/cost/lens_methods.h"
#include "validation/cost/studies.h"

namespace lorgnette::validation {
namespace {

CostPoint Point(double time, std::vector<double> errors) {
  CostPoint point;
  point.time = time;
  point.worst = errors;
  point.errors = std::move(errors);
  return point;
}

CostStudy Study(std::vector<CostPoint> points) {
  CostStudy study;
  study.name = "made";
  study.time_unit = "ns/ray";
  study.ms_per_frame = 0.1;
  study.units = {{"px", ""}, {"D", ""}};
  study.points = std::move(points);
  MarkFront(study);
  return study;
}

LensDesign SmallDesign(double sphere) {
  LensOrder order;
  order.rx.sphere = Diopters(sphere);
  order.medium.index_d = 1.6;
  order.diameter_mm = 50;
  return *DesignLens(order);
}

CostOptions QuickOptions() {
  CostOptions options;
  options.view.focal_px = 400;
  options.view.width_mm = 40;
  options.view.height_mm = 30;
  options.most_triangles = 5000;
  options.stopwatch = {1, 1, 0};
  options.studies = {"lens", "design"};
  return options;
}

TEST(Front, HoldsWhatNothingBeats) {
  const CostStudy study = Study({
      Point(1, {10, 10}),   // fastest
      Point(2, {5, 5}),     // better
      Point(3, {6, 6}),     // beaten by the one before
      Point(4, {7, 1}),     // better in one unit
      Point(5, {0, 0}),     // best
      Point(6, {0, 1e-12})  // as good as the best but for rounding, and slower
  });
  std::vector<bool> front;
  for (const CostPoint& p : study.points) front.push_back(p.front);
  EXPECT_THAT(front, testing::ElementsAre(true, true, false, true, true, false));
}

TEST(Front, KeepsOneOfTwoEquals) {
  const CostStudy study = Study({Point(1, {1, 1}), Point(1, {1, 1})});
  EXPECT_TRUE(study.points[0].front);
  EXPECT_FALSE(study.points[1].front);
}

TEST(Budget, RecommendsTheFastestWithinAnErrorAndTheBestWithinATime) {
  const CostStudy study = Study({Point(1, {1, 1}), Point(20, {0.05, 1}), Point(50, {0.01, 0.1})});
  const CostPoint* within = Recommend(study, *ParseBudget("0.1px", ""));
  ASSERT_NE(within, nullptr);
  EXPECT_EQ(within->time, 20);
  const CostPoint* fast = Recommend(study, *ParseBudget("", "3ms"));  // 30 ns a ray
  ASSERT_NE(fast, nullptr);
  EXPECT_EQ(fast->time, 20);
  EXPECT_EQ(Recommend(study, *ParseBudget("0.02px", "3ms")), nullptr);
  EXPECT_EQ(Recommend(study, *ParseBudget("1 ratio", "")), nullptr);
  EXPECT_EQ(Recommend(study, *ParseBudget("0.2D", ""))->time, 50);
  // An error that the study does not know leaves the time to decide.
  EXPECT_EQ(Recommend(study, *ParseBudget("1 ratio", "3ms"))->time, 20);
  EXPECT_FALSE(Applies(study, *ParseBudget("1 ratio", "")));
}

TEST(Budget, NamesWhatItCannotRead) {
  EXPECT_EQ(ParseBudget("0.5%", "")->error_unit, "magnification");
  EXPECT_DOUBLE_EQ(*ParseBudget("0.5%", "")->max_error, 0.005);
  EXPECT_DOUBLE_EQ(*ParseBudget("", "500us")->max_ms, 0.5);
  for (const char* error : {"px", "-1px", "0px", "1 mile", "nanpx", "1"}) {
    const auto budget = ParseBudget(error, "");
    ASSERT_FALSE(budget) << error;
    EXPECT_EQ(budget.error().kind, ErrorKind::kUsage);
    EXPECT_THAT(budget.error().message, testing::HasSubstr(error));
  }
  EXPECT_FALSE(ParseBudget("", "10"));
}

// The ladder of the methods, by their errors alone: each of these is another way to the same rays.
TEST(LensStudy, RanksTheMethodsAsTheirPhysicsDoes) {
  const LensDesign design = SmallDesign(-6);
  const auto study = LensStudy(design.lens, QuickOptions());
  ASSERT_TRUE(study) << study.error().message;
  const auto error = [&](const std::string& method, const std::string& parameter = "") {
    for (const CostPoint& p : study->points) {
      if (p.method == method && p.parameter.starts_with(parameter)) return p.errors[0];
    }
    ADD_FAILURE() << method << " " << parameter;
    return 0.0;
  };
  EXPECT_GT(error("no lens"), 2 * error("thin lens"));
  EXPECT_GT(error("thin lens"), error("thick lens, to first order"));
  EXPECT_GT(error("thick lens, to first order"), error("mesh, flat normals", "4096"));
  // Quartered cells: flat normals halve their error, interpolated ones quarter it.
  EXPECT_NEAR(error("mesh, flat normals", "1024") / error("mesh, flat normals", "4096"), 2, 0.6);
  EXPECT_NEAR(
      error("mesh, interpolated normals", "1024") / error("mesh, interpolated normals", "4096"), 4,
      1);
  EXPECT_NEAR(error("displacement map", "every 4") / error("displacement map", "every 2"), 4, 1);
  // Single precision of a point 500 mm away and of a direction, in pixels of 0.8 a mm.
  EXPECT_LT(error("analytic surfaces", "float"), 1e-4);
  EXPECT_LT(error("Embree user geometry", "float"), 1e-4);
  EXPECT_LT(error("analytic surfaces", "double, SIMD"), kRoundingError);
  EXPECT_LT(error("analytic surfaces", "double, one"), kRoundingError);
}

TEST(LensStudy, OnlyThreeColoursMeetRedAndBlue) {
  const LensDesign design = SmallDesign(5);
  const CostOptions options = QuickOptions();
  const CameraRays rays(design.lens, options.view);
  const LensReference reference = TraceReference(design.lens, rays);
  for (const LensMethod& method : AnalyticMethods(design.lens, rays)) {
    method.trace();
    CostPoint point;
    SetErrors(rays, reference, method.answer(), point);
    ASSERT_EQ(point.errors.size(), LensUnits().size());
    if (method.method == "analytic, three colours") {
      EXPECT_LT(point.errors.back(), 1e-4) << method.parameter;
    } else {
      EXPECT_GT(point.errors.back(), 0.01) << method.parameter;
    }
  }
}

TEST(LensStudy, RefusesALensThatEndsInsideItsOutline) {
  CostOptions options = QuickOptions();
  options.view.width_mm = 60;
  LensOrder order;
  order.rx.sphere = Diopters(-20);
  order.medium.index_d = 1.5;
  order.base_curve = Diopters(0.5);
  order.diameter_mm = 40;
  const auto study = LensStudy(DesignLens(order)->lens, options);
  ASSERT_FALSE(study);
  EXPECT_THAT(study.error().message, testing::HasSubstr("possible"));
}

TEST(DesignStudies, ExactFormsAreTheMostAccurate) {
  std::vector<CostStudy> studies;
  ASSERT_TRUE(DesignStudies(SmallDesign(5), QuickOptions(), studies));
  ASSERT_EQ(studies.size(), 3u);
  for (const CostStudy& study : studies) {
    for (std::size_t i = 1; i < study.points.size(); ++i) {
      EXPECT_LT(study.points[i].errors[0], study.points[i - 1].errors[0])
          << study.name << ": " << study.points[i].method;
    }
    EXPECT_LT(study.points.back().errors[0], 1e-8) << study.name;
  }
}

TEST(CostReports, HoldEveryPointAndAskForNoNetwork) {
  CostOptions options = QuickOptions();
  const auto report = RunCost(SmallDesign(-6), options);
  ASSERT_TRUE(report) << report.error().message;
  const auto json = nlohmann::json::parse(CostJson(*report));
  ASSERT_EQ(json["studies"].size(), report->studies.size());
  EXPECT_GT(json["calibration_ns"].get<double>(), 0);
  std::size_t points = 0;
  for (const auto& study : json["studies"]) {
    bool front = false;
    for (const auto& point : study["points"]) {
      EXPECT_EQ(point["errors"].size(), study["error_units"].size());
      EXPECT_GT(point["time"].get<double>(), 0);
      front = front || point["front"].get<bool>();
    }
    EXPECT_TRUE(front) << study["name"];
    points += study["points"].size() * study["error_units"].size();
  }
  const std::string csv = CostCsv(*report);
  EXPECT_EQ(std::size_t(std::count(csv.begin(), csv.end(), '\n')), points + 1);
  const std::string html = CostHtml(*report, nullptr);
  EXPECT_THAT(html, testing::Not(testing::HasSubstr("http")));
  EXPECT_THAT(html, testing::Not(testing::HasSubstr("src=")));
  EXPECT_THAT(html, testing::HasSubstr("displacement map"));
}

}  // namespace
}  // namespace lorgnette::validation
