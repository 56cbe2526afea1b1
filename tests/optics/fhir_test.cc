// SPDX-License-Identifier: Apache-2.0
#include "optics/fhir.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lorgnette {
namespace {

using testing::HasSubstr;

constexpr char kSample[] = R"({
  "resourceType": "VisionPrescription", "id": "33123", "status": "active",
  "text": {"status": "generated", "div": "<div/>"}, "created": "2014-06-15",
  "patient": {"reference": "Patient/example"}, "dateWritten": "2014-06-15",
  "prescriber": {"reference": "Practitioner/example"},
  "lensSpecification": [
    {"product": {"coding": [{"system": "s", "code": "lens"}]}, "eye": "right", "sphere": -2.00,
     "cylinder": -0.50, "axis": 180, "prism": [{"amount": 0.5, "base": "down"}], "add": 2.00},
    {"product": {"coding": [{"system": "s", "code": "lens"}]}, "eye": "left", "sphere": -1.00,
     "prism": [{"amount": 0.5, "base": "up"}, {"amount": 1, "base": "out"}], "add": 2.00}]})";

FhirHeader Header() {
  return {"active", "2026-11-22", "2026-11-22", "Patient/1", "Practitioner/2"};
}

TEST(ParseFhir, ReadsTheStandardsExample) {
  const auto fhir = ParseFhir(kSample, "rx.json");
  ASSERT_TRUE(fhir) << fhir.error().message;
  EXPECT_TRUE(LooksLikeFhir(kSample));
  EXPECT_FALSE(fhir->has_pd);
  EXPECT_EQ(fhir->rx.right.sphere, Diopters(-2));
  EXPECT_EQ(fhir->rx.right.cylinder, Diopters(-0.5));
  EXPECT_EQ(fhir->rx.right.prism_up, PrismDiopters(-0.5));
  EXPECT_EQ(fhir->rx.left.prism_in, PrismDiopters(-1));
  EXPECT_EQ(fhir->rx.left.add, Diopters(2));
}

TEST(Fhir, RoundTrips) {
  Prescription rx = ParseFhir(kSample, "rx.json")->rx;
  rx.pd_right_mm = 31.5;
  rx.pd_left_mm = 32;
  rx.vertex_distance_mm = 12;
  rx.fitting_height_right_mm = 21.5;
  rx.fitting_height_left_mm = 22;
  const std::string text = WriteFhir(rx, Header());
  EXPECT_THAT(text, HasSubstr("\"sphere\": -2.00, \"cylinder\": -0.50, \"axis\": 180"));
  const auto back = ParseFhir(text, "again.json");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_TRUE(back->has_pd && back->has_vertex);
  EXPECT_EQ(back->rx.pd_right_mm, 31.5);
  EXPECT_EQ(back->rx.vertex_distance_mm, 12);
  EXPECT_EQ(back->rx.fitting_height_right_mm, 21.5);
  EXPECT_EQ(back->rx.fitting_height_left_mm, 22);
  EXPECT_EQ(back->rx.right.prism_up, rx.right.prism_up);
  EXPECT_EQ(back->rx.left.prism_in, rx.left.prism_in);
  EXPECT_EQ(back->rx.right.axis, rx.right.axis);
}

std::string Problem(std::string text, const std::string& from, const std::string& to) {
  text.replace(text.find(from), from.size(), to);
  const auto fhir = ParseFhir(text, "rx.json");
  return fhir ? "" : fhir.error().message;
}

TEST(ParseFhir, NamesWhatIsWrong) {
  EXPECT_THAT(Problem(kSample, "VisionPrescription", "Patient"), HasSubstr("want VisionPres"));
  EXPECT_THAT(Problem(kSample, "\"lens\"", "\"contact\""), HasSubstr("spectacles only"));
  EXPECT_THAT(Problem(kSample, "\"down\"", "\"left\""), HasSubstr("want up, down, in or out"));
  EXPECT_THAT(Problem(kSample, "\"left\"", "\"right\""), HasSubstr("second lens"));
  EXPECT_THAT(Problem(kSample, "lensSpecification", "dispense"), HasSubstr("FHIR R3"));
  EXPECT_THAT(Problem(kSample, "\"cylinder\": -0.50, ", ""), HasSubstr("axis without a cylinder"));
  EXPECT_THAT(Problem(kSample, "\"active\"", "\"cancelled\""), HasSubstr("in force"));
  EXPECT_THAT(Problem(kSample, "\"axis\": 180", "\"axis\": 17.5"), HasSubstr("whole number"));
}

}  // namespace
}  // namespace lorgnette
