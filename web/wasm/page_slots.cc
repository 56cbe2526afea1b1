// SPDX-License-Identifier: Apache-2.0
#include "page_slots.h"

#include "optics/wear.h"

namespace lorgnette::page {

const Lens* LensIn(int slot) {
  const Slot* found = SlotAt(slot);
  return found ? &found->lens() : nullptr;
}

EyePose EyeBehind(const Slot& slot, double stop_mm) {
  return WornEye(slot.lens(), slot.page.order.eye, slot.page.wear, stop_mm);
}

WornFrame::WornFrame(const Slot& slot)
    : turn_(EyeBehind(slot, 1).axes.transpose()), pivot_(0, 0, slot.lens().center_thickness_mm) {}

Eigen::Vector3d WornFrame::FromLens(const Eigen::Vector3d& point) const {
  return pivot_ + turn_ * (point - pivot_);
}
Eigen::Vector3d WornFrame::DirectionFromLens(const Eigen::Vector3d& direction) const {
  return turn_ * direction;
}
Ray WornFrame::FromLens(const Ray& ray) const {
  return {FromLens(ray.origin), turn_ * ray.direction};
}
Ray WornFrame::ToLens(const Ray& ray) const {
  return {pivot_ + turn_.transpose() * (ray.origin - pivot_), turn_.transpose() * ray.direction};
}

}  // namespace lorgnette::page
