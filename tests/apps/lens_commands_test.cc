// SPDX-License-Identifier: Apache-2.0
// lorgnette lens, measure and frames.
#include <cmath>

#include "base/units.h"
#include "cmake/source_dir.h"
#include "tests/apps/program_test_util.h"

namespace lorgnette {
namespace {

using testing::HasSubstr;

constexpr char kTable1[] = LORGNETTE_SOURCE_DIR "/data/prescriptions/table1.json";

TEST_F(ProgramTest, VersionAndHelpSucceed) {
  EXPECT_EQ(Run({"--version"}).out, std::string("lorgnette ") + ProgramVersion() + "\n");
  EXPECT_EQ(Run({"--help"}).code, kExitOk);
  for (const char* command : {"tryon", "track", "lens", "measure", "frames", "compose"}) {
    const Ran ran = Run({command, "--help"});
    EXPECT_EQ(ran.code, kExitOk) << command;
    EXPECT_THAT(ran.out, HasSubstr("Examples:")) << command;
    EXPECT_EQ(ran.err, "");
  }
}

TEST_F(ProgramTest, WrongUseIsExitCodeTwoAndOneSentence) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{},
        {"fly"},
        {"lens", "--wings", "2"},
        {"tryon"},
        {"measure", "--sphere", "many"},
        {"measure", "--sphere", "-6", "--generator", "up"}}) {
    const Ran ran = Run(arguments);
    EXPECT_EQ(ran.code, kExitUsage) << testing::PrintToString(arguments);
    ExpectOneSentence(ran.err);
    EXPECT_EQ(ran.out, "");
  }
}

// Closed form of a thick meniscus: F2 = F'v - F1 / (1 - tau F1).
TEST_F(ProgramTest, MeasureHasTheContractNamesAndTheClosedForm) {
  const auto json = Run({"measure", "--sphere", "-6", "--index", "1.5", "--base", "4",
                         "--center-thickness", "3", "--diameter", "50"})
                        .Json();
  constexpr double n = 1.5, t = 0.003, f1 = 4, power = -6;
  const double f2 = power - f1 / (1 - t / n * f1);
  constexpr double kBound = 1e-11;  // a few hundred roundings of numbers near 100
  EXPECT_NEAR(json["back_vertex_power_D"], power, kBound);
  EXPECT_NEAR(json["back_power_D"], f2, kBound);
  EXPECT_NEAR(json["front_vertex_power_D"], f1 + f2 / (1 - t / n * f2), kBound);
  EXPECT_NEAR(json["equivalent_power_D"], f1 + f2 - t / n * f1 * f2, kBound);
  EXPECT_NEAR(json["radius_front_mm"], 1000 * (n - 1) / f1, kBound);
  EXPECT_NEAR(json["radii_back_mm"][0], 1000 * (1 - n) / f2, kBound);
  EXPECT_EQ(json["radii_back_mm"][0], json["radii_back_mm"][1]);
  EXPECT_EQ(json["center_thickness_mm"], 3);
  const double r1 = json["radius_front_mm"], r2 = json["radii_back_mm"][0], h = 25;
  const double sag1 = r1 - std::sqrt(r1 * r1 - h * h), sag2 = r2 - std::sqrt(r2 * r2 - h * h);
  EXPECT_NEAR(json["edge_thickness_mm"], 3 - sag1 + sag2, kBound);
  // Integral of a cap's sag over the disc: cylinder less cap.
  const auto under = [&](double r, double sag) {
    return kPi * h * h * sag - kPi * sag * sag * (r - sag / 3);
  };
  const double volume = kPi * h * h * 3 - under(r1, sag1) + under(r2, sag2);
  EXPECT_NEAR(json["mass_g"], 1.32e-3 * volume, 1e-6);
}

TEST_F(ProgramTest, MeasureTakesTheLensByItsSurfacesToTheSameNumbers) {
  const auto ordered = Run({"measure", "--sphere", "-4.25", "--cylinder", "-0.75", "--axis", "160",
                            "--center-thickness", "2"})
                           .Json();
  const auto number = [](double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", value);
    return std::string(text);
  };
  const auto given =
      Run({"measure", "--front-radius", number(ordered["radius_front_mm"]), "--back-radius",
           number(ordered["radii_back_mm"][0]) + "," + number(ordered["radii_back_mm"][1]),
           "--axis", "160", "--center-thickness", "2"})
          .Json();
  constexpr double kBound = 1e-9;  // the radii pass through text of 17 digits
  EXPECT_NEAR(given["order"]["sphere_D"], -4.25, kBound);
  EXPECT_NEAR(given["order"]["cylinder_D"], -0.75, kBound);
  for (const char* key : {"back_vertex_power_D", "front_vertex_power_D", "equivalent_power_D",
                          "edge_thickness_mm", "edge_thickness_min_mm", "mass_g"}) {
    EXPECT_NEAR(given[key], ordered[key], kBound) << key;
  }
}

// Thin lens of optics/magnification.h: 1 / (1 - z L F / (L + z)), up to the lens' thickness.
TEST_F(ProgramTest, MeasureSeesTheLensThroughACamera) {
  const auto json = Run({"measure", "--sphere", "-6", "--base", "0.5", "--center-thickness", "0.1",
                         "--camera", "500", "--depth", "15", "--height", "0.01"})
                        .Json();
  const double thin = 1 / (1 + 6 * 0.015 * 500 / 515);
  EXPECT_NEAR(json["observer_magnification_thin"], thin, 1e-12);
  EXPECT_NEAR(json["observer_magnification_paraxial"], thin, 2e-4);  // 0.1 mm thick
  const double paraxial = json["observer_magnification_paraxial"];
  // The exact ray 0.01 mm off the axis differs in the third order: (0.01 / 55)^2.
  EXPECT_NEAR(json["observer_magnification_exact"], paraxial, 1e-6);
}

