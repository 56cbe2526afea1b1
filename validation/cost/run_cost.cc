// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "optics/lens_kernel.h"
#include "validation/cost/stopwatch.h"
#include "validation/cost/studies.h"

namespace lorgnette::validation {
namespace {

struct NamedStudy {
  const char* name;
  Status (*run)(const LensDesign&, const CostOptions&, std::vector<CostStudy>&);
};

Status RunLens(const LensDesign& design, const CostOptions& options,
               std::vector<CostStudy>& studies) {
  LG_ASSIGN(CostStudy study, LensStudy(design.lens, options));
  studies.push_back(std::move(study));
  return {};
}

Result<WornScene> SceneFor(const LensDesign& design, const CostOptions& options) {
  if (!options.scene_case.empty()) return SceneFromCase(options.scene_case);
  LensOrder order = design.order;
  order.base_curve = design.front_power;
  return MadeScene(order, options.frame);
}

Status RunShading(const LensDesign& design, const CostOptions& options,
                  std::vector<CostStudy>& studies) {
  LG_ASSIGN(const WornScene scene, SceneFor(design, options));
  LG_ASSIGN(CostStudy study, ShadingStudy(scene, options));
  studies.push_back(std::move(study));
  return {};
}

Status RunPicture(const LensDesign& design, const CostOptions& options,
                  std::vector<CostStudy>& studies) {
  LG_ASSIGN(const WornScene scene, SceneFor(design, options));
  LG_ASSIGN(CostStudy study, PictureStudy(scene, options));
  studies.push_back(std::move(study));
  return {};
}

constexpr NamedStudy kStudies[] = {
    {"lens", RunLens}, {"design", DesignStudies}, {"shading", RunShading}, {"picture", RunPicture}};

std::string Describe(const LensDesign& design, const LensView& view) {
  const EyePrescription& rx = design.order.rx;
  std::string text = fmt::format("{:+.2f} D", rx.sphere.value());
  if (rx.cylinder.value() != 0) {
    text += fmt::format(" {:+.2f} D x {:.0f}", rx.cylinder.value(), rx.axis.value());
  }
  return text + fmt::format(
                    ", n {}, front {:+.2f} D, {:.2f} mm thick, {} x {} mm; camera {} mm before it, "
                    "{} px; face {} mm behind it",
                    design.lens.medium.index_d, design.front_power.value(),
                    design.lens.center_thickness_mm, view.width_mm, view.height_mm, view.camera_mm,
                    view.focal_px, view.face_mm);
}

}  // namespace

std::vector<std::string> StudyNames() {
  std::vector<std::string> names;
  for (const NamedStudy& study : kStudies) names.emplace_back(study.name);
  return names;
}

Result<CostReport> RunCost(const LensDesign& design, const CostOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  CostReport report;
  report.machine = MachineName();
  report.kernel_target = LensKernelTarget();
  report.threads = int(std::thread::hardware_concurrency());
  report.scene = Describe(design, options.view);
  std::vector<double> calibrations = {CalibrationNs()};
  for (const NamedStudy& study : kStudies) {
    const auto& wanted = options.studies;
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), study.name) == wanted.end()) {
      continue;
    }
    LG_RETURN_IF_ERROR(study.run(design, options, report.studies));
    calibrations.push_back(CalibrationNs());
  }
  std::nth_element(calibrations.begin(), calibrations.begin() + long(calibrations.size() / 2),
                   calibrations.end());
  report.calibration_ns = calibrations[calibrations.size() / 2];
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace lorgnette::validation
