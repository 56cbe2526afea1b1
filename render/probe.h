// SPDX-License-Identifier: Apache-2.0
// An environment from photographs of a mirror ball, one or several exposures (Debevec 1998).
//
// The ball is found in the picture as the circle along which brightness jumps most evenly; further
// exposures are laid onto the first by what the ball shows, since a hand moves between them. Which
// direction a point of the ball shows depends on the camera's distance; the cone behind the ball,
// which no point shows, continues the colours around it. Tested on rendered balls.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/image.h"
#include "base/result.h"

namespace lorgnette {

// Outline of the ball in a picture, pixels.
struct BallCircle {
  double x = 0, y = 0, radius = 0;
  // Jump of brightness across it, less that along it, in units of the picture's mean gradient.
  double contrast = 0;
};
// Three photographs of one ball have 1.13 and more, a portrait without one has 0.7.
inline constexpr double kLeastBallContrast = 1;
// The best circle that shows at least 60 per cent of itself; nullopt when none stands out.
std::optional<BallCircle> FindBall(const ImageRgb8& picture);

struct ProbePhoto {
  std::string name;  // for messages
  ImageRgb8 picture;
  double exposure_s = 0;  // relative light gathered: time, with aperture and ISO where they differ
};
// Reads the picture, and its exposure from the EXIF data of a JPEG: time / f-number^2 * ISO / 100;
// `exposure_s` given goes before it. 0 when neither is there.
Result<ProbePhoto> ReadProbePhoto(const std::string& path, std::optional<double> exposure_s);

struct ProbeOptions {
  int width = 512;                 // of the map; its height is half of that
  double distance_radii = 0;       // camera to the ball's centre in radii of the ball; 0: far away
  std::optional<BallCircle> ball;  // in the first photograph, where it cannot be found
};
struct ProbeResult {
  ImageRgbF map;  // render/environment.h; 1.0 is white of the longest exposure
  std::vector<BallCircle> balls;
  double clipped = 0, dark = 0;  // shares of the map where every photograph is
};
// At least one photograph; with several each needs an exposure.
Result<ProbeResult> EnvironmentFromBall(const std::vector<ProbePhoto>& photos,
                                        const ProbeOptions& options);

// Angle from the direction to the camera of what a point of the ball mirrors, radians.
//   rho  distance from the outline's centre in radii of the outline, 0..1
double MirroredAngle(double rho, double distance_radii);

}  // namespace lorgnette
