// SPDX-License-Identifier: Apache-2.0
// A corpus of broken frame files, each refused with one sentence that names the file: what fuzzing
// found, and what people's files have had. Cut off anywhere, a good file is refused or read, and
// nothing else happens.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "base/atomic_file.h"
#include "geometry/frame_io.h"
#include "geometry/frame_parameters.h"
#include "geometry/model_file.h"
#include "geometry/mtl_file.h"
#include "geometry/oma.h"

namespace lorgnette {
namespace {

// What a reader says of bytes: its error, or nothing.
std::string Complaint(const std::string& kind, const std::string& bytes) {
  const std::string name = "broken." + kind;
  const auto told = [](const auto& result) {
    return result ? std::string() : result.error().message;
  };
  if (kind == "obj") return told(ParseObj(bytes, name));
  if (kind == "ply") return told(ParsePly(bytes, name));
  if (kind == "stl") return told(ParseStl(bytes, name));
  if (kind == "gltf") return told(ParseGltf(bytes, name, ""));
  if (kind == "mtl") return told(ParseMtl(bytes, name, ""));
  if (kind == "json") return told(ParseFrameParameters(bytes, name));
  const auto file = OmaFile::Parse(bytes, name);
  if (!file) return file.error().message;
  if (file->Text() != bytes) return "bytes not kept";
  if (const auto traces = file->Traces(); !traces) return traces.error().message;
  return told(file->EdgeThickness(Eye::kRight));
}

struct Broken {
  const char* kind;
  std::string bytes;
};

std::string Binary(const std::string& head, std::initializer_list<float> floats) {
  std::string bytes = head;
  for (const float f : floats) bytes.append(reinterpret_cast<const char*>(&f), sizeof f);
  return bytes;
}

std::vector<Broken> Corpus() {
  const std::string ply_head = "ply\nformat ascii 1.0\n";
  const std::string gltf = R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[
{"primitives":[{"attributes":{"POSITION":0}}]}],)";
  return {
      {"obj", "v 0 0\n"},
      {"obj", "v 0 0 nonsense\n"},
      {"obj", "v 0 0 0\nf 1 1\n"},
      {"obj", "v 0 0 0\nf 1 2 99999999999999999999\n"},
      {"obj", "v 0 0 0\nf 0 0 0\n"},
      {"obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -4 -1 -2\n"},
      {"obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/2 2/1 3/1\n"},
      {"obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1//1 2//1 3//1\n"},
      {"obj", "vt x\n"},
      {"ply", ""},
      {"ply", "plx\n"},
      {"ply", ply_head},
      {"ply", ply_head + "element vertex -3\nend_header\n"},
      {"ply", ply_head + "element vertex 4000000000\nproperty float x\nend_header\n"},
      {"ply", ply_head + "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
                         "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                         "0 0 0\n3 0 0 9\n"},
      {"ply",
       "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\n"
       "property float y\nproperty float z\nend_header\n123"},
      {"stl", ""},
      {"stl", "solid nothing"},
      {"stl", std::string(80, 'x') + std::string("\xff\xff\xff\xff", 4)},
      {"stl", "solid a\nvertex 0 0 0\nvertex nan 0 0\nvertex 0 1 0\n"},
      {"stl", Binary(std::string(80, ' ') + std::string("\x01\0\0\0", 4),
                     {0, 0, 1, 0, 0, 0, 1, std::numeric_limits<float>::infinity(), 0, 0, 1, 0}) +
                  std::string(2, '\0')},
      {"stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n"},
      {"ply", Binary("ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\n"
                     "property float y\nproperty float z\nelement face 1\n"
                     "property list uchar uchar vertex_indices\nend_header\n",
                     {0, 0, 0, 1, 0, 0, 0, 1, std::numeric_limits<float>::quiet_NaN()}) +
                  std::string("\3\0\1\2", 4)},
      {"gltf", ""},
      {"gltf", gltf + R"("accessors":[{"bufferView":0,"componentType":5126,"count":1,
"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":12}],
"buffers":[{"byteLength":12,"uri":"data:application/octet-stream;base64,//////////8AAAAA"}]})"},
      {"gltf", "{}"},
      {"gltf", "glTF\x02"},
      {"gltf", Binary("glTF", {1e30f, -1, 0, 0, 0})},
      {"gltf",
       gltf + R"("accessors":[{"bufferView":7,"componentType":5126,"count":3,"type":"VEC3"}]})"},
      {"gltf", gltf + R"("accessors":[{"bufferView":0,"componentType":5126,"count":99999,
"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":12}],
"buffers":[{"byteLength":12,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAA"}]})"},
      {"gltf", R"({"asset":{"version":"2.0"},"images":[{"bufferView":0,"mimeType":"image/png"}],
"bufferViews":[{"buffer":0,"byteOffset":4,"byteLength":4096}],
"buffers":[{"byteLength":12,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAA"}]})"},
      {"gltf", R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"children":[1]},{"children":[0]}]})"},
      {"mtl", "newmtl a\nNs shiny\n"},
      {"mtl", "newmtl a\nKd 0.1 0.2\n"},
      {"mtl", "newmtl a\nd\n"},
      {"oma", ""},
      {"oma", "no label at all"},
      {"oma", "TRCFMT=1;400;E\n"},
      {"oma", "TRCFMT=6;400;E;R;F\nR=\x01\x02\n"},
      {"oma", "TRCFMT=1;400;E;R;F\nR=2500;2500\n"},
      {"oma", "TRCFMT=1;8;E;R;F\nR=1;2;3;4;5;6;7;8\n"},
      {"oma", "TRCFMT=1;1e99;E;R;F\n"},
      {"oma", "TRCFMT=1;nan;E;R;F\n"},
      {"oma", "TRCFMT=1;8;E;R;F\nR=2500;2500;2500;2500;2500;2500;2500;x\n"},
      {"oma", "A=1\nSTHKFMT=1;2;E;R\nT=100\n"},
      {"json", ""},
      {"json", "{"},
      {"json", "{\"name\": 7}"},
      {"json", std::string(100000, '[')},
  };
}

