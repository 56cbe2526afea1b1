// SPDX-License-Identifier: Apache-2.0
#include "apps/oma_export.h"

#include "base/atomic_file.h"
#include "geometry/oma.h"

namespace lorgnette {

Status WriteOmaJob(const TryonResult& result) {
  const TryonRequest& request = result.request;
  OmaFile job = MakeOmaJob(*result.eyewear, result.prescription);
  for (const std::string& path : {request.frame, request.rx}) {
    if (!IsOmaPath(path)) continue;
    LG_ASSIGN(const std::string bytes, ReadFile(path));
    LG_ASSIGN(job, OmaFile::Parse(bytes, path));
    break;
  }
  SetLensResults(job, *result.eyewear);
  return WriteFileAtomically(request.oma, job.Text());
}

}  // namespace lorgnette
