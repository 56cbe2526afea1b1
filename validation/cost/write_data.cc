// SPDX-License-Identifier: Apache-2.0
// The study as JSON, CSV and text.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "validation/cost/study.h"

namespace lorgnette::validation {
namespace {

using Json = nlohmann::ordered_json;

// Four digits are more than a time or an error is good for.
double Rounded(double value) {
  if (value == 0 || !std::isfinite(value)) return value;
  return std::stod(fmt::format("{:.4g}", value));
}

Json Errors(const CostStudy& study, const std::vector<double>& values) {
  Json json = Json::object();
  for (std::size_t i = 0; i < study.units.size(); ++i) {
    json[study.units[i].name] = Rounded(values[i]);
  }
  return json;
}

Json Study(const CostStudy& study) {
  Json units = Json::array(), descriptions = Json::array(), points = Json::array();
  for (const ErrorUnit& unit : study.units) {
    units.push_back(unit.name);
    descriptions.push_back(unit.description);
  }
  for (const CostPoint& point : study.points) {
    Json json = {{"method", point.method},
                 {"parameter", point.parameter},
                 {"time", Rounded(point.time)},
                 {"time_spread", Rounded(point.time_spread)},
                 {"errors", Errors(study, point.errors)},
                 {"worst", Errors(study, point.worst)},
                 {"front", point.front}};
    if (study.ms_per_frame > 0) json["ms_per_frame"] = Rounded(point.time * study.ms_per_frame);
    if (!point.preset.empty()) json["preset"] = point.preset;
    if (!point.note.empty()) json["note"] = point.note;
    points.push_back(std::move(json));
  }
  return {{"name", study.name},
          {"title", study.title},
          {"reference", study.reference},
          {"time_unit", study.time_unit},
          {"error_units", std::move(units)},
          {"error_descriptions", std::move(descriptions)},
          {"points", std::move(points)}};
}

std::string CsvField(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

}  // namespace

std::string CostJson(const CostReport& report) {
  Json studies = Json::array();
  for (const CostStudy& study : report.studies) studies.push_back(Study(study));
  const Json json = {{"machine",
                      {{"processor", report.machine},
                       {"threads", report.threads},
                       {"kernel_target", report.kernel_target}}},
                     {"calibration_ns", Rounded(report.calibration_ns)},
                     {"seconds", Rounded(report.seconds)},
                     {"scene", report.scene},
                     {"studies", std::move(studies)}};
  return json.dump(2) + "\n";
}

std::string CostCsv(const CostReport& report) {
  std::string csv =
      "study,method,parameter,time,time_spread,time_unit,ms_per_frame,error_unit,"
      "error,worst,front,preset,note\n";
  for (const CostStudy& study : report.studies) {
    for (const CostPoint& point : study.points) {
      for (std::size_t i = 0; i < study.units.size(); ++i) {
        csv += fmt::format(
            "{},{},{},{:.4g},{:.4g},{},{},{},{:.4g},{:.4g},{},{},{}\n", CsvField(study.name),
            CsvField(point.method), CsvField(point.parameter), point.time, point.time_spread,
            study.time_unit,
            study.ms_per_frame > 0 ? fmt::format("{:.4g}", point.time * study.ms_per_frame) : "",
            study.units[i].name, point.errors[i], point.worst[i], point.front ? "yes" : "no",
            point.preset, CsvField(point.note));
      }
    }
  }
  return csv;
}

std::string CostText(const CostReport& report, const CostBudget* budget) {
  std::string text = fmt::format(
      "{}\n{}, {} threads, {}; one dependent multiply-add {:.3g} ns; {:.0f} s\n", report.scene,
      report.machine, report.threads, report.kernel_target, report.calibration_ns, report.seconds);
  for (const CostStudy& study : report.studies) {
    text += fmt::format("\n{} [{}]\nerrors against: {}\n  {:<46} {:>10} {:>8}", study.title,
                        study.name, study.reference, "* on the front", study.time_unit, "+-");
    for (const ErrorUnit& unit : study.units) text += fmt::format(" {:>13}", unit.name);
    text += '\n';
    for (const CostPoint& point : study.points) {
      text += fmt::format("{} {:<46} {:>10.4g} {:>8.2g}", point.front ? '*' : ' ', point.Name(),
                          point.time, point.time_spread / 2);
      for (const double error : point.errors) text += fmt::format(" {:>13.3g}", error);
      if (!point.preset.empty()) text += "  --quality " + point.preset;
      if (!point.note.empty()) text += "  " + point.note;
      text += '\n';
    }
    if (budget == nullptr) continue;
    const CostPoint* best = Recommend(study, *budget);
    if (best != nullptr) {
      text += fmt::format("  recommended for this budget: {} ({:.3g} {}", best->Name(), best->time,
                          study.time_unit);
      if (study.ms_per_frame > 0) {
        text += fmt::format(", {:.3g} ms a frame", best->time * study.ms_per_frame);
      }
      text += ")\n";
    } else {
      text += Applies(study, *budget) ? "  nothing here keeps this budget\n"
                                      : "  this budget says nothing about this study\n";
    }
  }
  return text;
}

}  // namespace lorgnette::validation
