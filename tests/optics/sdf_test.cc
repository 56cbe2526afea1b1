// SPDX-License-Identifier: Apache-2.0
#include "optics/sdf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lorgnette {
namespace {

using testing::HasSubstr;

Surface Torus() { return TorusSurface{1 / 60.0, 1 / 80.0, 0.5}; }

TEST(Sdf, RoundTripsWhateverTheOrderOfRowsAndTheSign) {
  for (int bits = 0; bits < 8; ++bits) {
    const SdfOptions options{bool(bits & 1), bool(bits & 2), bool(bits & 4)};
    const auto text = WriteSdf(Torus(), Eye::kLeft, SdfFace::kBack, 51, 41, 50, 60, options);
    ASSERT_TRUE(text);
    const auto parsed = ParseSdf(*text, "lens.sdf", options);
    ASSERT_TRUE(parsed) << parsed.error().message;
    ASSERT_EQ(parsed->size(), 1u);
    const SdfSurface& s = parsed->front();
    EXPECT_EQ(s.eye, Eye::kLeft);
    EXPECT_EQ(s.face, SdfFace::kBack);
    EXPECT_EQ(s.rows, 51);
    for (double x = -20; x <= 20; x += 5) {
      const auto a = Torus().Jet(x, 0.7 * x), b = s.surface.Jet(x, 0.7 * x);
      // Cubic spline on 1.25 mm nodes: 5/384 h^4 z4 for the sag and h^2/12 z4 for the second
      // derivative, z4 (fourth derivative) up to 3e-5 mm^-3 at 24 mm from the vertex.
      EXPECT_NEAR(a->z, b->z, 1e-6);
      EXPECT_NEAR(a->zxx, b->zxx, 5e-6);
    }
  }
}

// A surface that is not mirror-symmetric tells the vendors' orders apart.
TEST(Sdf, TellsRowAndColumnOrdersApart) {
  const auto text = WriteSdf(Torus(), Eye::kRight, SdfFace::kFront, 21, 21, 40, 40);
  SdfOptions flipped;
  flipped.columns_run_to_viewers_right = false;
  const Surface right = ParseSdf(*text, "a.sdf")->front().surface;
  const Surface wrong = ParseSdf(*text, "a.sdf", flipped)->front().surface;
  EXPECT_NEAR(right.Jet(10, 5)->z, wrong.Jet(-10, 5)->z, 1e-12);
  EXPECT_GT(std::abs(right.Jet(10, 5)->z - wrong.Jet(10, 5)->z), 0.01);
}

TEST(Sdf, NamesLineAndFieldOfWhatIsWrong) {
  const auto problem = [](const char* text) {
    const auto parsed = ParseSdf(text, "bad.sdf");
    return parsed ? std::string() : parsed.error().message;
  };
  EXPECT_THAT(problem("hello\n"), HasSubstr("bad.sdf: no SURFMT line"));
  EXPECT_THAT(problem("SURFMT=1;R;B;4;4;30;30;0\nZZ=0;0;0;0\n"),
              HasSubstr("bad.sdf:3: got 1 rows of sags, want 4"));
  EXPECT_THAT(problem("SURFMT=1;R;B;4;4;30;30;0\nZZ=0;0;0\n"), HasSubstr("got 3 sags, want 4"));
  EXPECT_THAT(problem("SURFMT=1;R;B;4;4;30;30;0\nZZ=0;0;x;0\n"), HasSubstr("got \"x\""));
  EXPECT_THAT(problem("SURFMT=1;R;Q;4;4;30;30;0\n"), HasSubstr("got face Q, want F or B"));
  EXPECT_THAT(problem("SURFMT=2;R;B;4;4;30;30;0\n"), HasSubstr("got format 2"));
  EXPECT_THAT(problem("SURFMT=1;R;B;4;9999999;30;30;0\n"), HasSubstr("got 9999999 nodes"));
}

TEST(Sdf, ReadsBothEyesOfOneFile) {
  const std::string both = *WriteSdf(Torus(), Eye::kRight, SdfFace::kBack, 11, 11, 40, 40) +
                           "\r\n" + *WriteSdf(Torus(), Eye::kLeft, SdfFace::kFront, 11, 11, 40, 40);
  const auto parsed = ParseSdf(both, "pair.sdf");
  ASSERT_TRUE(parsed);
  ASSERT_EQ(parsed->size(), 2u);
  EXPECT_EQ((*parsed)[1].face, SdfFace::kFront);
}

TEST(Sdf, RefusesToWriteBeyondTheSurface) {
  const auto text = WriteSdf(SphereSurface{1 / 20.0}, Eye::kRight, SdfFace::kBack, 11, 11, 50, 50);
  ASSERT_FALSE(text);
  EXPECT_THAT(text.error().message, HasSubstr("smaller grid"));
}

}  // namespace
}  // namespace lorgnette