TEST_F(ProgramTest, MeasureRefusesWhatCannotBeMeant) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"--sphere", "90"}, "--sphere: got 90, want -40..40"},
      {{"--sphere", "-4", "--axis", "30"}, "--axis: got an axis without --cylinder"},
      {{"--sphere", "-4", "--cylinder", "-1"}, "--cylinder: got a cylinder without --axis"},
      {{"--sphere", "-4", "--index", "1"}, "--index: got 1, want 1.3..2.2"},
      {{"--front-radius", "90", "--center-thickness", "2"}, "--back-radius: want one radius"},
      {{"--front-radius", "90", "--back-radius", "60"}, "--center-thickness: missing"},
      {{"--front-radius", "1", "--back-radius", "60", "--center-thickness", "2"}, "got 1, want"},
      {{"--sphere", "-4", "--camera", "-5"}, "--camera: got -5, want more than 0"}};
  for (const auto& [arguments, sentence] : cases) {
    std::vector<std::string> all = {"measure"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const Ran ran = Run(all);
    EXPECT_EQ(ran.code, kExitUsage);
    EXPECT_THAT(ran.err, HasSubstr(sentence));
    ExpectOneSentence(ran.err);
  }
}

TEST_F(ProgramTest, LensPrintsAPairWithItsCertificates) {
  const Ran ran = Run({"lens", kTable1, "--json"});
  ASSERT_EQ(ran.code, kExitOk) << ran.err;
  const auto lenses = ran.Json()["lenses"];
  ASSERT_EQ(lenses.size(), 2u);
  EXPECT_EQ(lenses[0]["eye"], "right");
  EXPECT_EQ(lenses[1]["eye"], "left");
  for (const auto& lens : lenses) {
    ASSERT_GT(lens["certificate"].size(), 5u);
    for (const auto& row : lens["certificate"]) {
      EXPECT_TRUE(row["passed"]) << row;
      EXPECT_DOUBLE_EQ(row["difference"], double(row["measured"]) - double(row["predicted"]));
    }
  }
  const Ran text = Run({"lens", kTable1});
  EXPECT_THAT(text.out, HasSubstr("-4.25 -0.75 x 160"));
  EXPECT_THAT(text.out, HasSubstr("OS (left)"));
}

TEST_F(ProgramTest, LensDrawingShowsBothLensesWithTheirNumbers) {
  const Ran ran = Run({"lens", kTable1, "--svg", Path("lenses.svg")});
  ASSERT_EQ(ran.code, kExitOk) << ran.err;
  const auto svg = ReadFile(Path("lenses.svg"));
  ASSERT_TRUE(svg);
  EXPECT_THAT(*svg, testing::StartsWith("<svg xmlns=\"http://www.w3.org/2000/svg\""));
  EXPECT_THAT(*svg, testing::EndsWith("</svg>\n"));
  for (const char* text : {"OD right", "OS left", "axis 160", "optical centre", "r₁ 135.05",
                           "r₂ 62.63", "1.50 centre", "section across the axis (70°)"}) {
    EXPECT_THAT(*svg, HasSubstr(text));
  }
  EXPECT_THAT(*svg, testing::Not(HasSubstr("nan")));
}

TEST_F(ProgramTest, WrongPrescriptionsNameFileAndKey) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {R"({"OD": {"sphere": -90}, "OS": {"sphere": 0}, "PD": 64})", "rx.json:OD.sphere: got -90"},
      {R"({"OD": {"sphere": -1, "axis": 20}, "OS": {"sphere": 0}, "PD": 64})", "rx.json:OD.axis"},
      {R"({"OD": {"sphere": -1}, "OS": {"sphere": 0}, "PD": 64, "tint": 1})", "rx.json:tint"},
      {R"({"OD": {"sphere": -1}, "OS": {"sphere": 0}, "PD": 20})", "rx.json:PD"},
      {R"({"OD": {"sphere": )", "rx.json"}};
  for (const auto& [text, sentence] : cases) {
    const Ran ran = Run({"lens", Write("rx.json", text), "--svg", Path("out.svg")});
    EXPECT_NE(ran.code, kExitOk);
    EXPECT_THAT(ran.err, HasSubstr(sentence));
    ExpectOneSentence(ran.err);
  }
  EXPECT_EQ(FilesHere(), std::vector<std::string>{"rx.json"});
}

TEST_F(ProgramTest, FramesListsSixAndLooksIntoOne) {
  const auto list = Run({"frames", "--json"}).Json()["frames"];
  EXPECT_EQ(list.size(), 6u);
  for (const auto& entry : list) {
    const auto frame = Run({"frames", entry["name"], "--json"}).Json();
    EXPECT_EQ(frame["a_mm"], entry["a_mm"]);
    EXPECT_DOUBLE_EQ(frame["frame_pd_mm"], double(frame["a_mm"]) + double(frame["dbl_mm"]));
    // The contour fits a circle of the effective diameter and is longer than an A x B diamond.
    EXPECT_LT(frame["circumference_mm"], kPi * double(frame["effective_diameter_mm"]));
    EXPECT_GT(frame["circumference_mm"],
              2 * std::hypot(double(frame["a_mm"]), double(frame["b_mm"])));
    EXPECT_GT(frame["parts"].size(), 4u);
  }
  const Ran wrong = Run({"frames", "monocle"});
  EXPECT_EQ(wrong.code, kExitUsage);
  ExpectOneSentence(wrong.err);
}

}  // namespace
}  // namespace lorgnette
