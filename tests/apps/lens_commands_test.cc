// SPDX-License-Identifier: Apache-2.0
// lorgnette lens, measure and frames.
#include <fmt/format.h>

#include <cmath>

#include "base/units.h"
#include "cmake/source_dir.h"
#include "tests/apps/program_test_util.h"

namespace lorgnette {
namespace {

using testing::HasSubstr;

TEST_F(ProgramTest, VersionAndHelpSucceed) {
  EXPECT_EQ(Run({"--version"}).out, std::string("lorgnette ") + ProgramVersion() + "\n");
  EXPECT_EQ(Run({"--help"}).code, kExitOk);
  for (const char* command :
       {"tryon", "track", "calibrate", "lens", "measure", "frames", "compose"}) {
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
      {{"--sphere", "-4", "--camera", "-5"}, "--camera: got -5, want more than 0"},
      {{"--sphere", "nan"}, "--sphere: got nan, want"},
      {{"--sphere", "-4", "--cylinder", "nan", "--axis", "3"}, "--cylinder: got nan, want"},
      {{"--sphere", "-4", "--cylinder", "1", "--axis", "nan"}, "--axis: got nan, want"},
      {{"--sphere", "inf"}, "--sphere: got inf, want"},
      {{"--sphere", "-4", "--index", "nan"}, "--index: got nan, want"},
      {{"--sphere", "-4", "--base", "nan"}, "--base: got nan, want"},
      {{"--sphere", "-4", "--center-thickness", "nan"}, "--center-thickness: got nan, want"},
      {{"--sphere", "-4", "--diameter", "inf"}, "--diameter: got inf, want"},
      {{"--sphere", "-4", "--height", "nan"}, "--height: got nan, want"},
      {{"--sphere", "-4", "--camera", "inf"}, "--camera: got inf, want"},
      {{"--sphere", "-4", "--gaze", "nan,0"}, "--gaze: got nan,0, want"},
      {{"--sphere", "-4", "--gaze", "5,0", "--stop", "inf"}, "--stop: got inf, want"},
      {{"--sphere", "-4", "--focimeter", "nan,0"}, "--focimeter: got nan, want"},
      {{"--sphere", "-4", "--index", "1.6", "--index-e", "1.6"}, "--index-e: got it together"},
      {{"--sphere", "-4", "--thinning"}, "--thinning: got it without"},
      {{"--sphere", "-4", "--chart", "mine.json"}, "--chart: got a chart without"},
      {{"--front-radius", "nan", "--back-radius", "60", "--center-thickness", "2"}, "got nan"},
      {{"--lens", "x.json", "--sphere", "1"}, "--lens: got it together"}};
  for (const auto& [arguments, sentence] : cases) {
    std::vector<std::string> all = {"measure"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const Ran ran = Run(all);
    EXPECT_EQ(ran.code, kExitUsage);
    EXPECT_THAT(ran.err, HasSubstr(sentence));
    ExpectOneSentence(ran.err);
  }
}

// What cannot be made says what could be.
TEST_F(ProgramTest, ImpossibleLensesSayWhatWouldBePossible) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--sphere", "-30", "--index", "1.5"},
        {"--sphere", "20", "--index", "1.5", "--base", "22", "--center-thickness", "20"},
        {"--sphere", "6", "--center-thickness", "1", "--diameter", "70"},
        {"--sphere", "1", "--cylinder", "-2", "--axis", "20", "--toric", "front", "--aspheric",
         "25"},
        {"--front-radius", "25", "--back-radius", "300", "--center-thickness", "2"}}) {
    for (const char* command : {"measure", "lens"}) {
      if (arguments[0] == "--front-radius" && std::string(command) == "lens") continue;
      std::vector<std::string> all = {command};
      all.insert(all.end(), arguments.begin(), arguments.end());
      const Ran ran = Run(all);
      EXPECT_NE(ran.code, kExitOk) << testing::PrintToString(all);
      ExpectOneSentence(ran.err);
      EXPECT_THAT(ran.err, testing::AnyOf(HasSubstr("possible:"), HasSubstr("want one of")));
    }
  }
}

