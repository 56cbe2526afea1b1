// SPDX-License-Identifier: Apache-2.0
#include "optics/prescription.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lorgnette {
namespace {

using testing::HasSubstr;

std::string Problem(const std::string& text) {
  const auto rx = ParsePrescription(text, "rx.json");
  return rx ? "" : rx.error().message;
}

TEST(ParsePrescription, ReadsThePapersTable) {
  const auto rx = ParsePrescription(
      R"({"OD": {"sphere": -4.25, "cylinder": -0.75, "axis": 160}, "OS": {"sphere": -4.5},
          "PD": 64})",
      "rx.json");
  ASSERT_TRUE(rx);
  EXPECT_EQ(rx->right.sphere, Diopters(-4.25));
  EXPECT_EQ(rx->right.cylinder, Diopters(-0.75));
  EXPECT_EQ(rx->right.axis, AxisDegrees(160));
  EXPECT_EQ(rx->left.sphere, Diopters(-4.5));
  EXPECT_EQ(rx->left.cylinder, Diopters(0));
  EXPECT_EQ(rx->pd_right_mm, 32);
  EXPECT_EQ(rx->pd_left_mm, 32);
  EXPECT_EQ(rx->vertex_distance_mm, 13);
}

TEST(ParsePrescription, ReadsPrismInBothForms) {
  const auto a = ParsePrescription(
      R"({"OD": {"sphere": 1, "prism": [{"amount": 2, "base": "out"}, {"amount": 1, "base": "up"}]},
          "OS": {"sphere": 1, "prism_in": -2, "prism_up": 1}, "PD": {"right": 31, "left": 32.5},
          "vertex_distance": 12})",
      "rx.json");
  ASSERT_TRUE(a);
  EXPECT_EQ(a->right.prism_in, PrismDiopters(-2));
  EXPECT_EQ(a->right.prism_up, a->left.prism_up);
  EXPECT_EQ(a->right.prism_in, a->left.prism_in);
  EXPECT_EQ(a->pd_mm(), 63.5);
  EXPECT_EQ(a->vertex_distance_mm, 12);
}

TEST(ParsePrescription, NamesFileAndKeyOfWhatIsWrong) {
  EXPECT_THAT(Problem(R"({"OD": {"sphere": -4, "axis": 90}, "OS": {"sphere": 0}, "PD": 64})"),
              HasSubstr("rx.json:OD.axis: got an axis without a cylinder"));
  EXPECT_THAT(Problem(R"({"OD": {"sphere": -4}, "OS": {"sphere": 0, "cylinder": -1}, "PD": 64})"),
              HasSubstr("rx.json:OS.cylinder: got a cylinder without an axis"));
  EXPECT_THAT(Problem(R"({"OD": {"sphere": -400}, "OS": {"sphere": 0}, "PD": 64})"),
              HasSubstr("rx.json:OD.sphere: got -400"));
  EXPECT_THAT(Problem(R"({"OD": {"sphere": -4, "shpere": 1}, "OS": {"sphere": 0}, "PD": 64})"),
              HasSubstr("OD.shpere: unknown key"));
  EXPECT_THAT(Problem(R"({"OD": {"sphere": -4}, "PD": 64})"), HasSubstr("rx.json:OS"));
  EXPECT_THAT(Problem(R"({"OD": {"sphere": 1}, "OS": {"sphere": 1}, "PD": 12})"),
              HasSubstr("rx.json:PD: got 12, want 40..85"));
  EXPECT_THAT(Problem(R"({"OD": {"sphere": 1, "prism": [{"amount": 1, "base": "left"}]},
                          "OS": {"sphere": 1}, "PD": 62})"),
              HasSubstr("want in, out, up or down"));
  EXPECT_THAT(Problem("not json"), HasSubstr("rx.json"));
}

TEST(ParsePrescription, TakesAxisZeroAsOneEighty) {
  const auto rx = ParsePrescription(
      R"({"OD": {"sphere": 1, "cylinder": -1, "axis": 0},
          "OS": {"sphere": 1, "cylinder": -1, "axis": 180}, "PD": 62})",
      "rx.json");
  ASSERT_TRUE(rx);
  EXPECT_EQ(rx->right.axis, rx->left.axis);
}

TEST(WritePrescription, ComesBackToTheLastBit) {
  Prescription rx;
  rx.right = {Diopters(-4.3125), Diopters(0.1),       AxisDegrees(160.3),
              Diopters(2),       PrismDiopters(-1.1), PrismDiopters(0.7)};
  rx.left.sphere = Diopters(1.0 / 3);
  rx.pd_right_mm = 31.7;
  rx.pd_left_mm = 32.1;
  rx.vertex_distance_mm = 12.4;
  rx.fitting_height_right_mm = 21.5;
  rx.fitting_height_left_mm = 22;
  for (const bool equal : {false, true}) {
    if (equal) {
      rx.pd_left_mm = rx.pd_right_mm;
      rx.fitting_height_left_mm = rx.fitting_height_right_mm;
    }
    const auto back = ParsePrescription(WritePrescription(rx), "again.json");
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->right.sphere, rx.right.sphere);
    EXPECT_EQ(back->right.cylinder, rx.right.cylinder);
    EXPECT_EQ(back->right.axis, rx.right.axis);
    EXPECT_EQ(back->right.add, rx.right.add);
    EXPECT_EQ(back->right.prism_in, rx.right.prism_in);
    EXPECT_EQ(back->right.prism_up, rx.right.prism_up);
    EXPECT_EQ(back->left.sphere, rx.left.sphere);
    EXPECT_EQ(back->left.cylinder, Diopters(0));
    EXPECT_EQ(back->pd_right_mm, rx.pd_right_mm);
    EXPECT_EQ(back->pd_left_mm, rx.pd_left_mm);
    EXPECT_EQ(back->vertex_distance_mm, rx.vertex_distance_mm);
    EXPECT_EQ(back->fitting_height_right_mm, rx.fitting_height_right_mm);
    EXPECT_EQ(back->fitting_height_left_mm, rx.fitting_height_left_mm);
  }
}

TEST(ParsePrescription, ReadsOneFittingHeightForBothEyes) {
  const char* text =
      R"({"OD": {"sphere": 1}, "OS": {"sphere": 1}, "PD": 62, "fitting_height": 21})";
  const auto rx = ParsePrescription(text, "rx.json");
  ASSERT_TRUE(rx);
  EXPECT_EQ(rx->fitting_height_right_mm, 21);
  EXPECT_EQ(rx->fitting_height_left_mm, 21);
  EXPECT_THAT(Problem(R"({"OD": {"sphere": 1}, "OS": {"sphere": 1}, "PD": 62,
                          "fitting_height": 3})"),
              HasSubstr("rx.json:fitting_height: got 3, want 5..60"));
}

}  // namespace
}  // namespace lorgnette