TEST(BrokenFiles, AreEachRefusedWithASentenceThatNamesThem) {
  for (const Broken& broken : Corpus()) {
    SCOPED_TRACE(std::string(broken.kind) + ": " + broken.bytes.substr(0, 120));
    const std::string complaint = Complaint(broken.kind, broken.bytes);
    EXPECT_THAT(complaint, testing::HasSubstr("broken."));
    EXPECT_THAT(complaint, testing::Not(testing::HasSubstr("\n")));
  }
}

TEST(BrokenFiles, GoodFilesCutOffAnywhereDoNoHarm) {
  std::string stl = std::string(80, ' ') + std::string("\x02\0\0\0", 4) + std::string(100, '\x3f');
  const std::pair<const char*, std::string> good[] = {
      {"obj",
       "mtllib a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nusemtl b\nf 1/1/1 2/1/1 3/1/1\n"},
      {"ply",
       "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
       "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
       "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
      {"stl", stl},
      {"mtl", "newmtl a\nKd 0.1 0.2 0.3\nKs 1\nNs 10\nd 0.5\nmap_Kd -s 1 2 3 -clamp on a b.png\n"},
      {"oma",
       "DBL=18\r\nTRCFMT=1;8;E;R;F\r\nR=2500;2500;2500;2500\r\nR=2500;2500;2500;2500\r\n"
       "STHKFMT=1;2;E;R\r\nR=2500;2500\r\nT=100;200\r\n"},
      {"json", *ReadFile(DataDirectory() + "/frames/round.json")},
  };
  for (const auto& [kind, bytes] : good) {
    EXPECT_EQ(Complaint(kind, bytes), "") << kind;
    for (std::size_t length = 0; length < bytes.size(); ++length) {
      const std::string complaint = Complaint(kind, bytes.substr(0, length));
      if (!complaint.empty()) {
        EXPECT_THAT(complaint, testing::HasSubstr("broken.")) << kind << " cut at " << length;
      }
    }
  }
}

}  // namespace
}  // namespace lorgnette