TEST_F(ProgramTest, IndexAloneTakesTheNearestMediumsDensityAndMinima) {
  const auto json = Run({"measure", "--sphere", "-6", "--index", "1.6", "--base", "2"}).Json();
  EXPECT_EQ(json["order"]["density_g_cm3"], 1.30);
  EXPECT_EQ(json["order"]["index"], 1.6);
  EXPECT_EQ(json["center_thickness_mm"], 1.2);
  const auto named = Run({"measure", "--sphere", "-6", "--medium", "cr39", "--base", "2"}).Json();
  EXPECT_EQ(named["center_thickness_mm"], 2);
  // A trade name is the index at the e line.
  const auto e = Run({"measure", "--sphere", "-6", "--index-e", "1.6", "--abbe", "41"}).Json();
  // Two-term dispersion: catalogues say 1.594 to 1.597.
  EXPECT_NEAR(e["order"]["index"], 1.5955, 2e-3);
  EXPECT_NEAR(e["order"]["index_e"], 1.6, 1e-12);
}

TEST_F(ProgramTest, LensesByTwoRadiiOfTheFrontAreThoseOfTheOrder) {
  const auto ordered = Run({"measure", "--sphere", "-2", "--cylinder", "-3", "--axis", "20",
                            "--toric", "front", "--center-thickness", "2", "--gaze", "25,70"})
                           .Json();
  const auto number = [](double value) { return fmt::format("{:.17g}", value); };
  const auto given =
      Run({"measure", "--front-radius",
           number(ordered["radii_front_mm"][0]) + "," + number(ordered["radii_front_mm"][1]),
           "--back-radius", number(ordered["radii_back_mm"][0]), "--axis", "20",
           "--center-thickness", "2", "--gaze", "25,70"})
          .Json();
  constexpr double kBound = 1e-9;  // the radii pass through text of 17 digits
  for (const char* key : {"back_vertex_power_D", "edge_thickness_mm", "sagittal_D", "tangential_D",
                          "sphere_D", "cylinder_D", "axis_deg"}) {
    EXPECT_NEAR(given[key], double(ordered[key]), kBound) << key;
  }
}

TEST_F(ProgramTest, PlanoMeridianOfACylinderHasNoRadius) {
  const auto json = Run({"measure", "--sphere", "0", "--cylinder", "-4", "--axis", "45", "--base",
                         "0", "--center-thickness", "2"})
                        .Json();
  EXPECT_TRUE(json["radius_front_mm"].is_null());
  EXPECT_TRUE(json["radii_back_mm"][0].is_null());
  EXPECT_TRUE(json["radii_back_mm"][1].is_number());
}

