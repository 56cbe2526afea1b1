// SPDX-License-Identifier: Apache-2.0
#include "apps/render_journal.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace lorgnette {
namespace {

class RenderJournalTest : public testing::Test {
 protected:
  RenderJournalTest() {
    path_ =
        (std::filesystem::path(testing::TempDir()) /
         (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".resume"))
            .string();
    std::filesystem::remove(path_);
    for (std::size_t i = 0; i < input_.data.size(); ++i) input_.data[i] = std::uint8_t(i * 7);
  }
  ~RenderJournalTest() override { std::filesystem::remove(path_); }
  // The input with a block of other pixels.
  ImageRgb8 Drawn(int frame) const {
    ImageRgb8 image = input_;
    for (int y = 5; y < 9; ++y) {
      for (int x = 11 + frame; x < 20 + frame; ++x)
        image.at(x, y)[1] ^= std::uint8_t(x + frame + 1);
    }
    return image;
  }
  static FrameTally Tally(int frame) {
    FrameTally tally;
    tally.counts = {frame, 2L * frame, 3L * frame, 4L * frame};
    tally.effects = {1, 2, 7};
    return tally;
  }
  RenderJournal Open(std::uint64_t key = 42) const {
    auto journal = RenderJournal::Open(path_, key);
    EXPECT_TRUE(journal) << journal.error().message;
    return *std::move(journal);
  }
  void KeepFrames(int count) const {
    RenderJournal journal = Open();
    for (int i = 0; i < count; ++i) EXPECT_TRUE(journal.Keep(i, input_, Drawn(i), Tally(i)));
  }

  std::string path_;
  ImageRgb8 input_{48, 16};
};

TEST_F(RenderJournalTest, GivesBackWhatItKept) {
  KeepFrames(5);
  const RenderJournal again = Open();
  EXPECT_EQ(again.frames_kept(), 5);
  for (int i = 0; i < 5; ++i) {
    ImageRgb8 picture = input_;
    const auto tally = again.Restore(i, picture);
    ASSERT_TRUE(tally) << i;
    EXPECT_EQ(picture.data, Drawn(i).data);
    EXPECT_EQ(tally->counts.filled_samples, 4 * i);
    EXPECT_EQ(tally->effects, Tally(i).effects);
  }
  ImageRgb8 picture = input_;
  EXPECT_FALSE(again.Restore(5, picture));
}

TEST_F(RenderJournalTest, AFrameWithoutAChangeIsKeptToo) {
  RenderJournal journal = Open();
  ASSERT_TRUE(journal.Keep(3, input_, input_, {}));
  ImageRgb8 picture = input_;
  EXPECT_TRUE(journal.Restore(3, picture));
  EXPECT_EQ(picture.data, input_.data);
}

TEST_F(RenderJournalTest, DropsARecordThatWasCutShortAndGoesOn) {
  KeepFrames(3);
  const auto whole = std::filesystem::file_size(path_);
  for (const std::uintmax_t cut : {whole - 1, whole - 60}) {
    std::filesystem::resize_file(path_, cut);
    RenderJournal journal = Open();
    EXPECT_EQ(journal.frames_kept(), 2);
    ASSERT_TRUE(journal.Keep(2, input_, Drawn(2), Tally(2)));
    ImageRgb8 picture = input_;
    ASSERT_TRUE(journal.Restore(2, picture));
    EXPECT_EQ(picture.data, Drawn(2).data);
  }
  EXPECT_EQ(Open().frames_kept(), 3);
  EXPECT_EQ(std::filesystem::file_size(path_), whole);
}

TEST_F(RenderJournalTest, StopsAtADamagedRecord) {
  KeepFrames(4);
  std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(std::streamoff(std::filesystem::file_size(path_) / 2));
  file.put('!');
  file.put('?');
  file.close();
  EXPECT_LT(Open().frames_kept(), 4);
}

TEST_F(RenderJournalTest, AnotherRenderStartsAnew) {
  KeepFrames(3);
  EXPECT_EQ(Open(43).frames_kept(), 0);
}

TEST_F(RenderJournalTest, GoesWhenTheRenderIsDone) {
  RenderJournal journal = Open();
  EXPECT_TRUE(std::filesystem::exists(path_));
  journal.Remove();
  EXPECT_FALSE(std::filesystem::exists(path_));
}

TEST_F(RenderJournalTest, AFolderThatIsNotThereIsAnError) {
  EXPECT_FALSE(RenderJournal::Open("/nowhere/at/all.resume", 1));
}

}  // namespace
}  // namespace lorgnette
