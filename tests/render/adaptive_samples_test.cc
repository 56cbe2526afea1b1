// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive_samples.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace lorgnette {
namespace {

using Kind = CameraSample::Kind;

// Two columns of four pixels, the left ones of one sort and the right ones of another: whether the
// border between them is refined, on both sides alike.
bool IsRefined(const Glance& left, const Glance& right) {
  const PixelBox box{0, 0, 4, 2};
  const std::vector<Glance> glances = {left, left, right, right, left, left, right, right};
  const PixelFlags wanted = PixelsToRefine(box, box, glances);
  const auto at = [&](int x) { return wanted[TileIndex(x, 0)]; };
  EXPECT_EQ(at(1), at(2));
  EXPECT_EQ(at(0), left.edge);
  EXPECT_EQ(at(3), right.edge);
  return at(1);
}

Glance Seen(Kind kind, float light) {
  CameraSample sample;
  sample.kind = kind;
  sample.inserted.setConstant(light);
  sample.direct.setConstant(light);
  return Glance::At(sample, false);
}

TEST(PixelsToRefine, AreThoseBesideSomethingElse) {
  EXPECT_TRUE(IsRefined(Seen(Kind::kFrame, 0.2f), Seen(Kind::kHead, 1)));
  EXPECT_TRUE(IsRefined(Seen(Kind::kFrame, 0.2f), Seen(Kind::kLensToHead, 1)));
  EXPECT_TRUE(IsRefined(Seen(Kind::kLensToHead, 1), Seen(Kind::kLensToBackground, 1)));
  EXPECT_FALSE(IsRefined(Seen(Kind::kLensToHead, 1), Seen(Kind::kLensToHead, 0.1f)));
  EXPECT_FALSE(IsRefined(Seen(Kind::kFrame, 0.2f), Seen(Kind::kFrame, 0.205f)));
  EXPECT_TRUE(IsRefined(Seen(Kind::kFrame, 0.2f), Seen(Kind::kFrame, 0.3f)));
}

// The outline of the head shows the input on both sides of it.
TEST(PixelsToRefine, AreNotTheHeadsOutlineWhereItIsNotDarkened) {
  EXPECT_FALSE(IsRefined(Seen(Kind::kHead, 1), Seen(Kind::kBackground, 1)));
  EXPECT_FALSE(IsRefined(Seen(Kind::kHead, 0.99f), Seen(Kind::kBackground, 1)));
  EXPECT_TRUE(IsRefined(Seen(Kind::kHead, 0.8f), Seen(Kind::kBackground, 1)));
}

// Of what is left out nothing but its kind is known.
TEST(PixelsToRefine, AreThoseLeftOutAndWhatTurnsBesideThem) {
  CameraSample sample;
  sample.kind = Kind::kFrame;
  const Glance edge = Glance::At(sample, true);
  sample.inserted.setConstant(0.9f);
  const PixelBox box{0, 0, 2, 1};
  const auto wanted = [&](const Glance& beside) {
    const PixelFlags flags = PixelsToRefine(box, box, {edge, beside});
    EXPECT_TRUE(flags[TileIndex(0, 0)]);
    return flags[TileIndex(1, 0)];
  };
  EXPECT_FALSE(wanted(Glance::At(sample, false)));
  sample.turns = true;
  EXPECT_TRUE(wanted(Glance::At(sample, false)));
}

TEST(PlaceSamples, FillsWantedPixelsOnly) {
  const PixelBox area{16, 32, 25, 40};  // a tile cut by the picture's border
  PixelFlags wanted{};
  wanted[TileIndex(0, 0)] = wanted[TileIndex(8, 7)] = wanted[TileIndex(3, 5)] = true;
  std::vector<CameraSample> samples(7);
  PlaceSamples(area, 2, &wanted, samples);
  ASSERT_EQ(samples.size(), 12u);
  for (const CameraSample& s : samples) {
    EXPECT_TRUE(wanted[s.pixel]);
    EXPECT_EQ(s.pixel, TileIndex(int(s.x) - 16, int(s.y) - 32));
    EXPECT_EQ(s.kind, Kind::kBackground);
  }
  PlaceSamples(area, 1, nullptr, samples);
  EXPECT_EQ(samples.size(), 72u);
}

}  // namespace
}  // namespace lorgnette
