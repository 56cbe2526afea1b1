// SPDX-License-Identifier: Apache-2.0
#include "render/image_io.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "base/atomic_file.h"

namespace lorgnette {
namespace {

std::string Temporary(const std::string& name) { return testing::TempDir() + "image_io_" + name; }

ImageRgbF Ramp(int width, int height) {
  ImageRgbF image(width, height);
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    image.data[i] = std::ldexp(1.0f + float(i % 97) / 97.0f, int(i % 21) - 10);
  }
  return image;
}

TEST(Exr, KeepsFloatsToTheBit) {
  const std::string path = Temporary("float.exr");
  const ImageRgbF image = Ramp(13, 7);
  ASSERT_TRUE(WriteExr(image, path, ExrDepth::kFloat));
  const auto back = ReadExr(path);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->width, 13);
  EXPECT_EQ(back->height, 7);
  EXPECT_EQ(back->data, image.data);
}

TEST(Exr, KeepsHalvesToTheirPrecisionAndClampsAtTheirRange) {
  const std::string path = Temporary("half.exr");
  ImageRgbF image = Ramp(5, 4);
  image.data[3] = 1e9f;
  ASSERT_TRUE(WriteExr(image, path));
  const auto back = ReadExr(path);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->data[3], 65504.0f);
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    // Half a unit in the last of 11 bits.
    if (i != 3) {
      EXPECT_NEAR(back->data[i] / image.data[i], 1, 0x1p-11) << i;
    }
  }
}

TEST(Exr, KeepsTheFourthChannel) {
  const std::string path = Temporary("rgba.exr");
  ImageRgbaF image(3, 2);
  for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = float(i);
  ASSERT_TRUE(WriteExr(image, path, ExrDepth::kFloat));
  const auto back = ReadExrRgba(path);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->data, image.data);
}

TEST(Exr, TellsWhatIsWrongWithAFile) {
  const std::string path = Temporary("broken.exr");
  ASSERT_TRUE(WriteFileAtomically(path, "this is no picture"));
  const auto broken = ReadExr(path);
  ASSERT_FALSE(broken);
  EXPECT_NE(broken.error().message.find(path), std::string::npos);
  EXPECT_FALSE(ReadHighDynamicRange(path));
  EXPECT_FALSE(ReadExr(Temporary("missing.exr")));
}

// An attribute of 1.9 GB in a file of some hundred bytes (what fuzzing found), and a good file cut
// off anywhere.
TEST(Exr, RefusesAFileThatEndsBeforeItsHeaderDoes) {
  const std::string path = Temporary("cut.exr");
  ASSERT_TRUE(WriteFileAtomically(
      path, std::string("v/1\x01\2\0\0\0", 8) + std::string("a\0b\0\0\0\6\x64", 8)));
  const auto broken = ReadExr(path);
  ASSERT_FALSE(broken);
  EXPECT_NE(broken.error().message.find(path), std::string::npos);
  ASSERT_TRUE(WriteExr(Ramp(3, 2), path));
  const std::string good = *ReadFile(path);
  for (std::size_t length = 0; length < good.size(); ++length) {
    ASSERT_TRUE(WriteFileAtomically(path, good.substr(0, length)));
    EXPECT_FALSE(ReadExr(path)) << length;
  }
}

TEST(Exr, LeavesNothingBehindWhereItCannotWrite) {
  EXPECT_FALSE(WriteExr(Ramp(2, 2), Temporary("no_folder/x.exr")));
}

// 8 pixels of run-length coded scan line: R a run of 8, G literals, B and E runs.
std::string HdrOfOneRow() {
  std::string file = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 8\n";
  file += std::string("\x02\x02\x00\x08", 4);
  file += std::string("\x88\x80", 2);
  file += std::string("\x08\x00\x10\x20\x30\x40\x50\x60\x70", 9);
  file += std::string("\x88\x40", 2);
  file += std::string("\x88\x81", 2);
  return file;
}

TEST(RadianceHdr, DecodesRunsAndLiterals) {
  const std::string path = Temporary("row.hdr");
  ASSERT_TRUE(WriteFileAtomically(path, HdrOfOneRow()));
  const auto image = ReadHighDynamicRange(path);
  ASSERT_TRUE(image) << image.error().message;
  ASSERT_EQ(image->width, 8);
  ASSERT_EQ(image->height, 1);
  // (m + 0.5) * 2^(e - 136) with e = 129.
  for (int x = 0; x < 8; ++x) {
    EXPECT_FLOAT_EQ(image->at(x, 0)[0], 128.5f / 128);
    EXPECT_FLOAT_EQ(image->at(x, 0)[1], (16.0f * float(x) + 0.5f) / 128);
    EXPECT_FLOAT_EQ(image->at(x, 0)[2], 64.5f / 128);
  }
}

TEST(RadianceHdr, RefusesAFileThatIsCutShort) {
  const std::string path = Temporary("short.hdr");
  const std::string whole = HdrOfOneRow();
  ASSERT_TRUE(WriteFileAtomically(path, whole.substr(0, whole.size() - 3)));
  const auto image = ReadRadianceHdr(path);
  ASSERT_FALSE(image);
  EXPECT_NE(image.error().message.find("row 0"), std::string::npos) << image.error().message;
}

TEST(Picture, KeepsPngToTheBit) {
  const std::string path = Temporary("picture.png");
  ImageRgb8 image(5, 3);
  for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = std::uint8_t(17 * i);
  ASSERT_TRUE(WritePicture(image, path));
  const auto back = ReadPicture(path);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->data, image.data);
}

