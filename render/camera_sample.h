// SPDX-License-Identifier: Apache-2.0
// A sample of a pixel. Internal to render/.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace lorgnette {

// One camera ray, and what it brought.
struct CameraSample {
  float x = 0, y = 0;       // pixel position
  std::uint16_t pixel = 0;  // index into the tile's PixelStates

  enum class Kind : std::uint8_t {
    kBackground,
    kHead,
    kFrame,
    kLensToHead,        // through both surfaces ...
    kLensToBackground,  // ... past the head
    kLensElsewhere      // any other way through glass
  };
  Kind kind = Kind::kBackground;
  bool turns = false;  // the frame's normal does, within a pixel: known where edges are left out
  Eigen::Vector3f inserted{0, 0, 0};  // light of lens and frame
  Eigen::Vector3f direct{1, 1, 1};    // factor of the input pixel
};

// What shows the input picture, darkened at most; the frame; or glass.
enum class SampleClass : std::uint8_t { kInput, kFrame, kGlass };
inline SampleClass ClassOf(CameraSample::Kind kind) {
  return kind <= CameraSample::Kind::kHead    ? SampleClass::kInput
         : kind == CameraSample::Kind::kFrame ? SampleClass::kFrame
                                              : SampleClass::kGlass;
}

}  // namespace lorgnette