TEST_F(ProgramTest, LensFilesHoldAnySurface) {
  const auto file = [&](const std::string& front, const std::string& back) {
    return Write("lens.json",
                 R"({"medium": "1.60", "diameter": 50, "center_thickness": 3, "front": )" + front +
                     ", \"back\": " + back + "}");
  };
  const auto measured = [&](const std::string& path) {
    return Run({"measure", "--lens", path, "--gaze", "20,10"}).Json();
  };
  const auto radii =
      Run({"measure", "--medium", "1.60", "--diameter", "50", "--front-radius", "100",
           "--back-radius", "80,60", "--axis", "30", "--center-thickness", "3", "--gaze", "20,10"})
          .Json();
  // Across the minus axis the back is the more strongly curved: that circle generates it.
  const std::string torus = R"({"form": "torus", "radius_generator": 60, "radius_across": 80,
                                "generator_meridian": 120})";
  const std::string sphere = R"({"form": "sphere", "radius": 100})";
  const auto same = measured(file(sphere, torus));
  constexpr double kBound = 1e-12;
  for (const char* key : {"back_vertex_power_D", "mass_g", "sagittal_D", "tangential_D"}) {
    EXPECT_NEAR(same[key], double(radii[key]), kBound * 100) << key;
  }
  EXPECT_NEAR(same["order"]["axis_deg"], 30, 1e-9);
  const std::string conic = R"({"form": "conic", "radius": 100})";
  const std::string atoroid = R"({"form": "atoroid", "radius_generator": 60, "radius_across": 80,
                                  "generator_meridian": 120})";
  EXPECT_NEAR(measured(file(conic, atoroid))["tangential_D"], double(same["tangential_D"]), 1e-9);
  const auto progressive = measured(file(
      R"({"form": "progressive", "radius_far": 100, "radius_near": 75, "length": 14})", sphere));
  EXPECT_NEAR(progressive["front_power_D"], 5.94, 1e-12);
  for (const auto& [text, sentence] :
       {std::pair{R"({"form": "cube"})", "lens.json:front.form: got \"cube\", want sphere"},
        {R"({"form": "sphere", "radius": 1})", "lens.json:front.radius: got 1, want at least 5 mm"},
        {R"({"form": "sphere", "tint": 1})", "lens.json:front.tint"}}) {
    const Ran ran = Run({"measure", "--lens", file(text, sphere)});
    EXPECT_EQ(ran.code, kExitUsage) << ran.err;
    EXPECT_THAT(ran.err, HasSubstr(sentence));
    ExpectOneSentence(ran.err);
  }
}

TEST_F(ProgramTest, MeasureAnswersFocimeterMapAndLight) {
  const auto json =
      Run({"measure", "--sphere", "-6", "--index", "1.6", "--base", "2", "--center-thickness",
           "1.5", "--focimeter", "0,0", "--map", "30", "--coat", "v", "--tint", "0.3"})
          .Json();
  // The instrument's zone error of this lens at 2.5 mm, from the optics reference.
  EXPECT_NEAR(json["focimeter"]["back"]["sphere_D"], -6.008, 5e-4);
  EXPECT_NEAR(json["focimeter"]["front"]["sphere_D"], -5.944, 0.01);
  EXPECT_LT(json["map"]["mean_power_D"][0], -6.1);  // mean oblique error of golden C1: -0.189
  EXPECT_GT(json["map"]["cylinder_D"][1], 0.45);
  EXPECT_EQ(json["light"]["filter_category"], 2);
  EXPECT_LT(json["light"]["reflectance"], 0.02);
  const auto bare = Run({"measure", "--sphere", "-6", "--index", "1.6"}).Json()["light"];
  EXPECT_NEAR(bare["luminous_transmittance"], 0.89888, 5e-6);  // 2 n / (n^2 + 1)
  EXPECT_NEAR(bare["reflectance"], 0.05325, 5e-6);
}

TEST_F(ProgramTest, LensesAreCompensatedForTheirWear) {
  const Ran ran =
      Run({"lens", "--sphere", "-7", "--cylinder", "-2", "--axis", "30", "--pantoscopic", "10",
           "--face-form", "8", "--vertex", "11", "--refraction-vertex", "13", "--json"});
  ASSERT_EQ(ran.code, kExitOk) << ran.err;
  const auto wear = ran.Json()["wear"];
  for (const char* key : {"sphere_D", "cylinder_D"}) {
    EXPECT_NEAR(wear["worn"][key], double(wear["target"][key]), 1e-8) << key;
  }
  EXPECT_GT(std::abs(double(wear["worn_without_compensation"]["sphere_D"]) -
                     double(wear["target"]["sphere_D"])),
            0.1);
  EXPECT_THAT(Run({"lens", kTable1, "--vertex", "11"}).out, HasSubstr("made for the wear"));
}

