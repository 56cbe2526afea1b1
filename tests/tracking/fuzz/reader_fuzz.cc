// SPDX-License-Identifier: Apache-2.0
// libFuzzer target of the readers of track files and camera files: the first byte chooses the
// reader, the rest is the text. A reader may refuse anything; it must not crash, read outside its
// bytes or loop, and what it accepts is sound.
//   clang++ -std=c++20 -fsanitize=fuzzer,address -I. -I/usr/include/eigen3 -I/usr/include/opencv4
//     tests/tracking/fuzz/reader_fuzz.cc tracking/head_track.cc tracking/camera_file.cc
//     base/*.cc -lfmt, then run it on a corpus
#include <cstddef>
#include <cstdint>
#include <string>

#include "tracking/camera_file.h"
#include "tracking/head_track.h"

namespace {

void Require(bool sound) {
  if (!sound) __builtin_trap();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lorgnette;
  if (size < 1) return 0;
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  if (data[0] % 2 == 0) {
    const auto track = ParseHeadTrack(text, "fuzz.json");
    if (!track) {
      Require(!track.error().message.empty());
      return 0;
    }
    const std::size_t points = track->face.positions.size();
    Require(points > 0 && track->face.normals.size() == points && !track->frames.empty());
    for (const Eigen::Vector3i& t : track->face.triangles) {
      Require(t.minCoeff() >= 0 && std::size_t(t.maxCoeff()) < points);
    }
    for (const TrackedFrame& frame : track->frames) {
      Require(frame.camera_from_head.matrix().allFinite());
      Require(frame.vertices.empty() || frame.vertices.size() == points);
    }
  } else {
    const auto camera = ParseCameraFile(text, "fuzz.json");
    if (!camera) return 0;
    Require(camera->camera.fx >= 1 && camera->camera.fy >= 1);
    const auto ideal = camera->distortion.Ideal({0.3, -0.2});
    if (ideal) Require(ideal->allFinite());
    (void)ScaledTo(*camera, 640, 480, "fuzz.json");
  }
  return 0;
}
