// SPDX-License-Identifier: Apache-2.0
// lorgnette calibrate: from views of a chessboard to a camera file.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ostream>

#include "apps/commands.h"
#include "base/progress.h"
#include "render/video_io.h"
#include "tracking/chessboard.h"

namespace lorgnette {
namespace {

constexpr int kFewestCorners = 3, kMostCorners = 50;
constexpr long kFramesTried = 80;    // of a video, evenly spread
constexpr double kTriesASecond = 4;  // of a video that does not know its length
constexpr std::size_t kMostViews = 60;

struct CalibrateOptions {
  std::vector<std::string> views;
  std::string board = "9x6", output;
  double square_mm = 25;
};

Result<Chessboard> ParseBoard(const std::string& text, double square_mm) {
  Chessboard board{0, 0, square_mm};
  char end = 0;
  const bool numbers = std::sscanf(text.c_str(), "%dx%d%c", &board.columns, &board.rows, &end) == 2;
  const auto fits = [](int n) { return n >= kFewestCorners && n <= kMostCorners; };
  if (!numbers || !fits(board.columns) || !fits(board.rows)) {
    return UsageError(
        fmt::format("--board: got '{}', want inner corners across and down, like 9x6 "
                    "({}..{} each)",
                    text, kFewestCorners, kMostCorners));
  }
  if (!(square_mm > 0 && square_mm <= 1000)) {
    return UsageError(fmt::format("--square: got {} mm, want 0..1000", square_mm));
  }
  return board;
}

struct Views {
  int width = 0, height = 0;
  long tried = 0, with_board = 0;
  std::vector<BoardCorners> different;
};

Status AddViews(const std::string& path, const Chessboard& board, Views& views) {
  LG_ASSIGN(VideoReader reader, VideoReader::Open(path, {.keep_originals = false}));
  const VideoInfo& info = reader.info();
  if (views.width == 0) {
    views.width = info.width;
    views.height = info.height;
  } else if (info.width != views.width || info.height != views.height) {
    return Failure(fmt::format("{}: got {}x{} pixels, want {}x{} as the first view", path,
                               info.width, info.height, views.width, views.height));
  }
  const long stride = info.frame_count > 0
                          ? std::max(1L, info.frame_count / kFramesTried)
                          : std::max(1L, std::lround(info.frame_rate / kTriesASecond));
  for (long number = 0;; ++number) {
    LG_ASSIGN(const std::optional<VideoFrame> frame, reader.Next());
    if (!frame) return {};
    if (number % stride != 0) continue;
    ++views.tried;
    const auto corners = FindChessboard(frame->rgb, board);
    if (!corners) continue;
    ++views.with_board;
    const bool known = std::any_of(
        views.different.begin(), views.different.end(),
        [&](const BoardCorners& other) { return SameView(*corners, other, views.width); });
    if (!known && views.different.size() < kMostViews) views.different.push_back(*corners);
  }
}

Status RunCalibrate(const CalibrateOptions& options, std::ostream& out) {
  LG_ASSIGN(const Chessboard board, ParseBoard(options.board, options.square_mm));
  Views views;
  Progress progress("calibrating", "files", long(options.views.size()));
  for (std::size_t i = 0; i < options.views.size(); ++i) {
    LG_RETURN_IF_ERROR(AddViews(options.views[i], board, views));
    progress.Update(long(i) + 1);
  }
  const auto found = Calibrate(board, views.width, views.height, views.different);
  if (!found) {
    return Failure(fmt::format("{}: {} pictures looked at, the {} board whole in {}; {}",
                               options.views.front(), views.tried, options.board, views.with_board,
                               found.error().message));
  }
  const CalibratedCamera& c = found->camera;
  LG_RETURN_IF_ERROR(WriteCameraFile(c, options.output));
  out << fmt::format(
      "{}: {}x{} pixels, focal length {:.1f} +- {:.1f} pixels (fy {:.1f}), middle {:.1f} {:.1f}\n"
      "distortion k1 {:.4f}, k2 {:.4f}, p1 {:.5f}, p2 {:.5f}, k3 {:.4f}\n"
      "corners within {:.2f} pixel RMS, {} views, tilted by up to {:.0f} degrees; {} pictures "
      "looked at, {} left out\n",
      options.output, c.camera.width, c.camera.height, c.camera.fx, c.focal_sigma_px, c.camera.fy,
      c.camera.cx, c.camera.cy, c.distortion.k1, c.distortion.k2, c.distortion.p1, c.distortion.p2,
      c.distortion.k3, c.rms_px, c.views, found->most_tilted_deg, views.tried,
      found->views_left_out);
  for (const std::string& note : found->notes) out << "note: " << note << '\n';
  return {};
}

}  // namespace

void AddCalibrateCommand(CLI::App& program, CommandContext& context) {
  CLI::App& command = *program.add_subcommand(
      "calibrate", "Measure a camera from views of a printed chessboard; write a camera file");
  const auto options = std::make_shared<CalibrateOptions>();
  command
      .add_option("--views", options->views,
                  "Pictures of the board, image sequences or videos, all of one size")
      ->required();
  command.add_option("-o,--output", options->output, "Camera file to write (JSON)")->required();
  command.add_option("--board", options->board, "Inner corners across and down")
      ->capture_default_str();
  command.add_option("--square", options->square_mm, "Side of a square, mm")->capture_default_str();
  command.footer(
      "Examples:\n"
      "  lorgnette calibrate --views board.mp4 --board 9x6 -o camera.json\n"
      "  lorgnette calibrate --views a.jpg b.jpg c.jpg d.jpg e.jpg --square 30 -o camera.json\n"
      "  lorgnette track --video clip.mp4 --camera camera.json -o track.json");
  command.final_callback(
      [options, &context] { context.status = RunCalibrate(*options, context.out); });
}

}  // namespace lorgnette
