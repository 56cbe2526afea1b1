// SPDX-License-Identifier: Apache-2.0
// Properties that come with real videos: sound, rotation, colour tags. The sources are made by the
// ffmpeg program; without it these tests are skipped.
extern "C" {
#include <libavformat/avformat.h>
#include <libavutil/imgutils.h>
#include <libavutil/pixdesc.h>
}

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/atomic_file.h"
#include "render/video_av.h"
#include "render/video_pixels.h"
#include "tests/render/video_test_util.h"

namespace lorgnette {
namespace {

#define SKIP_WITHOUT_FFMPEG() \
  if (!HasFfmpeg()) GTEST_SKIP() << "needs the ffmpeg program to make its input"

// Payloads of the sound packets of a file, with their times in seconds.
struct SoundPacket {
  std::string bytes;
  double time_s = 0;
};
std::vector<SoundPacket> SoundPackets(const std::string& path) {
  const auto input = av::OpenInput(path);
  EXPECT_TRUE(input);
  std::vector<SoundPacket> packets;
  const av::Packet packet(av_packet_alloc());
  while (input && av_read_frame(input->get(), packet.get()) >= 0) {
    const AVStream* stream = (*input)->streams[packet->stream_index];
    if (stream->codecpar->codec_type == AVMEDIA_TYPE_AUDIO) {
      packets.push_back({std::string(reinterpret_cast<char*>(packet->data), packet->size),
                         static_cast<double>(packet->pts) * av_q2d(stream->time_base)});
    }
    av_packet_unref(packet.get());
  }
  return packets;
}

TEST_F(VideoTest, SoundIsCopiedPacketByPacket) {
  SKIP_WITHOUT_FFMPEG();
  ASSERT_TRUE(
      Ffmpeg("-f lavfi -i testsrc=s=64x48:d=2 -f lavfi -i sine=d=2 -pix_fmt yuv420p "
             "-c:v libx264 -c:a aac in.mp4"));
  ASSERT_TRUE(Copy(Path("in.mp4"), Path("out.mp4")));
  const auto in = SoundPackets(Path("in.mp4")), out = SoundPackets(Path("out.mp4"));
  ASSERT_GT(in.size(), 50u);
  ASSERT_EQ(in.size(), out.size());
  for (std::size_t i = 0; i < in.size(); ++i) {
    EXPECT_EQ(in[i].bytes, out[i].bytes);
    EXPECT_DOUBLE_EQ(in[i].time_s, out[i].time_s);
  }
}

TEST_F(VideoTest, SoundOfAPartStartsWithIt) {
  SKIP_WITHOUT_FFMPEG();
  ASSERT_TRUE(
      Ffmpeg("-f lavfi -i testsrc=s=64x48:d=2 -f lavfi -i sine=d=2 -pix_fmt yuv420p "
             "-c:v libx264 -c:a aac in.mp4"));
  auto reader = VideoReader::Open(Path("in.mp4"));
  ASSERT_TRUE(reader);
  auto writer = VideoWriter::Create(Path("out.mp4"), *reader, {.start_at_first_frame = true});
  ASSERT_TRUE(writer);
  for (int i = 0; i < 40; ++i) {
    const auto frame = reader->Next();
    ASSERT_TRUE(frame && *frame);
    if (i >= 10 && i < 20) {
      ASSERT_TRUE(writer->Write(**frame));
    }
  }
  ASSERT_TRUE(writer->Finish());
  // Frames 10..19 of 25 a second: 0.4 s from 0.4 s on, in packets of 1024/44100 s = 0.0232 s.
  const auto sound = SoundPackets(Path("out.mp4"));
  EXPECT_EQ(sound.size(), 17u);
  EXPECT_GE(sound.front().time_s, 0);
  EXPECT_LT(sound.front().time_s, 1024.0 / 44100);
}

TEST_F(VideoTest, SoundThatTheContainerCannotHoldIsAUsageError) {
  SKIP_WITHOUT_FFMPEG();
  ASSERT_TRUE(
      Ffmpeg("-f lavfi -i testsrc=s=64x48:d=1 -f lavfi -i sine=d=1 -pix_fmt yuv420p "
             "-c:v libx264 -c:a pcm_s16le in.mov"));
  const Status copied = Copy(Path("in.mov"), Path("out.mp4"));
  ASSERT_FALSE(copied);
  EXPECT_EQ(copied.error().kind, ErrorKind::kUsage);
  EXPECT_EQ(copied.error().message, Path("out.mp4") + ": this container cannot hold the sound " +
                                        "(pcm_s16le) of " + Path("in.mov") + ", want .mkv or .mov");
  EXPECT_TRUE(Copy(Path("in.mov"), Path("out.mov")));
}

TEST_F(VideoTest, RotationIsAppliedToTheFramesAndKeptInTheFile) {
  SKIP_WITHOUT_FFMPEG();
  ASSERT_TRUE(WritePicture(Picture(64, 48, 0), Path("in.png")));
  ASSERT_TRUE(Ffmpeg("-loop 1 -i in.png -frames:v 3 -pix_fmt yuv420p -crf 5 flat.mp4"));
  const auto upright = ReadAll(Path("flat.mp4"));
  ASSERT_TRUE(upright);
  for (const int turn : {90, 180, 270}) {
    ASSERT_TRUE(
        Ffmpeg("-i flat.mp4 -c copy -metadata:s:v rotate=" + std::to_string(turn) + " turned.mp4"));
    const auto turned = ReadAll(Path("turned.mp4"));
    ASSERT_TRUE(turned);
    const ImageRgb8& a = upright->front().rgb;
    const ImageRgb8& b = turned->front().rgb;
    ASSERT_EQ(b.width, turn == 180 ? 64 : 48);
    ASSERT_EQ(b.height, turn == 180 ? 48 : 64);
    // What ffmpeg shows of the file, turned by itself.
    ASSERT_TRUE(Ffmpeg("-i turned.mp4 -frames:v 1 shown.png"));
    const auto shown = ReadPicture(Path("shown.png"));
    ASSERT_TRUE(shown);
    EXPECT_LT(Compare(b, *shown).mean, 2.0);  // its own chroma filter
    EXPECT_NE(a.data, b.data);
    ASSERT_TRUE(Copy(Path("turned.mp4"), Path("out.mp4")));
    const auto out = ReadAll(Path("out.mp4"));
    ASSERT_TRUE(out);
    EXPECT_LT(Compare(out->front().rgb, b).mean, 1.0);
    const auto input = av::OpenInput(Path("out.mp4"));
    ASSERT_TRUE(input);
    EXPECT_EQ((*input)->streams[0]->codecpar->width, 64);
    EXPECT_FALSE(OrientationOf(*(*input)->streams[0]).is_upright());
  }
}

TEST_F(VideoTest, FileCutBehindItsIndexNamesTheTimeReached) {
  SKIP_WITHOUT_FFMPEG();
  ASSERT_TRUE(
      Ffmpeg("-f lavfi -i testsrc=s=64x48:d=4 -pix_fmt yuv420p -c:v libx264 "
             "-movflags faststart in.mp4"));
  const auto bytes = ReadFile(Path("in.mp4"));
  ASSERT_TRUE(bytes);
  ASSERT_TRUE(WriteFileAtomically(Path("cut.mp4"), bytes->substr(0, bytes->size() * 3 / 4)));
  const auto frames = ReadAll(Path("cut.mp4"));
  ASSERT_FALSE(frames);
  EXPECT_THAT(frames.error().message,
              testing::MatchesRegex(Path("cut.mp4") + ": is cut short or broken at [0-9.]+ s .*"));
}

struct ColourCase {
  const char* tag;
  double kr, kb;
  bool full;
};

// Flat fields of known Y, Cb, Cr, stored without loss, against the closed form of the standards.
class VideoColour : public VideoTest, public testing::WithParamInterface<ColourCase> {
 protected:
  static constexpr int kFields[][3] = {
      {81, 100, 160}, {150, 120, 110}, {60, 160, 120}, {180, 128, 128}};

