// SPDX-License-Identifier: Apache-2.0
#include "optics/fhir.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "base/json_reader.h"

namespace lorgnette {
namespace {

constexpr char kProductSystem[] =
    "http://terminology.hl7.org/CodeSystem/ex-visionprescriptionproduct";

void IgnoreTheRest(JsonReader& json) {
  for (const std::string& key : json.Keys()) json.Ignore(key);
}

void CheckProduct(JsonReader& lens) {
  if (!lens.Has("product")) {
    lens.Fail("product", "missing, want a coding of \"lens\"");
    return;
  }
  JsonReader product = lens.Object("product");
  if (product.Has("coding")) {
    for (JsonReader& coding : product.Objects("coding")) {
      const std::string code = coding.StringOr("code", "lens");
      if (code != "lens") {
        coding.Fail("code", "got \"" + code + "\", want \"lens\": spectacles only");
      }
      IgnoreTheRest(coding);
    }
  }
  IgnoreTheRest(product);
}

EyePrescription ReadLens(JsonReader& lens) {
  EyePrescription eye;
  eye.sphere = Diopters(lens.NumberOr("sphere", 0, -kMaxSphere, kMaxSphere));
  eye.cylinder = Diopters(lens.NumberOr("cylinder", 0, -kMaxCylinder, kMaxCylinder));
  eye.axis = AxisDegrees(lens.IntegerOr("axis", 180, 0, 180));
  eye.add = Diopters(lens.NumberOr("add", 0, 0, kMaxAdd));
  if (eye.cylinder == Diopters(0) && lens.NumberOr("axis", 0, 0, 180) != 0) {
    lens.Fail("axis", "got an axis without a cylinder, want both or neither");
  }
  if (eye.cylinder != Diopters(0) && !lens.Has("axis")) {
    lens.Fail("cylinder", "got a cylinder without an axis, want an axis in 0..180");
  }
  double in = 0, up = 0;
  if (lens.Has("prism")) {
    for (JsonReader& part : lens.Objects("prism")) {
      const double amount = part.Number("amount", 0, kMaxPrism);
      const std::string base = part.String("base");
      if (base != "in" && base != "out" && base != "up" && base != "down") {
        part.Fail("base", "got \"" + base + "\", want up, down, in or out");
      }
      in += base == "in" ? amount : base == "out" ? -amount : 0;
      up += base == "up" ? amount : base == "down" ? -amount : 0;
      IgnoreTheRest(part);
    }
  }
  eye.prism_in = PrismDiopters(in);
  eye.prism_up = PrismDiopters(up);
  return eye;
}

void ReadExtensions(JsonReader& json, FhirPrescription& out) {
  if (!json.Has("extension")) return;
  int pds = 0;
  for (JsonReader& extension : json.Objects("extension")) {
    const std::string url = extension.String("url");
    if (url == kFhirPdRightUrl) {
      out.rx.pd_right_mm = extension.Number("valueDecimal", kMinPd_mm / 2, kMaxPd_mm / 2);
      ++pds;
    } else if (url == kFhirPdLeftUrl) {
      out.rx.pd_left_mm = extension.Number("valueDecimal", kMinPd_mm / 2, kMaxPd_mm / 2);
      ++pds;
    } else if (url == kFhirVertexUrl) {
      out.rx.vertex_distance_mm = extension.Number("valueDecimal", kMinVertex_mm, kMaxVertex_mm);
      out.has_vertex = true;
    } else if (url == kFhirHeightRightUrl || url == kFhirHeightLeftUrl) {
      (url == kFhirHeightRightUrl ? out.rx.fitting_height_right_mm
                                  : out.rx.fitting_height_left_mm) =
          extension.Number("valueDecimal", kMinFittingHeight_mm, kMaxFittingHeight_mm);
    }
    IgnoreTheRest(extension);
  }
  out.has_pd = pds == 2;
  if (out.rx.fitting_height_right_mm.has_value() != out.rx.fitting_height_left_mm.has_value()) {
    json.Fail("extension", "got a fitting height for one eye, want both or none");
  }
}

std::string Quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) < 0x20) {
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      out += c;
    }
  }
  return out + "\"";
}