// Smooth, as JPEG likes it: red to the right, green downward.
ImageRgb8 Gradients(int width, int height) {
  ImageRgb8 image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.at(x, y)[0] = std::uint8_t(255 * x / (width - 1));
      image.at(x, y)[1] = std::uint8_t(255 * y / (height - 1));
      image.at(x, y)[2] = 90;
    }
  }
  return image;
}

int GreatestDifference(const ImageRgb8& a, const ImageRgb8& b) {
  if (a.width != b.width || a.height != b.height) return 256;
  int greatest = 0;
  for (std::size_t i = 0; i < a.data.size(); ++i) {
    greatest = std::max(greatest, std::abs(int(a.data[i]) - int(b.data[i])));
  }
  return greatest;
}

TEST(Picture, KeepsJpegToAFewCodes) {
  const std::string path = Temporary("picture.jpg");
  const ImageRgb8 image = Gradients(64, 40);
  ASSERT_TRUE(WritePicture(image, path));
  const auto back = ReadPicture(path);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_LE(GreatestDifference(*back, image), 6);
}

TEST(Picture, TurnsAJpegUprightAsExifSays) {
  const std::string path = Temporary("held.jpg");
  const ImageRgb8 image = Gradients(64, 40);
  ASSERT_TRUE(WritePicture(image, path));
  const std::string plain = *ReadFile(path);
  // APP1 with one entry of IFD 0, the orientation: 6, row 0 of the file is the right side.
  using namespace std::string_literals;
  const std::string exif =
      "\xff\xe1\x00\x22"s
      "Exif\0\0MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\0\0\0\0"s;
  ASSERT_TRUE(WriteFileAtomically(path, plain.substr(0, 2) + exif + plain.substr(2)));
  const auto held = ReadPicture(path);
  ASSERT_TRUE(held) << held.error().message;
  ImageRgb8 upright(40, 64);
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 64; ++x) std::copy_n(image.at(x, y), 3, upright.at(39 - y, x));
  }
  EXPECT_LE(GreatestDifference(*held, upright), 6);
}

// Two pixels of RGB without compression, with a tag that few decoders know.
std::string SmallTiff() {
  std::string bytes = "II*";
  const auto put = [&](std::uint32_t value, int size) {
    for (int k = 0; k < size; ++k) bytes += char((value >> (8 * k)) & 0xff);
  };
  constexpr int kEntries = 11, kShort = 3, kLong = 4;
  put(0, 1);
  put(8, 4);  // of the directory
  put(kEntries, 2);
  const auto entry = [&](int tag, int type, int count, std::uint32_t value) {
    put(std::uint32_t(tag), 2);
    put(std::uint32_t(type), 2);
    put(std::uint32_t(count), 4);
    put(value, 4);
  };
  const std::uint32_t behind = 8 + 2 + 12 * kEntries + 4;
  entry(256, kShort, 1, 2);          // width
  entry(257, kShort, 1, 1);          // height
  entry(258, kShort, 3, behind);     // bits a sample
  entry(259, kShort, 1, 1);          // compression: none
  entry(262, kShort, 1, 2);          // RGB
  entry(273, kLong, 1, behind + 6);  // strip
  entry(277, kShort, 1, 3);          // samples a pixel
  entry(278, kShort, 1, 1);          // rows a strip
  entry(279, kLong, 1, 6);           // bytes of the strip
  entry(339, kShort, 1, 1);          // samples are whole numbers
  entry(51000, kLong, 1, 7);         // somebody's own
  put(0, 4);                         // no other directory
  for (int k = 0; k < 3; ++k) put(8, 2);
  for (const int value : {10, 20, 30, 200, 210, 220}) put(std::uint32_t(value), 1);
  return bytes;
}

TEST(Picture, ReadsATiffWithForeignTags) {
  const std::string path = Temporary("foreign.tif");
  ASSERT_TRUE(WriteFileAtomically(path, SmallTiff()));
  const auto picture = ReadPicture(path);
  ASSERT_TRUE(picture) << picture.error().message;
  EXPECT_EQ(picture->width, 2);
  EXPECT_EQ(picture->data, (std::vector<std::uint8_t>{10, 20, 30, 200, 210, 220}));
  ASSERT_TRUE(WriteFileAtomically(path, SmallTiff().substr(0, SmallTiff().size() - 4)));
  EXPECT_FALSE(ReadPicture(path));
}

TEST(Picture, RefusesAFileThatIsCutShort) {
  for (const char* name : {"cut.png", "cut.jpg"}) {
    const std::string path = Temporary(name);
    ASSERT_TRUE(WritePicture(Gradients(64, 40), path));
    const std::string whole = *ReadFile(path);
    for (std::size_t eighths = 0; eighths < 8; ++eighths) {
      ASSERT_TRUE(WriteFileAtomically(path, whole.substr(0, whole.size() * eighths / 8)));
      const auto cut = ReadPicture(path);
      EXPECT_FALSE(cut) << name << ' ' << eighths;
      if (cut) continue;
      EXPECT_NE(cut.error().message.find(path), std::string::npos);
    }
  }
}

TEST(Picture, RefusesAnExtensionItCannotWrite) {
  const Status status = WritePicture(ImageRgb8(1, 1), Temporary("picture.gif"));
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().kind, ErrorKind::kUsage);
}

}  // namespace
}  // namespace lorgnette
