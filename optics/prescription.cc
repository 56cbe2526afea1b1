// SPDX-License-Identifier: Apache-2.0
#include "optics/prescription.h"

#include <fmt/format.h>

#include "base/json_reader.h"

namespace lorgnette {
namespace {

// {"prism": [{"amount": 1.5, "base": "in"}, ...]} or {"prism_in": .., "prism_up": ..}.
void ReadPrism(JsonReader& json, EyePrescription& eye) {
  double in = json.NumberOr("prism_in", 0, -kMaxPrism, kMaxPrism);
  double up = json.NumberOr("prism_up", 0, -kMaxPrism, kMaxPrism);
  if (json.Has("prism")) {
    if (json.Has("prism_in") || json.Has("prism_up")) {
      json.Fail("prism", "got prism beside prism_in or prism_up, want one of the two forms");
    }
    for (JsonReader& part : json.Objects("prism")) {
      const double amount = part.Number("amount", 0, kMaxPrism);
      const std::string base = part.String("base");
      if (base == "in") {
        in += amount;
      } else if (base == "out") {
        in -= amount;
      } else if (base == "up") {
        up += amount;
      } else if (base == "down") {
        up -= amount;
      } else {
        part.Fail("base", "got \"" + base + "\", want in, out, up or down");
      }
    }
  }
  eye.prism_in = PrismDiopters(in);
  eye.prism_up = PrismDiopters(up);
}

EyePrescription ReadEye(JsonReader json) {
  EyePrescription eye;
  eye.sphere = Diopters(json.Number("sphere", -kMaxSphere, kMaxSphere));
  eye.cylinder = Diopters(json.NumberOr("cylinder", 0, -kMaxCylinder, kMaxCylinder));
  eye.add = Diopters(json.NumberOr("add", 0, 0, kMaxAdd));
  const bool has_axis = json.Has("axis");
  eye.axis = AxisDegrees(json.NumberOr("axis", 180, 0, 180));
  if (has_axis && eye.cylinder == Diopters(0)) {
    json.Fail("axis", "got an axis without a cylinder, want both or neither");
  } else if (!has_axis && eye.cylinder != Diopters(0)) {
    json.Fail("cylinder", "got a cylinder without an axis, want an axis in 0..180");
  }
  ReadPrism(json, eye);
  return eye;
}

std::string EyeText(const EyePrescription& eye) {
  std::string text = fmt::format("{{\"sphere\": {}", eye.sphere.value());
  const auto add = [&](const char* key, double value) {
    if (value != 0) text += fmt::format(", \"{}\": {}", key, value);
  };
  add("cylinder", eye.cylinder.value());
  if (eye.cylinder != Diopters(0)) add("axis", eye.axis.value());
  add("add", eye.add.value());
  add("prism_in", eye.prism_in.value());
  add("prism_up", eye.prism_up.value());
  return text + "}";
}

// One number where both eyes have the same.
std::string BothText(double right, double left) {
  return right == left ? fmt::format("{}", right)
                       : fmt::format("{{\"right\": {}, \"left\": {}}}", right, left);
}

}  // namespace

std::string WritePrescription(const Prescription& rx) {
  // A binocular PD is the sum; doubling is exact.
  const std::string pd = rx.pd_right_mm == rx.pd_left_mm ? fmt::format("{}", rx.pd_mm())
                                                         : BothText(rx.pd_right_mm, rx.pd_left_mm);
  std::string text =
      fmt::format("{{\n  \"OD\": {},\n  \"OS\": {},\n  \"PD\": {},\n  \"vertex_distance\": {}",
                  EyeText(rx.right), EyeText(rx.left), pd, rx.vertex_distance_mm);
  if (rx.fitting_height_right_mm && rx.fitting_height_left_mm) {
    text += ",\n  \"fitting_height\": " +
            BothText(*rx.fitting_height_right_mm, *rx.fitting_height_left_mm);
  }
  return text + "\n}\n";
}

Result<Prescription> ParsePrescription(const std::string& json_text, const std::string& name) {
  LG_ASSIGN(JsonReader json, JsonReader::Parse(json_text, name));
  Prescription rx;
  rx.right = ReadEye(json.Object("OD"));
  rx.left = ReadEye(json.Object("OS"));
  if (json.IsObject("PD")) {
    JsonReader pd = json.Object("PD");
    rx.pd_right_mm = pd.Number("right", kMinPd_mm / 2, kMaxPd_mm / 2);
    rx.pd_left_mm = pd.Number("left", kMinPd_mm / 2, kMaxPd_mm / 2);
  } else {
    rx.pd_right_mm = rx.pd_left_mm = 0.5 * json.Number("PD", kMinPd_mm, kMaxPd_mm);
  }
  rx.vertex_distance_mm =
      json.NumberOr("vertex_distance", rx.vertex_distance_mm, kMinVertex_mm, kMaxVertex_mm);
  if (json.IsObject("fitting_height")) {
    JsonReader height = json.Object("fitting_height");
    rx.fitting_height_right_mm = height.Number("right", kMinFittingHeight_mm, kMaxFittingHeight_mm);
    rx.fitting_height_left_mm = height.Number("left", kMinFittingHeight_mm, kMaxFittingHeight_mm);
  } else if (json.Has("fitting_height")) {
    rx.fitting_height_right_mm = rx.fitting_height_left_mm =
        json.Number("fitting_height", kMinFittingHeight_mm, kMaxFittingHeight_mm);
  }
  LG_RETURN_IF_ERROR(json.Finish());
  return rx;
}

}  // namespace lorgnette
