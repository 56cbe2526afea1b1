// SPDX-License-Identifier: Apache-2.0
#include "render/video_io.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>

#include "base/atomic_file.h"
#include "tests/render/video_test_util.h"

namespace lorgnette {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

// Smooth pictures through 4:2:0 H.264 at crf 16: rounding of RGB to YUV and back leaves about 0.7
// code values on average, the quantiser about as much again in pictures this small.
constexpr double kEncodedMean = 2;

TEST_F(VideoTest, ImageSequenceKeepsEveryPixel) {
  auto reader = Sequence(33, 21, 3);
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_EQ(reader->info().frame_count, 3);
  EXPECT_FALSE(reader->info().is_still);
  ASSERT_TRUE(Copy(Path("frame_%04d.png"), Path("out_%03d.png")));
  const auto frames = ReadAll(Path("out_%03d.png"));
  ASSERT_TRUE(frames) << frames.error().message;
  ASSERT_EQ(frames->size(), 3u);
  EXPECT_TRUE(std::filesystem::exists(Path("out_001.png")));
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ((*frames)[i].rgb.data, Picture(33, 21, i).data);
    EXPECT_EQ((*frames)[i].pts, i);
  }
}

TEST_F(VideoTest, SequenceWithAGapNamesTheMissingFile) {
  ASSERT_TRUE(Sequence(8, 8, 3));
  std::filesystem::remove(Path("frame_0002.png"));
  const auto reader = VideoReader::Open(Path("frame_%04d.png"));
  ASSERT_FALSE(reader);
  EXPECT_THAT(reader.error().message, StartsWith(Path("frame_0002.png") + ": is missing"));
}

TEST_F(VideoTest, SequenceStartsAtItsLowestNumberAndKeepsIt) {
  ASSERT_TRUE(Sequence(8, 8, 4));
  std::filesystem::remove(Path("frame_0001.png"));
  std::filesystem::remove(Path("frame_0002.png"));
  ASSERT_TRUE(Copy(Path("frame_%04d.png"), Path("out_%d.png")));
  EXPECT_TRUE(std::filesystem::exists(Path("out_3.png")));
  EXPECT_TRUE(std::filesystem::exists(Path("out_4.png")));
  EXPECT_FALSE(std::filesystem::exists(Path("out_1.png")));
}

TEST_F(VideoTest, FramesOfDifferentSizeAreAnError) {
  ASSERT_TRUE(Sequence(8, 8, 2));
  ASSERT_TRUE(WritePicture(Picture(10, 8, 0), Path("frame_0003.png")));
  const auto frames = ReadAll(Path("frame_%04d.png"));
  ASSERT_FALSE(frames);
  EXPECT_THAT(frames.error().message, HasSubstr("got 10x8 pixels, want 8x8"));
}

TEST_F(VideoTest, VideoKeepsFramesSizeRateAndColour) {
  ASSERT_TRUE(Sequence(64, 48, 30));
  ASSERT_TRUE(Copy(Path("frame_%04d.png"), Path("out.mp4")));
  const auto reader = VideoReader::Open(Path("out.mp4"));
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_EQ(reader->info().width, 64);
  EXPECT_EQ(reader->info().height, 48);
  EXPECT_DOUBLE_EQ(reader->info().frame_rate, 25);
  EXPECT_EQ(reader->info().frame_count, 30);
  EXPECT_FALSE(reader->info().has_audio);
  const auto frames = ReadAll(Path("out.mp4"));
  ASSERT_TRUE(frames) << frames.error().message;
  ASSERT_EQ(frames->size(), 30u);
  for (int i = 0; i < 30; ++i) {
    EXPECT_LT(Compare((*frames)[i].rgb, Picture(64, 48, i)).mean, kEncodedMean) << i;
    EXPECT_DOUBLE_EQ((*frames)[i].time_s, i / 25.0);
  }
}

TEST_F(VideoTest, OddSizesAreKept) {
  for (const auto& [width, height] : {std::pair{65, 48}, std::pair{64, 49}, std::pair{33, 35}}) {
    const std::string name = Path("odd" + std::to_string(width) + ".mp4");
    ASSERT_TRUE(Sequence(width, height, 2));
    const Status copied = Copy(Path("frame_%04d.png"), name);
    ASSERT_TRUE(copied) << copied.error().message;
    const auto frames = ReadAll(name);
    ASSERT_TRUE(frames) << frames.error().message;
    EXPECT_EQ(frames->front().rgb.width, width);
    EXPECT_EQ(frames->front().rgb.height, height);
    EXPECT_LT(Compare(frames->front().rgb, Picture(width, height, 0)).mean, kEncodedMean);
  }
}

