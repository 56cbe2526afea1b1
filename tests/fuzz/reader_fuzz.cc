// SPDX-License-Identifier: Apache-2.0
// libFuzzer targets of the file readers; kFuzzedReader (reader_name.cc) names a target's own. A
// reader may refuse anything, with a sentence; it must not crash, read outside its bytes, take more
// than the memory limit or loop, and what it accepts is sound.
#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "apps/lens_surfaces.h"
#include "apps/render_journal.h"
#include "base/atomic_file.h"
#include "geometry/frame_import.h"
#include "geometry/frame_io.h"
#include "geometry/frame_parameters.h"
#include "geometry/model_file.h"
#include "geometry/mtl_file.h"
#include "geometry/oma.h"
#include "geometry/texture_file.h"
#include "optics/base_curve.h"
#include "optics/fhir.h"
#include "optics/sdf.h"
#include "render/compose.h"
#include "render/exposure_tags.h"
#include "render/image_io.h"
#include "render/obj_reader.h"
#include "render/video_io.h"
#include "tracking/camera_file.h"
#include "tracking/canonical_mesh.h"
#include "tracking/head_track.h"

extern const char* const kFuzzedReader;

namespace lorgnette {
namespace {

void Require(bool sound) {
  if (!sound) __builtin_trap();
}

// The value, or nothing; an error without a message, or of many lines, is a finding.
template <class T>
const T* Accepted(const Result<T>& result) {
  if (result) return &*result;
  Require(!result.error().message.empty());
  Require(result.error().message.find('\n') == std::string::npos);
  return nullptr;
}

// The bytes as a file, for the readers that open one.
std::string PathOf(std::string_view bytes) {
  static const int file = memfd_create("fuzz", 0);
  static const std::string path = "/proc/self/fd/" + std::to_string(file);
  Require(ftruncate(file, 0) == 0);
  Require(pwrite(file, bytes.data(), bytes.size(), 0) == ssize_t(bytes.size()));
  return path;
}

void CheckMesh(const TriangleMesh& mesh) {
  const std::size_t points = mesh.positions.size();
  Require(mesh.normals.empty() || mesh.normals.size() == points);
  Require(mesh.uvs.empty() || mesh.uvs.size() == points);
  for (const Eigen::Vector3d& p : mesh.positions) Require(p.allFinite());
  for (const Eigen::Vector3i& t : mesh.triangles) {
    Require(t.minCoeff() >= 0 && std::size_t(t.maxCoeff()) < points);
  }
}

void CheckModel(const Result<ModelFile>& result) {
  if (const ModelFile* model = Accepted(result)) {
    for (const ModelPart& part : model->parts) CheckMesh(part.mesh);
  }
}

template <class Pixels>
void CheckImage(const Result<Pixels>& result) {
  if (const Pixels* image = Accepted(result)) Require(image->width > 0 && image->height > 0);
}

void CheckOma(std::string_view bytes) {
  const Result<OmaFile> result = OmaFile::Parse(bytes, "fuzz.oma");
  const OmaFile* file = Accepted(result);
  if (!file) return;
  Require(file->Text() == bytes);
  (void)Accepted(file->EdgeThickness(Eye::kLeft));
  (void)Accepted(file->Numbers("DBL"));
  (void)Accepted(ReadOmaOrder(*file));
  const auto traces = file->Traces();
  if (!Accepted(traces)) return;
  for (const OmaTrace& trace : *traces) {
    for (const Eigen::Vector2d& p : trace.contour_mm) Require(p.allFinite());
  }
  OmaFile changed = *file;
  changed.Set("DBL", "18.00");
  Require(changed.Get("DBL") == "18.00");
}

void CheckFrame(const Result<FrameModel>& result) {
  const FrameModel* frame = Accepted(result);
  if (!frame) return;
  for (const FramePart& part : frame->parts) CheckMesh(part.mesh);
  Require(frame->right.contour_mm.size() >= 3 && frame->left.contour_mm.size() >= 3);
  Require(frame->boxing.a_mm > 0 && frame->boxing.b_mm > 0);
}

void CheckTraceFrame(std::string_view bytes) {
  static const FrameParameters style =
      *ParseFrameParameters(*ReadFile(DataDirectory() + "/frames/panto.json"), "panto.json");
  if (const auto file = OmaFile::Parse(bytes, "fuzz.oma"))
    CheckFrame(FrameAroundTrace(*file, style));
}

void CheckModelFrame(std::string_view bytes) {
  if (const auto model = ParseObj(bytes, "fuzz.obj")) CheckFrame(ImportFrame(*model, "fuzz.obj"));
}

void CheckTrack(const std::string& text) {
  const Result<HeadTrack> result = ParseHeadTrack(text, "fuzz.json");
  const HeadTrack* track = Accepted(result);
  if (!track) return;
  CheckMesh(track->face);
  const std::size_t points = track->face.positions.size();
  Require(points > 0 && track->face.normals.size() == points && !track->frames.empty());
  for (const TrackedFrame& frame : track->frames) {
    Require(frame.camera_from_head.matrix().allFinite());
    Require(frame.vertices.empty() || frame.vertices.size() == points);
  }
}

void CheckCamera(const std::string& text) {
  const Result<CalibratedCamera> result = ParseCameraFile(text, "fuzz.json");
  const CalibratedCamera* camera = Accepted(result);
  if (!camera) return;
  Require(camera->camera.fx >= 1 && camera->camera.fy >= 1);
  const auto ideal = camera->distortion.Ideal({0.3, -0.2});
  if (ideal) Require(ideal->allFinite());
  (void)Accepted(ScaledTo(*camera, 640, 480, "fuzz.json"));
}

void CheckLens(std::string_view bytes) {
  LensOptions options;
  options.lens_file = PathOf(bytes);
  const Result<LensDesign> result = LensFromFile(options);
  if (const LensDesign* design = Accepted(result)) Require(design->lens.center_thickness_mm > 0);
}

void CheckVideo(std::string_view bytes) {
  auto reader = VideoReader::Open(PathOf(bytes));
  if (!Accepted(reader)) return;
  constexpr int kFrames = 8;
  for (int i = 0; i < kFrames; ++i) {
    const auto frame = reader->Next();
    if (!Accepted(frame) || !*frame) return;
    Require((*frame)->rgb.width == reader->info().width);
    Require((*frame)->rgb.height == reader->info().height);
  }
}

void CheckJournal(std::string_view bytes) {
  std::uint64_t key = 0;  // the file's own: any other starts it anew
  if (bytes.size() >= 2 * sizeof key) std::memcpy(&key, bytes.data() + sizeof key, sizeof key);
  const auto journal = RenderJournal::Open(PathOf(bytes), key);
  if (!Accepted(journal)) return;
  ImageRgb8 picture(16, 12);
  for (long frame = -1; frame < 4; ++frame) (void)journal->Restore(frame, picture);
}

void Read(std::string_view bytes) {
  static const std::string_view reader = kFuzzedReader;
  const std::string text(bytes);
  if (reader == "obj") {
    CheckModel(ParseObj(bytes, "fuzz.obj"));
  } else if (reader == "ply") {
    CheckModel(ParsePly(bytes, "fuzz.ply"));
  } else if (reader == "stl") {
    CheckModel(ParseStl(bytes, "fuzz.stl"));
  } else if (reader == "gltf") {
    CheckModel(ParseGltf(bytes, "fuzz.glb", ""));
  } else if (reader == "mtl") {
    (void)Accepted(ParseMtl(bytes, "fuzz.mtl", ""));
  } else if (reader == "texture") {
    (void)Accepted(DecodeTexture(bytes, "fuzz.png"));
  } else if (reader == "model_frame") {
    CheckModelFrame(bytes);
  } else if (reader == "oma") {
    CheckOma(bytes);
  } else if (reader == "trace_frame") {
    CheckTraceFrame(bytes);
  } else if (reader == "frame") {
    (void)Accepted(ParseFrameParameters(text, "fuzz.json"));
  } else if (reader == "prescription") {
    (void)Accepted(ParsePrescription(text, "fuzz.json"));
  } else if (reader == "fhir") {
    (void)LooksLikeFhir(text);
    (void)Accepted(ParseFhir(text, "fuzz.json"));
  } else if (reader == "sdf") {
    (void)Accepted(ParseSdf(text, "fuzz.sdf"));
  } else if (reader == "base_curves") {
    (void)Accepted(ParseBaseCurveChart(text, "fuzz.json"));
  } else if (reader == "lens") {
    CheckLens(bytes);
  } else if (reader == "track") {
    CheckTrack(text);
  } else if (reader == "camera") {
    CheckCamera(text);
  } else if (reader == "canonical_mesh") {
    (void)Accepted(ReadCanonicalMesh(PathOf(bytes)));
  } else if (reader == "exr") {
    CheckImage(ReadExrRgba(PathOf(bytes)));
  } else if (reader == "hdr") {
    CheckImage(ReadRadianceHdr(PathOf(bytes)));
  } else if (reader == "obj_triangles") {
    const auto mesh = ReadObjTriangles(PathOf(bytes));
    if (Accepted(mesh)) CheckMesh(*mesh);
  } else if (reader == "exposure_tags") {
    (void)Accepted(ReadExposureTags(PathOf(bytes)));
  } else if (reader == "video") {
    CheckVideo(bytes);
  } else if (reader == "case") {
    (void)Accepted(ReadComposeCase(PathOf(bytes)));
  } else if (reader == "journal") {
    CheckJournal(bytes);
  } else {
    Require(reader == "picture");
    CheckImage(ReadPicture(PathOf(bytes)));
  }
}

}  // namespace
}  // namespace lorgnette

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  lorgnette::Read({reinterpret_cast<const char*>(data), size});
  return 0;
}
