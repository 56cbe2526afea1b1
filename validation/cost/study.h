// SPDX-License-Identifier: Apache-2.0
// What accuracy costs in time: ways of computing the same thing, each with its error against the
// best reference and its time, and which of them are worth having.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"

namespace lorgnette::validation {

// One way of computing. Every error is a magnitude: less is better, 0 is the reference.
struct CostPoint {
  std::string method;          // "facet mesh, flat normals"
  std::string parameter;       // "65536 triangles"; may be empty
  double time = 0;             // median over the repetitions, in the study's unit
  double time_spread = 0;      // between the quartiles of the repetitions
  std::vector<double> errors;  // one a unit of the study: root mean square
  std::vector<double> worst;   // the greatest, in the same order
  std::string note = {};       // "lost 12 of 12,931 rays"
  std::string preset = {};     // the name of the quality preset that this point is
  bool front = false;          // MarkFront

  std::string Name() const { return parameter.empty() ? method : method + ", " + parameter; }
};

// One measure of error.
struct ErrorUnit {
  std::string name;         // key: "px", "magnification", "D", "arcmin"
  std::string description;  // "on the face, in pixels of the picture"
};

struct CostStudy {
  std::string name;       // "lens"
  std::string title;      // "One lens: rays from the camera to the face"
  std::string reference;  // what every error is measured against
  std::string time_unit;  // "ns/ray"
  // Milliseconds a frame of the scene for one unit of time; 0 where a frame has no such work.
  double ms_per_frame = 0;
  std::vector<ErrorUnit> units;  // the first one is plotted
  std::vector<CostPoint> points;
};

struct CostReport {
  std::string machine, kernel_target;
  int threads = 1;
  double calibration_ns = 0;  // of CalibrationNs(), median over the run
  double seconds = 0;         // the whole run
  std::string scene;          // in words
  std::vector<CostStudy> studies;
};

// Errors below this are rounding of doubles, and count as equal.
inline constexpr double kRoundingError = 1e-9;

// Sets `front` of the points that no other point beats: nothing is faster (or as fast) and at least
// as accurate in every unit.
void MarkFront(CostStudy& study);

// What a budget asks: an error in one of the units, milliseconds a frame, or both.
struct CostBudget {
  std::optional<double> max_error;
  std::string error_unit = "px";
  std::optional<double> max_ms;
};
// "0.1px", "0.1 px", "0.5%" (magnification), "0.01D", "1arcmin", "0.02ratio", "1.5levels".
Result<CostBudget> ParseBudget(const std::string& max_error, const std::string& max_time);

// Whether the budget says anything about the study: an error in one of its units, or a time where a
// frame has such work.
bool Applies(const CostStudy& study, const CostBudget& budget);
// The fastest point within the error budget (and the time budget); where the error is none of the
// study's units or there is none, the most accurate point within the time. nullptr when no point
// keeps the budget or it does not apply.
const CostPoint* Recommend(const CostStudy& study, const CostBudget& budget);

// --- writing
// --------------------------------------------------------------------------------------

std::string CostText(const CostReport& report, const CostBudget* budget);
std::string CostJson(const CostReport& report);  // docs/cost.md has the keys
std::string CostCsv(const CostReport& report);
// Time across, error up, both logarithmic; the front is a line. One file, light and dark.
//   unit  index into study.units
std::string CostPlotSvg(const CostStudy& study, std::size_t unit, bool standalone);
// One page that opens without a network.
std::string CostHtml(const CostReport& report, const CostBudget* budget);

}  // namespace lorgnette::validation