TEST_F(VideoTest, OneFrameMakesAVideoAndAnImage) {
  ASSERT_TRUE(WritePicture(Picture(32, 32, 1), Path("in.png")));
  for (const char* name : {"out.mp4", "out.mkv", "out.mov", "out.png", "out.jpg"}) {
    const Status copied = Copy(Path("in.png"), Path(name));
    ASSERT_TRUE(copied) << copied.error().message;
    const auto frames = ReadAll(Path(name));
    ASSERT_TRUE(frames) << frames.error().message;
    ASSERT_EQ(frames->size(), 1u);
    EXPECT_LT(Compare(frames->front().rgb, Picture(32, 32, 1)).mean, kEncodedMean) << name;
  }
  EXPECT_EQ(ReadAll(Path("out.png"))->front().rgb.data, Picture(32, 32, 1).data);
}

TEST_F(VideoTest, IrregularTimeStampsAreKeptExactly) {
  auto source = Sequence(32, 32, 1);
  ASSERT_TRUE(source);
  const std::vector<long long> stamps = {3, 4, 9, 10, 11, 40, 42, 100};
  for (const char* name : {"out.mp4", "out.mkv"}) {
    auto writer = VideoWriter::Create(Path(name), *source);
    ASSERT_TRUE(writer);
    for (const long long stamp : stamps) {
      VideoFrame frame;
      frame.rgb = Picture(32, 32, static_cast<int>(stamp));
      frame.pts = stamp;
      ASSERT_TRUE(writer->Write(frame));
    }
    ASSERT_TRUE(writer->Finish());
    const auto frames = ReadAll(Path(name));
    ASSERT_TRUE(frames);
    ASSERT_EQ(frames->size(), stamps.size());
    for (std::size_t i = 0; i < stamps.size(); ++i) {
      // 1/25 s is a whole number of mp4's 1/12800 s and of mkv's 1/1000 s.
      EXPECT_DOUBLE_EQ((*frames)[i].time_s, static_cast<double>(stamps[i]) / 25) << name;
    }
    // A copy of the copy has its own time base, and the same times.
    ASSERT_TRUE(Copy(Path(name), Path("copy.mp4")));
    const auto copies = ReadAll(Path("copy.mp4"));
    ASSERT_TRUE(copies);
    ASSERT_EQ(copies->size(), stamps.size());
    for (std::size_t i = 0; i < stamps.size(); ++i) {
      EXPECT_DOUBLE_EQ((*copies)[i].time_s, (*frames)[i].time_s);
    }
  }
}

TEST_F(VideoTest, PartOfAClipCanStartAtZero) {
  ASSERT_TRUE(Sequence(32, 32, 10));
  ASSERT_TRUE(Copy(Path("frame_%04d.png"), Path("in.mp4")));
  auto reader = VideoReader::Open(Path("in.mp4"));
  auto writer = VideoWriter::Create(Path("out.mp4"), *reader, {.start_at_first_frame = true});
  ASSERT_TRUE(writer);
  for (int i = 0; i < 10; ++i) {
    const auto frame = reader->Next();
    ASSERT_TRUE(frame && *frame);
    if (i >= 4 && i < 7) {
      ASSERT_TRUE(writer->Write(**frame));
    }
  }
  ASSERT_TRUE(writer->Finish());
  const auto frames = ReadAll(Path("out.mp4"));
  ASSERT_TRUE(frames);
  ASSERT_EQ(frames->size(), 3u);
  EXPECT_DOUBLE_EQ(frames->front().time_s, 0);
  EXPECT_DOUBLE_EQ(frames->back().time_s, 2 / 25.0);
}

TEST_F(VideoTest, UntouchedPixelsAreEncodedFromTheDecodedSamples) {
  ASSERT_TRUE(Sequence(64, 48, 8));
  ASSERT_TRUE(Copy(Path("frame_%04d.png"), Path("in.mp4")));
  ASSERT_TRUE(Copy(Path("in.mp4"), Path("out.mp4")));
  const auto in = ReadAll(Path("in.mp4")), out = ReadAll(Path("out.mp4"));
  ASSERT_TRUE(in && out);
  for (std::size_t i = 0; i < in->size(); ++i) {
    // Only the second quantisation is left: within one code value on average.
    EXPECT_LT(Compare((*in)[i].rgb, (*out)[i].rgb).mean, 1.0) << i;
  }
}

