// SPDX-License-Identifier: Apache-2.0
// The lenses that the page has designed, and how each is worn.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>

#include "optics/certify.h"
#include "optics/gaze.h"
#include "page_json.h"

namespace lorgnette::page {

// Stands in an array for a number that there is not.
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct Slot {
  std::string order_json;  // as asked
  PageOrder page;
  CertifiedLens certified;
  PowerVector target;  // what the eye is to meet, at the back vertex as worn
  std::string sheet_json;

  const Lens& lens() const { return certified.lens(); }
};

// nullptr for a slot that holds nothing yet, and for no slot of ours.
const Slot* SlotAt(int slot);
const Lens* LensIn(int slot);

// The straight frame of a worn lens: axes of the lens frame while nothing leans, back vertex in its
// own place; face and camera stand still in it while the lens turns about its back vertex.
class WornFrame {
 public:
  explicit WornFrame(const Slot& slot);
  Eigen::Vector3d FromLens(const Eigen::Vector3d& point) const;
  Eigen::Vector3d DirectionFromLens(const Eigen::Vector3d& direction) const;
  Ray FromLens(const Ray& ray) const;
  Ray ToLens(const Ray& ray) const;

 private:
  Eigen::Matrix3d turn_;
  Eigen::Vector3d pivot_;
};

// The eye that turns behind the worn lens.
EyePose EyeBehind(const Slot& slot, double stop_mm);

}  // namespace lorgnette::page
