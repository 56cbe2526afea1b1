// SPDX-License-Identifier: Apache-2.0
// libFuzzer target of the readers of frame files. LG_FUZZ_READER chooses one (0 OBJ, 1 PLY, 2 STL,
// 3 glTF, 4 OMA, 5 frame parameters, 6 MTL); without it the first byte of the input does, and the
// rest is the file. A reader may refuse anything; it must not crash, read outside its bytes or
// loop.
//   clang++ -fsanitize=fuzzer,address ... tests/geometry/fuzz/reader_fuzz.cc, then run it on a
//   corpus
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "geometry/frame_parameters.h"
#include "geometry/model_file.h"
#include "geometry/mtl_file.h"
#include "geometry/oma.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
#ifdef LG_FUZZ_READER
  const int reader = LG_FUZZ_READER;
#else
  if (size < 1) return 0;
  const int reader = data[0] % 7;
  ++data;
  --size;
#endif
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  using namespace lorgnette;
  switch (reader) {
    case 0:
      (void)ParseObj(bytes, "fuzz.obj");
      break;
    case 1:
      (void)ParsePly(bytes, "fuzz.ply");
      break;
    case 2:
      (void)ParseStl(bytes, "fuzz.stl");
      break;
    case 3:
      (void)ParseGltf(bytes, "fuzz.glb", "");
      break;
    case 4:
      if (const auto file = OmaFile::Parse(bytes, "fuzz.oma")) {
        if (file->Text() != bytes) __builtin_trap();
        (void)file->Traces();
        (void)file->EdgeThickness(Eye::kLeft);
        (void)ReadOmaOrder(*file);
      }
      break;
    case 6:
      (void)ParseMtl(bytes, "fuzz.mtl", "");
      break;
    default:
      (void)ParseFrameParameters(std::string(bytes), "fuzz.json");
  }
  return 0;
}
