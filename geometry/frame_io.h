// SPDX-License-Identifier: Apache-2.0
// Frames by name or from a file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "geometry/frame_model.h"

namespace lorgnette {

// One frame of data/frames.
struct ShippedFrame {
  std::string name;         // what LoadFrame takes: "aviator"
  std::string description;  // one line
  std::string path;
};

// The folder that holds `frames`: $LORGNETTE_DATA, else ../data or ../share/lorgnette beside the
// program, else the source folder this was built from.
std::string DataDirectory();

// In the order of their names. Fails when the folder is missing or a file in it cannot be read.
Result<std::vector<ShippedFrame>> ListShippedFrames();

// A shipped frame by name, a .json file of frame parameters, a lab trace (.oma: a frame is built
// around it, of metal where FTYP says so, else of acetate), or a model file (.glb, .gltf, .obj,
// .ply, .stl; geometry/frame_import.h) by path.
//   unit_mm  mm per unit of the file, where the file does not say
Result<FrameModel> LoadFrame(const std::string& name_or_path,
                             std::optional<double> unit_mm = std::nullopt);

}  // namespace lorgnette
