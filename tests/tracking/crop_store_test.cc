// SPDX-License-Identifier: Apache-2.0
#include "tracking/crop_store.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace lorgnette {
namespace {

Image<std::uint8_t, 1> Numbered(int number, int width, int height) {
  Image<std::uint8_t, 1> grey(width, height);
  for (std::size_t i = 0; i < grey.data.size(); ++i) {
    grey.data[i] = std::uint8_t((std::size_t(number) * 31 + i * 7) % 251);
  }
  return grey;
}

class CropStoreRoom : public testing::TestWithParam<std::size_t> {};

TEST_P(CropStoreRoom, GivesBackWhatWasKept) {
  CropStore store(GetParam());
  const auto side = [](int i) { return 16 + i % 5; };  // pictures may differ in size
  constexpr int kPictures = 60;
  for (int i = 0; i < kPictures; ++i) {
    EXPECT_EQ(store.Keep(Numbered(i, side(i), 20)), std::size_t(i));
  }
  EXPECT_EQ(store.Keep({}), std::size_t(kPictures));  // no eye was seen
  const auto check = [&] {
    for (int i = kPictures - 1; i >= 0; --i) {
      const auto grey = store.Load(std::size_t(i));
      ASSERT_EQ(grey.width, side(i));
      ASSERT_EQ(grey.height, 20);
      ASSERT_EQ(grey.data, Numbered(i, side(i), 20).data);
    }
    EXPECT_TRUE(store.Load(kPictures).empty());
  };
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) threads.emplace_back(check);
  for (std::thread& thread : threads) thread.join();
}

INSTANTIATE_TEST_SUITE_P(, CropStoreRoom, testing::Values(0, 1000, 5000, CropStore::kInMemory));

}  // namespace
}  // namespace lorgnette