  // One frame a field.
  bool WriteFields(const std::string& pixel_format, int chroma_side) {
    constexpr int kSide = 16;
    std::string raw;
    for (const auto& field : kFields) {
      for (int k = 0; k < 3; ++k) {
        const int side = k == 0 ? kSide : chroma_side;
        raw.append(std::size_t(side) * std::size_t(side), static_cast<char>(field[k]));
      }
    }
    return WriteFileAtomically(Path("in.yuv"), raw) &&
           Ffmpeg("-f rawvideo -pix_fmt " + pixel_format +
                  " -s 16x16 -i in.yuv -c:v ffv1 -color_range " +
                  std::string(GetParam().full ? "pc" : "tv") + " -colorspace " + GetParam().tag +
                  " in.mkv");
  }

  void ExpectFields(const std::vector<VideoFrame>& frames, double within);
};

void VideoColour::ExpectFields(const std::vector<VideoFrame>& frames, double within) {
  const ColourCase& c = GetParam();
  ASSERT_EQ(frames.size(), std::size(kFields));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double y = c.full ? kFields[i][0] / 255.0 : (kFields[i][0] - 16) / 219.0;
    const double cb = (kFields[i][1] - 128) / (c.full ? 255.0 : 224.0);
    const double cr = (kFields[i][2] - 128) / (c.full ? 255.0 : 224.0);
    const double r = y + 2 * (1 - c.kr) * cr;
    const double b = y + 2 * (1 - c.kb) * cb;
    const double g = (y - c.kr * r - c.kb * b) / (1 - c.kr - c.kb);
    const std::uint8_t* p = frames[i].rgb.at(5, 5);
    EXPECT_NEAR(p[0], 255 * r, within) << i;
    EXPECT_NEAR(p[1], 255 * g, within) << i;
    EXPECT_NEAR(p[2], 255 * b, within) << i;
  }
}

TEST_P(VideoColour, QuickReadingHonoursTheTagsToo) {
  SKIP_WITHOUT_FFMPEG();
  ASSERT_TRUE(WriteFields("yuv420p", 8));
  auto reader = VideoReader::Open(Path("in.mkv"), {.exact_colours = false});
  ASSERT_TRUE(reader);
  std::vector<VideoFrame> frames;
  while (true) {
    auto frame = reader->Next();
    ASSERT_TRUE(frame);
    if (!*frame) break;
    frames.push_back(**std::move(frame));
  }
  ExpectFields(frames, 3.0);
}

TEST_P(VideoColour, MatrixAndRangeOfTheTagsAreHonoured) {
  SKIP_WITHOUT_FFMPEG();
  ASSERT_TRUE(WriteFields("yuv444p", 16));
  const auto frames = ReadAll(Path("in.mkv"));
  ASSERT_TRUE(frames) << frames.error().message;
  // Half a code of rounding, and less than half of swscale's 13-bit coefficients.
  ExpectFields(*frames, 1.0);
  // The tags survive a copy, and the colours with them.
  ASSERT_TRUE(Copy(Path("in.mkv"), Path("out.mkv")));
  const auto in = av::OpenInput(Path("in.mkv")), out = av::OpenInput(Path("out.mkv"));
  ASSERT_TRUE(in && out);
  const AVCodecParameters& from = *(*in)->streams[0]->codecpar;
  const AVCodecParameters& to = *(*out)->streams[0]->codecpar;
  EXPECT_EQ(to.color_space, from.color_space);
  EXPECT_EQ(to.color_range, from.color_range);
  const auto copies = ReadAll(Path("out.mkv"));
  ASSERT_TRUE(copies);
  for (std::size_t i = 0; i < copies->size(); ++i) {
    EXPECT_LE(Compare((*copies)[i].rgb, (*frames)[i].rgb).greatest, 3);  // crf 16, flat fields
  }
}

INSTANTIATE_TEST_SUITE_P(Tags, VideoColour,
                         testing::Values(ColourCase{"bt709", 0.2126, 0.0722, false},
                                         ColourCase{"bt709", 0.2126, 0.0722, true},
                                         ColourCase{"smpte170m", 0.299, 0.114, false},
                                         ColourCase{"bt470bg", 0.299, 0.114, true}),
                         [](const auto& parameter) {
                           return std::string(parameter.param.tag) +
                                  (parameter.param.full ? "Full" : "Limited");
                         });

TEST_F(VideoTest, QuickReadingFillsPicturesOfAnyWidth) {
  SKIP_WITHOUT_FFMPEG();
  for (const int width : {24, 36, 40, 48, 50}) {
    ASSERT_TRUE(Ffmpeg(fmt::format(
        "-f lavfi -i color=c=0x60a070:s={}x16:d=0.1 -pix_fmt yuv420p -c:v ffv1 in.mkv", width)));
    auto reader = VideoReader::Open(Path("in.mkv"), {.exact_colours = false});
    ASSERT_TRUE(reader);
    const auto frame = reader->Next();
    ASSERT_TRUE(frame && *frame);
    for (const std::uint8_t code : (*frame)->rgb.data) {
      ASSERT_GE(code, 0x5c) << width;
      ASSERT_LE(code, 0xa4) << width;
    }
  }
}

av::Frame MakeFrame(int width, int height, AVPixelFormat format, std::uint8_t value) {
  av::Frame frame = *av::NewFrame(width, height, format);
  for (const AVBufferRef* buffer : frame->buf) {
    if (buffer != nullptr) std::fill_n(buffer->data, buffer->size, value);
  }
  return frame;
}

// Planes of `frame` as rows of bytes, without the padding.
std::vector<std::string> PlaneRows(const AVFrame& frame) {
  std::vector<std::string> rows;
  for (int p = 0; p < 4 && frame.data[p] != nullptr; ++p) {
    const int width = av_image_get_linesize(AVPixelFormat(frame.format), frame.width, p);
    const AVPixFmtDescriptor* d = av_pix_fmt_desc_get(AVPixelFormat(frame.format));
    const int height =
        p == 1 || p == 2 ? AV_CEIL_RSHIFT(frame.height, d->log2_chroma_h) : frame.height;
    for (int y = 0; y < height; ++y) {
      rows.emplace_back(reinterpret_cast<const char*>(frame.data[p] + y * frame.linesize[p]),
                        std::size_t(width));
    }
  }
  return rows;
}

TEST(PlanesFromRgbTest, GivesTheSamplesOfUnchangedPixelsBackAndTheOthersAsInTheWholePicture) {
  constexpr int kWidth = 22, kHeight = 310;
  ImageRgb8 edited(kWidth, kHeight);
  for (std::size_t i = 0; i < edited.data.size(); ++i) edited.data[i] = std::uint8_t(i * 7919 >> 4);
  for (const AVPixelFormat format : {AV_PIX_FMT_YUV420P, AV_PIX_FMT_YUV422P, AV_PIX_FMT_YUV444P,
                                     AV_PIX_FMT_NV12, AV_PIX_FMT_YUV420P10}) {
    auto planes = PlanesFromRgb::Create(kWidth, kHeight, format, {});
    ASSERT_TRUE(planes);
    const av::Frame original = MakeFrame(kWidth, kHeight, format, 77);
    const av::Frame whole = MakeFrame(kWidth, kHeight, format, 0);
    planes->Fill(edited, *whole);
    const auto plain = PlaneRows(*whole);
    for (const auto& [first, last] :
         {std::pair(0, 0), std::pair(3, 6), std::pair(133, 171), std::pair(309, 309),
          std::pair(250, 308), std::pair(1, 309), std::pair(5, 4)}) {
      ImageRgb8 decoded = edited;
      for (int y = first; y <= last; ++y) decoded.at(6, y)[1] ^= 1;
      const av::Frame frame = MakeFrame(kWidth, kHeight, format, 11);
      planes->FillEdited(edited, decoded, *original, *frame);
      const auto rows = PlaneRows(*frame);
      const AVPixFmtDescriptor* d = av_pix_fmt_desc_get(format);
      const int bytes = d->comp[0].step;
      ASSERT_EQ(rows.size(), plain.size());
      for (std::size_t r = 0; r < rows.size(); ++r) {
        const bool chroma = r >= kHeight;
        const int chroma_rows = AV_CEIL_RSHIFT(kHeight, d->log2_chroma_h);
        const int y = chroma ? int(r - kHeight) % chroma_rows : int(r);
        const int shift = chroma ? d->log2_chroma_h : 0;
        const bool touched = first <= last && y >= first >> shift && y <= last >> shift;
        // The touched column's sample: NV12 keeps two in one.
        const int sample = chroma ? d->comp[1].step : bytes;
        const int at = (chroma ? 6 >> d->log2_chroma_w : 6) * sample;
        std::string expected(rows[r].size(), char(77));
        if (touched) expected.replace(at, sample, plain[r].substr(at, sample));
        ASSERT_EQ(rows[r], expected) << av_get_pix_fmt_name(format) << ' ' << first << ' ' << r;
      }
    }
  }
}

TEST(PlanesFromRgbTest, OtherFormatsAreConvertedWhole) {
  ImageRgb8 image(4, 4);
  std::fill(image.data.begin(), image.data.end(), std::uint8_t{200});
  auto planes = PlanesFromRgb::Create(4, 4, AV_PIX_FMT_YUV420P, {});
  ASSERT_TRUE(planes);
  const av::Frame original = MakeFrame(4, 4, AV_PIX_FMT_YUV444P, 77);
  const av::Frame frame = MakeFrame(4, 4, AV_PIX_FMT_YUV420P, 11);
  const av::Frame whole = MakeFrame(4, 4, AV_PIX_FMT_YUV420P, 11);
  planes->FillEdited(image, image, *original, *frame);
  planes->Fill(image, *whole);
  EXPECT_EQ(PlaneRows(*frame), PlaneRows(*whole));
  EXPECT_NE(frame->data[0][0], 77);
}

TEST(Oriented, QuarterTurnsComposeToTheIdentity) {
  ImageRgb8 image(3, 2);
  for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = static_cast<std::uint8_t>(i);
  for (const Orientation o :
       {Orientation{0, -1, 1, 0}, Orientation{0, 1, -1, 0}, Orientation{-1, 0, 0, -1},
        Orientation{0, 1, 1, 0}, Orientation{-1, 0, 0, 1}}) {
    EXPECT_EQ(Oriented(Oriented(image, o), o.Inverse()).data, image.data);
    EXPECT_NE(Oriented(image, o).data, image.data);
  }
}

}  // namespace
}  // namespace lorgnette
