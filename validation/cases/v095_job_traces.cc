// SPDX-License-Identifier: Apache-2.0
#include <utility>
#include <vector>

#include "geometry/closed_curve.h"
#include "validation/case.h"
#include "validation/lab_jobs.h"

namespace lorgnette::validation {
namespace {

void RunV095(CaseRun& run) {
  if (!HasJobs()) return run.Skip("no lab jobs on this machine ($LORGNETTE_JOBS)");
  for (const char* name : {"R1000_1.oma", "R360_1.oma", "R360_3.oma", "STHKFMT.oma"}) {
    const auto job = ReadJob(name);
    const auto traces =
        job ? job->Traces() : Result<std::vector<OmaTrace>>(tl::unexpected<Error>(job.error()));
    if (!traces) return run.Bound(traces.error().message, "1", 1, 0, "the job can be read");
    for (const OmaTrace& trace : *traces) {
      const Boxing boxing = MeasureContour(trace.contour_mm);
      const bool right = trace.eye == Eye::kRight;
      for (const auto& [label, value] :
           {std::pair("HBOX", boxing.a_mm), std::pair("VBOX", boxing.b_mm),
            std::pair("CIRC", boxing.circumference_mm)}) {
        const auto stated = job->Numbers(label);
        const auto& one = right ? stated->right : stated->left;
        if (!stated || !one) continue;
        run.Within(std::string(name) + (right ? " R " : " L ") + label, "mm", *one, value, 0.1,
                   "radii are written in hundredths; the lab's own rounding of the box");
      }
    }
  }
}

}  // namespace

extern const Case kV095;
const Case kV095 = {"V095", "lab", "traces of real jobs against the box and girth that they state",
                    "eeng/lens_protocol, lab job files (OMA DCS 3.10)", RunV095};

}  // namespace lorgnette::validation
