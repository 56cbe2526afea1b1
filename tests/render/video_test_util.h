// SPDX-License-Identifier: Apache-2.0
// Small videos for tests, made by our own writer, or by the ffmpeg program where a test needs a
// property that our writer does not set (it skips without it).
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "render/image_io.h"
#include "render/video_io.h"

namespace lorgnette {

// A fresh folder a test, removed at its end.
class VideoTest : public testing::Test {
 protected:
  VideoTest() {
    std::string pattern = testing::TempDir() + "lorgnette_video_XXXXXX";
    folder_ = mkdtemp(pattern.data());
  }
  ~VideoTest() override { std::filesystem::remove_all(folder_); }

  std::string Path(const std::string& name) const { return folder_ + "/" + name; }
  int FilesHere() const {
    int count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder_)) ++count;
    return count;
  }
  static bool HasFfmpeg() {
    return std::system("ffmpeg -version >/dev/null 2>&1") == 0;  // NOLINT(cert-env33-c)
  }
  bool Ffmpeg(const std::string& arguments) const {
    const std::string command = "cd '" + folder_ + "' && ffmpeg -v error -y " + arguments;
    return std::system(command.c_str()) == 0;  // NOLINT(cert-env33-c)
  }

  // Smooth picture with a lighter block that moves with `number`; every channel differs.
  static ImageRgb8 Picture(int width, int height, int number) {
    ImageRgb8 image(width, height);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        std::uint8_t* p = image.at(x, y);
        const int block = x / 8 == number % 4 && y < height / 2 ? 40 : 0;
        p[0] = static_cast<std::uint8_t>(40 + block + 120 * x / width);
        p[1] = static_cast<std::uint8_t>(60 + block + 120 * y / height);
        p[2] = static_cast<std::uint8_t>(150 + block - 60 * x / width);
      }
    }
    return image;
  }

  // Writes frame_0001.png ... and opens them as a sequence.
  Result<VideoReader> Sequence(int width, int height, int count) const {
    for (int i = 0; i < count; ++i) {
      char name[32];
      std::snprintf(name, sizeof name, "frame_%04d.png", i + 1);
      if (const Status s = WritePicture(Picture(width, height, i), Path(name)); !s) {
        return tl::unexpected(s.error());
      }
    }
    return VideoReader::Open(Path("frame_%04d.png"));
  }

  // Every frame of a file.
  static Result<std::vector<VideoFrame>> ReadAll(const std::string& path) {
    LG_ASSIGN(VideoReader reader, VideoReader::Open(path));
    std::vector<VideoFrame> frames;
    while (true) {
      LG_ASSIGN(std::optional<VideoFrame> frame, reader.Next());
      if (!frame) return frames;
      frames.push_back(*std::move(frame));
    }
  }
  // Copies a source into a video, unchanged.
  static Status Copy(const std::string& from, const std::string& to) {
    LG_ASSIGN(VideoReader reader, VideoReader::Open(from));
    LG_ASSIGN(VideoWriter writer, VideoWriter::Create(to, reader));
    while (true) {
      LG_ASSIGN(const std::optional<VideoFrame> frame, reader.Next());
      if (!frame) return writer.Finish();
      LG_RETURN_IF_ERROR(writer.Write(*frame));
    }
  }
  // Mean and greatest difference of code values.
  struct Difference {
    double mean = 0;
    int greatest = 0;
  };
  static Difference Compare(const ImageRgb8& a, const ImageRgb8& b) {
    Difference difference;
    EXPECT_EQ(a.data.size(), b.data.size());
    if (a.data.size() != b.data.size()) return {1e9, 255};
    for (std::size_t i = 0; i < a.data.size(); ++i) {
      const int d = std::abs(a.data[i] - b.data[i]);
      difference.mean += d;
      difference.greatest = std::max(difference.greatest, d);
    }
    difference.mean /= static_cast<double>(a.data.size());
    return difference;
  }

  std::string folder_;
};

}  // namespace lorgnette
