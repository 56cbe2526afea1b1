// SPDX-License-Identifier: Apache-2.0
// A tile's rays on their way, kept from tile to tile so that no memory is asked for. Internal to
// render/.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "render/ray_bundle.h"
#include "render/ray_follower.h"
#include "render/tile_raster.h"

namespace lorgnette {

// What a ray through the first surface does next.
enum class LensWay : std::uint8_t {
  kThrough,  // through the second, with a share mirrored
  kToWall,   // to the ground edge wall
  kTotal,    // mirrored by the second in whole
};

struct LensRay {
  std::uint32_t sample;
  std::uint32_t ray;  // index into TileBatch::in
  bool near_rim;      // its way inside may meet the frame
  LensWay way;
  float inside_mm;  // way inside the glass
  // Shares of the pixel: mirrored by the first surface; gone through both, or to the wall; mirrored
  // by the second, as all is on total reflection.
  Eigen::Vector3f enter, through, back;
  Eigen::Vector3f entered;  // has passed the first surface
  Eigen::Vector3f first_point, first_normal, inside, second_point, second_normal, exit;
};

// Where a ray goes that the second surface sent back.
enum class BackWay : std::uint8_t {
  kOut,       // through the first surface
  kOutByRim,  // the same, unless the frame's reach into the glass lies between
  kWall,      // to the ground edge wall, unless the frame lies between
  kExact,     // anywhere
};

// Of a sample that is no lens's.
inline constexpr std::uint8_t kExactly = 3;  // to be traced so
inline constexpr std::uint8_t kLeftOut = 4;  // not to be traced

struct TileBatch {
  TileRaster raster;
  RayBundle primary;
  std::vector<std::uint8_t> lens_of;  // one a sample: 0 none, 1 right, 2 left, kExactly, kLeftOut
  // Lens kernel, lens frame.
  RayColumns in, exit, first, inside, second;
  std::vector<std::uint8_t> status;
  std::vector<float> enter, leave;
  std::vector<std::uint32_t> sample_of;
  std::vector<LensRay> regular;
  // Internal reflection at the back.
  RayColumns back_in, back_hit, back_out;
  std::vector<std::uint8_t> back_status;
  std::vector<float> back_reflectance;
  std::vector<BackWay> back_way;
  // Head space.
  RayBundle rim, main, front_reflection, back_reflection;
  std::vector<std::uint32_t> main_of, front_of, back_of;
  std::vector<Eigen::Vector3f> back_weight;
  // Mirrored by the frame: where they end, of samples or of a bundle's rays.
  RayBundle gloss;
  std::vector<std::uint32_t> gloss_of;
  std::vector<std::optional<GlossEnd>> gloss_ends;
  // Dispersion.
  std::vector<std::uint32_t> parted;  // indices into main
  RayColumns colour_in, colour_exit;
  std::vector<std::uint8_t> colour_status;
  RayBundle colour;
};

}  // namespace lorgnette
