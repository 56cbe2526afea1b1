// SPDX-License-Identifier: Apache-2.0
// lorgnette probe: photographs of a mirror ball to an environment.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <charconv>
#include <ostream>

#include "apps/commands.h"
#include "render/image_io.h"
#include "render/probe.h"

namespace lorgnette {
namespace {

struct ProbeCommandOptions {
  std::vector<std::string> photos, times;
  std::vector<double> ball;
  std::string output;
  double distance_mm = 0, ball_mm = 0;
  int width = 512;
};

// Seconds as a number or as a fraction: 0.025, 1/40.
Result<double> ParseTime(const std::string& text) {
  const auto number = [](std::string_view s, double& value) {
    const auto parsed = std::from_chars(s.data(), s.data() + s.size(), value);
    return parsed.ec == std::errc() && parsed.ptr == s.data() + s.size();
  };
  const std::size_t slash = text.find('/');
  double above = 0, below = 1;
  const bool read =
      number(std::string_view(text).substr(0, slash), above) &&
      (slash == std::string::npos || number(std::string_view(text).substr(slash + 1), below));
  if (!read || !(above > 0) || !(below > 0)) {
    return UsageError(fmt::format("--times: got `{}`, want seconds above 0: 0.025 or 1/40", text));
  }
  return above / below;
}

Status RunProbe(const ProbeCommandOptions& options, std::ostream& out) {
  if (!options.output.ends_with(".exr")) {
    return UsageError(
        fmt::format("--output: got {}, want a name that ends in .exr", options.output));
  }
  if (!options.times.empty() && options.times.size() != options.photos.size()) {
    return UsageError(fmt::format("--times: got {} times for {} photographs", options.times.size(),
                                  options.photos.size()));
  }
  ProbeOptions probe;
  constexpr int kNarrowest = 16, kWidest = 8192;
  if (options.width < kNarrowest || options.width > kWidest || options.width % 2 != 0) {
    return UsageError(fmt::format("--width: got {}, want an even number, {}..{}", options.width,
                                  kNarrowest, kWidest));
  }
  probe.width = options.width;
  if ((options.distance_mm > 0) != (options.ball_mm > 0)) {
    return UsageError("--distance and --ball-diameter belong together");
  }
  if (options.distance_mm > 0) probe.distance_radii = 2 * options.distance_mm / options.ball_mm;
  if (!options.ball.empty()) {
    if (options.ball.size() != 3 || !(options.ball[2] > 0)) {
      return UsageError("--ball: want X,Y,RADIUS in pixels of the first photograph");
    }
    probe.ball = BallCircle{options.ball[0], options.ball[1], options.ball[2], 0};
  }
  std::vector<ProbePhoto> photos;
  for (std::size_t i = 0; i < options.photos.size(); ++i) {
    std::optional<double> time;
    if (!options.times.empty()) {
      LG_ASSIGN(time, ParseTime(options.times[i]));
    }
    LG_ASSIGN(ProbePhoto photo, ReadProbePhoto(options.photos[i], time));
    photos.push_back(std::move(photo));
  }
  LG_ASSIGN(const ProbeResult result, EnvironmentFromBall(photos, probe));
  LG_RETURN_IF_ERROR(WriteExr(result.map, options.output, ExrDepth::kFloat));
  for (std::size_t i = 0; i < photos.size(); ++i) {
    const BallCircle& b = result.balls[i];
    out << fmt::format(
        "{}: ball at ({:.1f}, {:.1f}), radius {:.1f} px{}\n", photos[i].name, b.x, b.y, b.radius,
        photos[i].exposure_s > 0 ? fmt::format(", exposure {:.4g} s", photos[i].exposure_s)
                                 : std::string());
  }
  out << fmt::format(
      "{}: {}x{}, clipped in every photograph {:.2f} %, dark in every one {:.2f} %\n",
      options.output, result.map.width, result.map.height, 100 * result.clipped, 100 * result.dark);
  return {};
}

}  // namespace

void AddProbeCommand(CLI::App& program, CommandContext& context) {
  CLI::App& command = *program.add_subcommand(
      "probe", "Turn photographs of a mirror ball into an environment (EXR)");
  const auto options = std::make_shared<ProbeCommandOptions>();
  command.add_option("photos", options->photos, "Photographs, one or several exposures")
      ->required();
  command.add_option("-o,--output", options->output, "Environment to write (EXR)")->required();
  command
      .add_option("--times", options->times,
                  "Exposure times, one a photograph: 1/10,1/40 (else as EXIF says)")
      ->delimiter(',');
  command.add_option("--distance", options->distance_mm,
                     "Camera to the ball's centre, mm (else far away)");
  command.add_option("--ball-diameter", options->ball_mm, "Diameter of the ball, mm");
  command
      .add_option("--ball", options->ball,
                  "X,Y,RADIUS of its outline in the first photograph, pixels (else it is found)")
      ->delimiter(',');
  command.add_option("--width", options->width, "Of the environment")->capture_default_str();
  command.footer(
      "Examples:\n"
      "  lorgnette probe 10.jpg 40.jpg 160.jpg -o room.exr\n"
      "  lorgnette probe ball.png -o room.exr --distance 1200 --ball-diameter 80");
  command.final_callback([options, &context] { context.status = RunProbe(*options, context.out); });
}

}  // namespace lorgnette
