// SPDX-License-Identifier: Apache-2.0
// A numbered validation case: where its numbers come from, what it expects and how surely, what the
// program measures, and to how many digits the two agree.
#pragma once

#include <string>
#include <vector>

namespace lorgnette::validation {

// How surely an expected value is known.
enum class Certainty {
  kExact,      // recomputed with 30 or more digits, or a closed form
  kRounded,    // published, rounded to the digits given
  kEstimated,  // published with inputs unstated, or by a source of low authority
  kBound,      // an error that must stay below a derived bound; expected is 0
};

struct Check {
  std::string quantity;
  std::string unit;
  double expected = 0;
  double measured = 0;
  double tolerance = 0;  // absolute
  Certainty certainty = Certainty::kExact;
  std::string reason = {};  // where the tolerance comes from

  bool passed() const;
  // Number of leading decimal digits that agree: -log10(|measured - expected| / |expected|), with
  // the absolute error where expected is 0; 0..16.
  double matching_digits() const;
};

// Collects the checks of one run of a case.
class CaseRun {
 public:
  // A value known to all digits of a double; at least `digits` of them have to match.
  void Exact(const std::string& quantity, const std::string& unit, double expected, double measured,
             int digits = 9);
  // A printed value, rounded (or truncated, with ulps = 1) to `decimals` places: the measured one
  // lies within half a unit (or one unit) of the last place.
  void Rounded(const std::string& quantity, const std::string& unit, double expected, int decimals,
               double measured, double units_in_last_place = 0.5);
  // A value whose own uncertainty is stated by `reason`.
  void Within(const std::string& quantity, const std::string& unit, double expected,
              double measured, double tolerance, const std::string& reason);
  // An error (a magnitude) that has to stay below a derived bound.
  void Bound(const std::string& quantity, const std::string& unit, double error, double bound,
             const std::string& reason);
  // The case cannot be run here (data that does not ship).
  void Skip(const std::string& reason) { skipped_ = reason; }

  const std::vector<Check>& checks() const { return checks_; }
  const std::string& skipped() const { return skipped_; }
  bool passed() const;          // ran, with at least one check, and every check holds
  double least_digits() const;  // over the checks that are not bounds

 private:
  std::vector<Check> checks_;
  std::string skipped_;
};

struct Case {
  const char* id;      // "V001"
  const char* group;   // "paraxial", "magnification", ...
  const char* title;   // what is computed
  const char* source;  // publication or derivation
  void (*run)(CaseRun&);
  bool slow = false;  // seconds, not milliseconds: left out unless asked for
};

// Every case, by rising number. Made at configure time from the file names in validation/cases/:
// file v001_some_words.cc defines `extern const Case kV001`.
const std::vector<const Case*>& AllCases();

}  // namespace lorgnette::validation
