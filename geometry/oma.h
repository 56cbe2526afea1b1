// SPDX-License-Identifier: Apache-2.0
// Lens-lab files: OMA, the Vision Council's Data Communication Standard. Frame traces, jobs, and
// lens results as `LABEL=value;value` lines.
//
// What is not understood is kept: a file that is read and written again has the same bytes, and a
// changed label changes its own line only.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "geometry/cut_lens.h"
#include "geometry/frame_model.h"
#include "geometry/frame_parameters.h"
#include "optics/design.h"
#include "optics/prescription.h"

namespace lorgnette {

// Right and left value of a label; one value stands for both; absent when empty or "?".
struct OmaPair {
  std::optional<double> right, left;
};

// One eye's trace (TRCFMT and its R, A lines). Opening coordinates of geometry/frame_model.h:
// angles run counter-clockwise from +x as drawn, the same for both eyes (0 is nasal on the right).
struct OmaTrace {
  Eye eye = Eye::kRight;
  std::vector<Eigen::Vector2d> contour_mm;  // counter-clockwise
  bool mirrored = false;                    // made from the other eye's
};

class OmaFile {
 public:
  // Lines end with CR LF, LF or CR. Fails for a file without a single label, and for nothing else.
  static Result<OmaFile> Parse(std::string_view bytes, const std::string& name);
  std::string Text() const;
  const std::string& name() const { return name_; }  // as given to Parse, for errors

  // First value of a label as written; nullopt when it is missing.
  std::optional<std::string> Get(const std::string& label) const;
  // Fails when a value is no number.
  Result<OmaPair> Numbers(const std::string& label) const;
  // Replaces the value of the first such line, or adds a line at the end.
  void Set(const std::string& label, const std::string& value);

  // Only ASCII radii (format 1) are understood: another format, a count that differs from the one
  // stated, or a radius outside 5..60 mm fails, and the file's bytes stay as they are. With one
  // eye's trace only, the other is its mirror image.
  Result<std::vector<OmaTrace>> Traces() const;
  // Replaces an eye's trace, or adds it: radii around the origin at equal angles, whole 0.01 mm.
  void SetTrace(Eye eye, const std::vector<double>& radii_mm);
  // Edge thickness per angle (STHKFMT and its T lines), mm at equal steps from +x; empty: none.
  Result<std::vector<double>> EdgeThickness(Eye eye) const;
  // With the radii at those angles, where given.
  void SetEdgeThickness(Eye eye, const std::vector<double>& thickness_mm,
                        const std::vector<double>& radii_mm = {});

 private:
  struct Line {
    std::string text;  // without its end
    std::string end;   // CR LF, LF, CR or nothing
  };
  // The label before '=', empty where there is none.
  static std::string LabelOf(const std::string& text);
  // Comma- or semicolon-separated integers of the lines with `label` that follow line `from`.
  // Replaces an eye's `format` line and the lines of `labels` that follow it, or adds them.
  void SetBlock(const std::string& format, Eye eye, const std::vector<std::string>& labels,
                const std::vector<std::string>& lines);
  Result<std::vector<double>> Block(std::size_t from, const std::string& label,
                                    std::size_t count) const;
  std::string name_;
  std::vector<Line> lines_;
};

// FRNT and BACK mean dioptres at the tooling index 1.530, or, in some writers' files, a radius in
// mm: what exceeds kOmaGreatestCurve is taken for a radius. Returns dioptres at 1.530.
inline constexpr double kOmaGreatestCurve = 25;
double OmaCurveDiopters(double written);

// Whether a path names such a file: .oma or .vca, in capitals or not.
bool IsOmaPath(const std::string& path);

// A frame in the style of `style`, its rims built around a job's traces: A, B and outline from the
// trace, DBL, PANTO, ZTILT and FCRV (else FRNT) from the job where it has them. FTYP 3 or ETYP 2
// (flat edge) makes it rimless, ETYP 3 (groove) a half rim. What the job does not say is noted.
Result<FrameModel> FrameAroundTrace(const OmaFile& job, FrameParameters style);

// The job's order: SPH, CYL, AX, ADD, PRVM/PRVA (amount, and base in degrees of the eye as drawn: 0
// at the viewer's right), IPD (one number: both eyes; two: each), BVD. A label that is missing
// counts as 0 (PD 64, vertex distance 13). Fails without SPH, or for a value out of range.
struct OmaOrder {
  Prescription rx;
  bool has_pd = false;
  std::optional<double> index;                  // LIND
  OmaPair center_thickness_mm, front_diopters;  // CTHICK; FRNT at 1.530 (OmaCurveDiopters)
};
Result<OmaOrder> ReadOmaOrder(const OmaFile& job);

// A job of its own for eyewear that no file asked for: frame traces (400 equal angles), frame data
// and prescription. SetLensResults adds the rest.
OmaFile MakeOmaJob(const Eyewear& eyewear, const Prescription& rx);

// Writes what the lenses turned out to be: LIND, FRNT, CTHICK, thickest and thinnest edge with
// angles (THKP/THKA, THNP/THNA), HBOX, VBOX, DBL, and the thickness per angle.
void SetLensResults(OmaFile& job, const Eyewear& eyewear);

}  // namespace lorgnette