TEST_F(VideoTest, UnfinishedOutputLeavesNothing) {
  ASSERT_TRUE(WritePicture(Picture(32, 32, 0), Path("in.png")));
  auto reader = VideoReader::Open(Path("in.png"));
  ASSERT_TRUE(reader);
  for (const char* name : {"out.mp4", "out_%03d.png"}) {
    auto writer = VideoWriter::Create(Path(name), *reader);
    ASSERT_TRUE(writer);
    VideoFrame frame;
    frame.rgb = Picture(32, 32, 0);
    ASSERT_TRUE(writer->Write(frame));
  }
  EXPECT_EQ(FilesHere(), 1);  // in.png
}

TEST_F(VideoTest, MissingBrokenAndForeignFilesGiveASentence) {
  ASSERT_TRUE(WriteFileAtomically(Path("text.mp4"), "this is no video"));
  ASSERT_TRUE(WriteFileAtomically(Path("empty.mp4"), ""));
  ASSERT_TRUE(WriteFileAtomically(Path("text.png"), "this is no picture"));
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"none.mp4", "none.mp4: cannot be read: No such file or directory"},
      {"none.png", "none.png: cannot be read: No such file or directory"},
      {"none_%d.png", "none_%d.png: no file matches this pattern"},
      {"text.mp4", "text.mp4: cannot be read: broken data, or no video"},
      {"empty.mp4", "empty.mp4: cannot be read: broken data, or no video"},
      {"text.png", "text.png: not a picture, want PNG, JPEG, BMP, TIFF or WebP"},
      {".", ".: is a folder, want a file"},
  };
  for (const auto& [name, sentence] : cases) {
    const auto reader = VideoReader::Open(Path(name));
    ASSERT_FALSE(reader) << name;
    EXPECT_EQ(reader.error().message, folder_ + "/" + sentence);
    EXPECT_EQ(reader.error().kind, ErrorKind::kFailure);
  }
}

TEST_F(VideoTest, FileCutBeforeItsIndexIsAnError) {
  ASSERT_TRUE(Sequence(64, 48, 40));
  ASSERT_TRUE(Copy(Path("frame_%04d.png"), Path("whole.mp4")));
  const auto bytes = ReadFile(Path("whole.mp4"));
  ASSERT_TRUE(bytes);
  ASSERT_TRUE(WriteFileAtomically(Path("cut.mp4"), bytes->substr(0, bytes->size() / 2)));
  const auto reader = VideoReader::Open(Path("cut.mp4"));
  ASSERT_FALSE(reader);
  EXPECT_EQ(reader.error().message, Path("cut.mp4") + ": cannot be read: broken data, or no video");
}

TEST_F(VideoTest, WrongOutputNamesAreUsageErrors) {
  ASSERT_TRUE(Sequence(16, 16, 2));
  const auto reader = VideoReader::Open(Path("frame_%04d.png"));
  ASSERT_TRUE(reader);
  const auto single = VideoWriter::Create(Path("one.png"), *reader);
  ASSERT_FALSE(single);
  EXPECT_EQ(single.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(single.error().message, HasSubstr("one image cannot hold the video"));
  const auto unknown = VideoWriter::Create(Path("out.avi"), *reader);
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(unknown.error().message, HasSubstr("out.avi: unknown output format, want .mp4"));
  const auto no_folder = VideoWriter::Create(Path("none/out.mp4"), *reader);
  ASSERT_FALSE(no_folder);
  EXPECT_THAT(no_folder.error().message, HasSubstr("cannot be written: no folder"));
}

// Lowers the greatest file size for a scope: writing past it fails as on a full disk (EFBIG).
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST_F(VideoTest, FullDiskIsASentenceAndLeavesNoFile) {
  ASSERT_TRUE(Sequence(256, 256, 30));
  for (const char* name : {"out.mp4", "out.mkv", "out_%04d.png"}) {
    Status copied;
    {
      const FullDisk full(300);
      copied = Copy(Path("frame_%04d.png"), Path(name));
    }
    ASSERT_FALSE(copied) << name;
    EXPECT_THAT(copied.error().message, HasSubstr("cannot be written: File too large"));
    EXPECT_THAT(copied.error().message, StartsWith(Path("out")));
  }
  EXPECT_EQ(FilesHere(), 30);  // the input
}

}  // namespace
}  // namespace lorgnette