TEST_F(ProgramTest, PrismIsMadeByDecentrationWhereItCanBe) {
  const auto decentred =
      Run({"lens", "--sphere", "-5", "--prism-in", "2", "--prism-by", "decentration", "--json"})
          .Json();
  EXPECT_EQ(decentred["prism"]["by"], "decentration");
  EXPECT_NEAR(decentred["prism"]["in"], 2, 1e-9);
  // Prentice: 4 mm, less what the lens' thickness and third order do.
  EXPECT_NEAR(std::abs(double(decentred["prism"]["reference_point_mm"][0])), 4, 0.1);
  const auto ground =
      Run({"lens", "--sphere", "0", "--prism-in", "2", "--prism-by", "decentration", "--json"})
          .Json();
  EXPECT_EQ(ground["prism"]["by"], "grinding");
  EXPECT_NEAR(ground["prism"]["in"], 2, 1e-9);
  EXPECT_THAT(std::string(ground["prism"]["why_ground"]), HasSubstr("no power"));
}

TEST_F(ProgramTest, MultifocalsAndPairsAreWithinReach) {
  for (const char* front : {"round", "flat-top", "executive", "progressive", "soft"}) {
    const Ran ran = Run({"lens", "--sphere", "1", "--add", "2", "--multifocal", front, "--diameter",
                         "54", "--svg", Path("m.svg"), "--json"});
    ASSERT_EQ(ran.code, kExitOk) << front << ran.err;
    bool added = false;
    const auto json = ran.Json();
    for (const auto& row : json["certificate"]) {
      added = added || std::string(row["quantity"]).find("addition") == 0;
    }
    EXPECT_TRUE(added) << front;
  }
  const std::string rx =
      Write("rx.json", R"({"OD": {"sphere": 1}, "OS": {"sphere": -3}, "PD": 62})");
  const auto pair = Run({"lens", rx, "--json"}).Json()["pair"];
  // 10 mm below the centres: 1 prism D base up before a +1, 3 base down before a -3.
  EXPECT_NEAR(pair["vertical_imbalance"], 4, 0.1);
  EXPECT_EQ(pair["slab_off"]["eye"], "left");
  const auto alike = Run({"lens", rx, "--iseikonic", "1.03", "--json"}).Json();
  EXPECT_NEAR(alike["pair"]["magnification_ratio"], 1.03, 1e-9);
  EXPECT_NE(double(alike["pair"]["iseikonic"]["ratio_before"]), 1.03);
}

TEST_F(ProgramTest, LensIsCutToAFrameAndThePrescriptionWrittenAgain) {
  const std::string rx = Write(
      "rx.json", R"({"OD": {"sphere": -6}, "OS": {"sphere": -6}, "PD": 60, "fitting_height": 22})");
  const auto round = Run({"lens", "--rx", rx, "--diameter", "60", "--json"}).Json()["lenses"][0];
  const Ran ran = Run({"lens", rx, "--frame", "panto", "--json", "--rx-out", Path("again.json"),
                       "--fhir-out", Path("fhir.json"), "--patient", "Patient/1", "--prescriber",
                       "Practitioner/2", "--date", "2026-11-25"});
  ASSERT_EQ(ran.code, kExitOk) << ran.err;
  const auto cut = ran.Json()["lenses"][0];
  EXPECT_LT(cut["mass_g"], round["mass_g"]);
  EXPECT_LT(cut["edge_thickness_mm"], round["edge_thickness_mm"]);
  for (const char* name : {"again.json", "fhir.json"}) {
    const auto back = Run({"lens", Path(name), "--frame", "panto", "--json"}).Json();
    EXPECT_EQ(back["lenses"][0]["mass_g"], cut["mass_g"]) << name;
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
  for (const char* text :
       {"OD right", "OS left", "axis 160", "optical centre", "r₁ 135.05", "r₂ 62.60", "2.00 centre",
        "section across the axis (70°)", "mean power, D", "lateral colour"}) {
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