std::string LensText(const EyePrescription& eye, const char* side) {
  std::string text = fmt::format(
      "    {{\"product\": {{\"coding\": [{{\"system\": \"{}\", \"code\": \"lens\"}}]}},\n"
      "     \"eye\": \"{}\", \"sphere\": {:.2f}",
      kProductSystem, side, eye.sphere.value());
  if (eye.cylinder != Diopters(0)) {
    const long axis = std::lround(eye.axis.value());
    text += fmt::format(", \"cylinder\": {:.2f}, \"axis\": {}", eye.cylinder.value(),
                        axis == 0 ? 180 : axis);
  }
  std::vector<std::string> prism;
  const auto add = [&](double amount, const char* positive, const char* negative) {
    if (amount == 0) return;
    prism.push_back(fmt::format("{{\"amount\": {:.2f}, \"base\": \"{}\"}}", std::abs(amount),
                                amount > 0 ? positive : negative));
  };
  add(eye.prism_in.value(), "in", "out");
  add(eye.prism_up.value(), "up", "down");
  if (!prism.empty()) text += fmt::format(", \"prism\": [{}]", fmt::join(prism, ", "));
  if (eye.add != Diopters(0)) text += fmt::format(", \"add\": {:.2f}", eye.add.value());
  return text + "}";
}

}  // namespace

bool LooksLikeFhir(const std::string& json_text) {
  auto json = JsonReader::Parse(json_text, "");
  return json && json->Has("resourceType");
}

Result<FhirPrescription> ParseFhir(const std::string& json_text, const std::string& name) {
  LG_ASSIGN(JsonReader json, JsonReader::Parse(json_text, name));
  FhirPrescription out;
  const std::string type = json.String("resourceType");
  if (type != "VisionPrescription") {
    json.Fail("resourceType", "got \"" + type + "\", want VisionPrescription");
  }
  const std::string status = json.StringOr("status", "active");
  if (status == "cancelled" || status == "entered-in-error") {
    json.Fail("status", "got \"" + status + "\", want a prescription that is in force");
  }
  if (json.Has("dispense")) {
    json.Fail("dispense", "an element of FHIR R3, want lensSpecification (R4 or R5)");
  }
  bool right = false, left = false;
  for (JsonReader& lens : json.Objects("lensSpecification")) {
    CheckProduct(lens);
    const std::string eye = lens.String("eye");
    if (eye != "right" && eye != "left") {
      lens.Fail("eye", "got \"" + eye + "\", want right or left");
    } else if (eye == "right" ? right : left) {
      lens.Fail("eye", "got a second lens for the " + eye + " eye, want one");
    }
    (eye == "right" ? out.rx.right : out.rx.left) = ReadLens(lens);
    (eye == "right" ? right : left) = true;
    IgnoreTheRest(lens);
  }
  if (!right || !left) {
    json.Fail("lensSpecification",
              fmt::format("no lens for the {} eye, want both", right ? "left" : "right"));
  }
  ReadExtensions(json, out);
  IgnoreTheRest(json);
  LG_RETURN_IF_ERROR(json.Finish());
  return out;
}

std::string WriteFhir(const Prescription& rx, const FhirHeader& header) {
  const auto extension = [](const char* url, double value) {
    return fmt::format("    {{\"url\": \"{}\", \"valueDecimal\": {}}}", url, value);
  };
  std::string extensions = fmt::format("{},\n{},\n{}", extension(kFhirPdRightUrl, rx.pd_right_mm),
                                       extension(kFhirPdLeftUrl, rx.pd_left_mm),
                                       extension(kFhirVertexUrl, rx.vertex_distance_mm));
  if (rx.fitting_height_right_mm && rx.fitting_height_left_mm) {
    extensions += ",\n" + extension(kFhirHeightRightUrl, *rx.fitting_height_right_mm) + ",\n" +
                  extension(kFhirHeightLeftUrl, *rx.fitting_height_left_mm);
  }
  return fmt::format(
      "{{\n  \"resourceType\": \"VisionPrescription\",\n  \"extension\": [\n{}\n  ],\n"
      "  \"status\": {},\n  \"created\": {},\n  \"patient\": {{\"reference\": {}}},\n"
      "  \"dateWritten\": {},\n  \"prescriber\": {{\"reference\": {}}},\n"
      "  \"lensSpecification\": [\n{},\n{}\n  ]\n}}\n",
      extensions, Quoted(header.status), Quoted(header.created), Quoted(header.patient),
      Quoted(header.date_written), Quoted(header.prescriber), LensText(rx.right, "right"),
      LensText(rx.left, "left"));
}

}  // namespace lorgnette
