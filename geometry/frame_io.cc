// SPDX-License-Identifier: Apache-2.0
#include "geometry/frame_io.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "base/atomic_file.h"
#include "cmake/source_dir.h"
#include "geometry/frame_import.h"
#include "geometry/model_file.h"
#include "geometry/oma.h"
#include "geometry/parametric_frame.h"

namespace lorgnette {
namespace {

namespace fs = std::filesystem;

bool HasFrames(const fs::path& data) {
  std::error_code error;
  return fs::is_directory(data / "frames", error);
}

Result<FrameParameters> ReadParameters(const std::string& path) {
  LG_ASSIGN(const std::string text, ReadFile(path));
  return ParseFrameParameters(text, path);
}

std::string ShippedPath(const std::string& name) {
  return (fs::path(DataDirectory()) / "frames" / (name + ".json")).string();
}

// The frame of a lab trace, in the make that its FTYP names: 2 metal, 3 rimless (with parts of
// metal), else plastic.
Result<FrameModel> LoadTrace(const std::string& path) {
  LG_ASSIGN(const std::string bytes, ReadFile(path));
  LG_ASSIGN(const OmaFile job, OmaFile::Parse(bytes, path));
  const std::string make = job.Get("FTYP").value_or("1").substr(0, 1);
  const bool metal = make == "2" || make == "3";
  LG_ASSIGN(FrameParameters style, ReadParameters(ShippedPath(metal ? "round" : "panto")));
  style.name = fs::path(path).stem().string();
  style.rim.flares.clear();
  style.bridge_sizes_mm.clear();  // the trace has one
  return FrameAroundTrace(job, std::move(style));
}

}  // namespace

std::string DataDirectory() {
  if (const char* chosen = std::getenv("LORGNETTE_DATA")) return chosen;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) {
    for (const fs::path& beside : {program.parent_path() / ".." / "data",
                                   program.parent_path() / ".." / "share" / "lorgnette"}) {
      if (HasFrames(beside)) return beside.lexically_normal().string();
    }
  }
  return LORGNETTE_SOURCE_DIR "/data";
}

Result<std::vector<ShippedFrame>> ListShippedFrames() {
  const fs::path folder = fs::path(DataDirectory()) / "frames";
  std::error_code error;
  fs::directory_iterator entries(folder, error);
  if (error) return Failure(folder.string() + ": got " + error.message() + ", want our frames");
  std::vector<ShippedFrame> frames;
  for (const fs::directory_entry& entry : entries) {
    if (entry.path().extension() != ".json") continue;
    LG_ASSIGN(const FrameParameters parameters, ReadParameters(entry.path().string()));
    frames.push_back({entry.path().stem().string(), parameters.description, entry.path().string()});
  }
  std::sort(frames.begin(), frames.end(),
            [](const ShippedFrame& a, const ShippedFrame& b) { return a.name < b.name; });
  return frames;
}

Result<FrameModel> LoadFrame(const std::string& name_or_path, std::optional<double> unit_mm) {
  const fs::path given(name_or_path);
  std::error_code error;
  if (given.extension().empty() && !given.has_parent_path()) {
    const fs::path shipped = fs::path(DataDirectory()) / "frames" / (name_or_path + ".json");
    if (fs::exists(shipped, error)) {
      LG_ASSIGN(const FrameParameters parameters, ReadParameters(shipped.string()));
      return BuildFrame(parameters);
    }
    std::string names;
    if (const auto all = ListShippedFrames()) {
      for (const ShippedFrame& frame : *all) names += (names.empty() ? "" : ", ") + frame.name;
    }
    return UsageError("--frame: got \"" + name_or_path + "\", want a file or one of " + names);
  }
  std::string extension = given.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  if (extension == ".json") {
    LG_ASSIGN(const FrameParameters parameters, ReadParameters(name_or_path));
    return BuildFrame(parameters);
  }
  if (IsOmaPath(name_or_path)) return LoadTrace(name_or_path);
  LG_ASSIGN(const ModelFile model, ReadModelFile(name_or_path));
  return ImportFrame(model, name_or_path, unit_mm);
}

}  // namespace lorgnette
