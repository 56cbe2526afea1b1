// SPDX-License-Identifier: Apache-2.0
// lorgnette track: from a video to a track file.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <ostream>

#include "apps/commands.h"
#include "apps/frame_range.h"
#include "apps/rx_file.h"
#include "apps/track_pipeline.h"

namespace lorgnette {
namespace {

struct TrackCommandOptions {
  TrackRequest request;
  std::string rx, frames, output;
  std::optional<double> pd_mm;
};

Status RunTrack(TrackCommandOptions options, std::ostream& out) {
  TrackRequest& request = options.request;
  LG_ASSIGN(request.frames, ParseFrameRange(options.frames));
  if (!options.rx.empty()) {
    LG_ASSIGN(const Prescription rx, ReadRxFile(options.rx, options.pd_mm));
    request.pd_mm = rx.pd_mm();
  } else if (options.pd_mm) {
    request.pd_mm = *options.pd_mm;
  }
  if (!request.camera.empty() && request.focal_px > 0) {
    return UsageError("--focal: got both it and --camera, want one of the two");
  }
  LG_ASSIGN(const HeadTrack track, TrackVideo(request));
  LG_RETURN_IF_ERROR(WriteHeadTrack(track, options.output));
  out << fmt::format("{}: {} frames, {} without a face, focal length {:.0f} pixels\n",
                     options.output, track.frames.size(), track.frames_without_face(),
                     track.camera.fx);
  if (track.iris_pd_mm > 0) {
    out << fmt::format("PD by the irises {:.1f} +- {:.1f} mm, {:+.1f} against the {:.1f} in use\n",
                       track.iris_pd_mm, track.iris_pd_sigma_mm, track.iris_pd_mm - track.pd_mm,
                       track.pd_mm);
  }
  return {};
}

}  // namespace

void AddTrackCommand(CLI::App& program, CommandContext& context) {
  CLI::App& command = *program.add_subcommand(
      "track", "Follow the face in a video; write camera, head poses and face mesh to a file");
  const auto options = std::make_shared<TrackCommandOptions>();
  command.add_option("--video", options->request.video, "Video, image sequence or image")
      ->required();
  command.add_option("-o,--output", options->output, "Track file to write (JSON)")->required();
  command.add_option("--rx", options->rx, "Prescription, for the distance between the pupils");
  command.add_option("--pd", options->pd_mm,
                     "Distance between the pupils, mm, for the prescription's (64 without either)");
  command.add_option("--focal", options->request.focal_px,
                     "Focal length of the camera, pixels (estimated if absent)");
  command.add_option("--camera", options->request.camera,
                     "Camera file of lorgnette calibrate, in place of --focal");
  command.add_option("--frames", options->frames, "Part of the clip, A:B, first and last frame");
  command.add_option("--models", options->request.model_dir, "Folder of the face networks");
  command.footer(
      "Examples:\n"
      "  lorgnette track --video clip.mp4 --pd 64 -o track.json\n"
      "  lorgnette track --video shot_%04d.png --rx rx.json -o track.json");
  command.final_callback([options, &context] { context.status = RunTrack(*options, context.out); });
}

}  // namespace lorgnette
