// SPDX-License-Identifier: Apache-2.0
// lorgnette frames: what ships, and what is in a frame file.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>

#include "apps/commands.h"
#include "geometry/frame_io.h"

namespace lorgnette {
namespace {

struct FramesOptions {
  std::string frame;
  bool json = false;
  std::optional<double> unit_mm;
};

const char* MountName(FrameMount mount) {
  return mount == FrameMount::kFullRim   ? "full rim"
         : mount == FrameMount::kHalfRim ? "half rim"
                                         : "rimless";
}

const char* KindName(FramePartKind kind) {
  switch (kind) {
    case FramePartKind::kFront:
      return "front";
    case FramePartKind::kTemple:
      return "temple";
    case FramePartKind::kNosePad:
      return "nose pad";
    case FramePartKind::kHinge:
      return "hinge";
    case FramePartKind::kDemoLens:
      return "demo lens";
    case FramePartKind::kOther:
      return "other";
  }
  return "other";
}

Status ListFrames(bool json, std::ostream& out) {
  LG_ASSIGN(const std::vector<ShippedFrame> frames, ListShippedFrames());
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const ShippedFrame& shipped : frames) {
    LG_ASSIGN(const FrameModel frame, LoadFrame(shipped.name));
    const Boxing& box = frame.boxing;
    if (json) {
      list.push_back({{"name", shipped.name},
                      {"description", shipped.description},
                      {"a_mm", box.a_mm},
                      {"b_mm", box.b_mm},
                      {"dbl_mm", box.dbl_mm}});
    } else {
      out << fmt::format("{:<12} {:.0f} [] {:.0f}  B {:.0f}   {}\n", shipped.name, box.a_mm,
                         box.dbl_mm, box.b_mm, shipped.description);
    }
  }
  if (json) out << nlohmann::ordered_json{{"frames", list}}.dump(2) << '\n';
  return {};
}

Status ShowFrame(const std::string& name, std::optional<double> unit_mm, bool json,
                 std::ostream& out) {
  LG_ASSIGN(const FrameModel frame, LoadFrame(name, unit_mm));
  const Boxing& box = frame.boxing;
  if (json) {
    nlohmann::ordered_json parts = nlohmann::ordered_json::array();
    for (const FramePart& part : frame.parts) {
      parts.push_back({{"name", part.name},
                       {"kind", KindName(part.kind)},
                       {"vertices", part.mesh.positions.size()},
                       {"triangles", part.mesh.triangles.size()}});
    }
    const nlohmann::ordered_json document = {{"name", frame.name},
                                             {"a_mm", box.a_mm},
                                             {"b_mm", box.b_mm},
                                             {"dbl_mm", box.dbl_mm},
                                             {"frame_pd_mm", box.frame_pd_mm()},
                                             {"effective_diameter_mm", box.effective_diameter_mm},
                                             {"circumference_mm", box.circumference_mm},
                                             {"mount", MountName(frame.mount)},
                                             {"frame_curve_D", frame.frame_curve_diopters},
                                             {"face_form_deg", frame.face_form_deg},
                                             {"pantoscopic_tilt_deg", frame.pantoscopic_tilt_deg},
                                             {"temple_length_mm", frame.temple_length_mm},
                                             {"temple_spread_mm", frame.temple_spread_mm},
                                             {"contour_points", frame.left.contour_mm.size()},
                                             {"notes", frame.notes},
                                             {"parts", parts}};
    out << document.dump(2) << '\n';
    return {};
  }
  const auto line = [&](const char* label, double value, const char* unit) {
    out << fmt::format("  {:<34}{:>9.2f} {}\n", label, value, unit);
  };
  out << frame.name << ", " << MountName(frame.mount) << '\n';
  line("lens width A", box.a_mm, "mm");
  line("lens height B", box.b_mm, "mm");
  line("distance between lenses DBL", box.dbl_mm, "mm");
  line("frame PD (A + DBL)", box.frame_pd_mm(), "mm");
  line("effective diameter ED", box.effective_diameter_mm, "mm");
  line("circumference", box.circumference_mm, "mm");
  line("frame curve (at 1.530)", frame.frame_curve_diopters, "D");
  line("face form", frame.face_form_deg, "deg");
  line("pantoscopic tilt", frame.pantoscopic_tilt_deg, "deg");
  line("temple length", frame.temple_length_mm, "mm");
  line("between the temples at the ears", frame.temple_spread_mm, "mm");
  std::size_t longest = 0;
  for (const FramePart& part : frame.parts) longest = std::max(longest, part.name.size());
  for (const FramePart& part : frame.parts) {
    out << fmt::format("  {:<{}}  {:<10}{:>9} triangles\n", part.name, longest, KindName(part.kind),
                       part.mesh.triangles.size());
  }
  for (const std::string& note : frame.notes) out << "  note: " << note << '\n';
  return {};
}

}  // namespace

void AddFramesCommand(CLI::App& program, CommandContext& context) {
  CLI::App& command =
      *program.add_subcommand("frames", "List the frames that ship, or look into one");
  const auto options = std::make_shared<FramesOptions>();
  command.add_option("frame", options->frame, "Name of a shipped frame, or a frame file");
  command.add_option("--unit", options->unit_mm,
                     "Millimetres in one unit of the file, where it does not say");
  command.add_flag("--json", options->json, "Print JSON in place of text");
  command.footer(
      "Examples:\n"
      "  lorgnette frames\n"
      "  lorgnette frames panto\n"
      "  lorgnette frames my_frame.json --json\n"
      "  lorgnette frames glasses.obj --unit 10\n"
      "  lorgnette frames job.oma");
  command.final_callback([options, &context] {
    context.status = options->frame.empty()
                         ? ListFrames(options->json, context.out)
                         : ShowFrame(options->frame, options->unit_mm, options->json, context.out);
  });
}

}  // namespace lorgnette
