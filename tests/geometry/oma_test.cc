// SPDX-License-Identifier: Apache-2.0
#include "geometry/oma.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "base/atomic_file.h"
#include "base/units.h"
#include "cmake/source_dir.h"
#include "geometry/closed_curve.h"
#include "geometry/frame_io.h"

namespace lorgnette {
namespace {

constexpr double kTraceStep_mm = 0.06;  // agreement asked of boxing values and circumference

std::string RoundTrace(int points, const char* eye) {
  std::string text = "JOB=7\r\nDBL=18.00\r\n_X=keep;me\r\nTRCFMT=1;" + std::to_string(points) +
                     ";E;" + eye + ";F\r\nR=";
  for (int k = 0; k < points; ++k) text += (k == 0 ? "" : ";") + std::to_string(2300);
  return text + "\r\n";
}

TEST(OmaFile, WritesBackTheSameBytesWithUnknownLabelsAndAnyLineEnd) {
  for (const std::string text : {"A=1\r\nB=2;3\r\n_VENDOR=x=y\r\n", "A=1\nB=2", "A=1\rB=\r",
                                 "\x1c"
                                 "A=1\r\n\x1e"
                                 "CRC=12\r\n\x1d"}) {
    const auto file = OmaFile::Parse(text, "t.oma");
    ASSERT_TRUE(file.has_value());
    EXPECT_EQ(file->Text(), text);
    EXPECT_EQ(file->Get("A"), "1");
  }
}

TEST(OmaFile, OneValueStandsForBothAndEmptyForNone) {
  const OmaFile file = *OmaFile::Parse("DBL=18\nSPH=;-2.5\nCYL=?;-1\nBAD=x\n", "t.oma");
  EXPECT_EQ(file.Numbers("DBL")->left, 18);
  EXPECT_EQ(file.Numbers("DBL")->right, 18);
  EXPECT_FALSE(file.Numbers("SPH")->right.has_value());
  EXPECT_EQ(file.Numbers("SPH")->left, -2.5);
  EXPECT_FALSE(file.Numbers("CYL")->right.has_value());
  EXPECT_FALSE(file.Numbers("NONE")->right.has_value());
  EXPECT_THAT(file.Numbers("BAD").error().message, testing::HasSubstr("t.oma:BAD"));
}

TEST(OmaFile, SetChangesItsOwnLineOnly) {
  OmaFile file = *OmaFile::Parse("A=1\r\nB=2\r\nC=3\r\n", "t.oma");
  file.Set("B", "20;21");
  file.Set("D", "4");
  EXPECT_EQ(file.Text(), "A=1\r\nB=20;21\r\nC=3\r\nD=4\r\n");
}

TEST(OmaFile, OneTraceGivesTheOtherEyeByMirroring) {
  const OmaFile file = *OmaFile::Parse(RoundTrace(360, "R"), "t.oma");
  const auto traces = file.Traces();
  ASSERT_TRUE(traces.has_value()) << traces.error().message;
  ASSERT_EQ(traces->size(), 2u);
  EXPECT_FALSE((*traces)[0].mirrored);
  EXPECT_TRUE((*traces)[1].mirrored);
  EXPECT_EQ((*traces)[1].eye, Eye::kLeft);
  EXPECT_NEAR(Perimeter((*traces)[1].contour_mm), 2 * kPi * 23, 0.01);
  EXPECT_GT(SignedArea((*traces)[1].contour_mm), 0);
}

TEST(OmaFile, RefusesWhatItCannotReadAndKeepsItsBytes) {
  const std::string packed = "TRCFMT=6;360;E;R;F\nR=6167514141\n";
  const OmaFile file = *OmaFile::Parse(packed, "t.oma");
  const auto traces = file.Traces();
  ASSERT_FALSE(traces.has_value());
  EXPECT_THAT(traces.error().message, testing::HasSubstr("format 6"));
  EXPECT_EQ(file.Text(), packed);
  const OmaFile shorter = *OmaFile::Parse("TRCFMT=1;10;E;R;F\nR=2300;2300\n", "t.oma");
  EXPECT_THAT(shorter.Traces().error().message, testing::HasSubstr("got 2 values, want 10"));
  const OmaFile wild = *OmaFile::Parse("TRCFMT=1;8;E;R;F\nR=1;1;1;1;1;1;1;1\n", "t.oma");
  EXPECT_THAT(wild.Traces().error().message, testing::HasSubstr("0.01 mm"));
  EXPECT_FALSE(OmaFile::Parse("no labels here", "t.oma").has_value());
}

TEST(OmaFile, EdgeThicknessComesBackToAHundredth) {
  OmaFile file = *OmaFile::Parse("A=1\nSTHKFMT=1;2;E;R\nT=0100;0200\nB=2\n", "t.oma");
  EXPECT_THAT(*file.EdgeThickness(Eye::kRight), testing::ElementsAre(1.0, 2.0));
  std::vector<double> thickness;
  for (int k = 0; k < 72; ++k) thickness.push_back(1 + 0.01 * k);
  file.SetEdgeThickness(Eye::kRight, thickness);
  const auto back = file.EdgeThickness(Eye::kRight);
  ASSERT_TRUE(back.has_value());
  EXPECT_THAT(*back, testing::Pointwise(testing::DoubleNear(0.005), thickness));
  EXPECT_THAT(file.Text(), testing::HasSubstr("A=1\nB=2\nSTHKFMT"));
  EXPECT_TRUE(file.EdgeThickness(Eye::kLeft)->empty());
}

TEST(OmaCurveDiopters, TakesALargeNumberForARadius) {
  EXPECT_EQ(OmaCurveDiopters(5.46), 5.46);
  EXPECT_NEAR(OmaCurveDiopters(85.68), 530 / 85.68, 1e-12);
}

TEST(FrameAroundTrace, HasTheTracesBoxing) {
  const auto text = ReadFile(DataDirectory() + "/frames/rectangle.json");
  ASSERT_TRUE(text.has_value());
  const FrameParameters style = *ParseFrameParameters(*text, "rectangle.json");
  const auto frame = FrameAroundTrace(*OmaFile::Parse(RoundTrace(400, "R"), "t.oma"), style);
  ASSERT_TRUE(frame.has_value()) << frame.error().message;
  EXPECT_NEAR(frame->boxing.a_mm, 46, kTraceStep_mm);
  EXPECT_NEAR(frame->boxing.b_mm, 46, kTraceStep_mm);
  EXPECT_EQ(frame->boxing.dbl_mm, 18);
  EXPECT_NEAR(frame->boxing.circumference_mm, 2 * kPi * 23, kTraceStep_mm);
}

TEST(OmaFile, RealTracesAgreeWithTheirOwnBoxingAndCircumference) {
  const std::string folder = LORGNETTE_SOURCE_DIR "/../shared/data/oma/";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder;
  int measured = 0;
  for (const char* name : {"R1000_1.oma", "R360_1.oma", "R360_3.oma", "STHKFMT.oma"}) {
    const auto bytes = ReadFile(folder + name);
    ASSERT_TRUE(bytes.has_value());
    const auto file = OmaFile::Parse(*bytes, name);
    ASSERT_TRUE(file.has_value());
    EXPECT_EQ(file->Text(), *bytes);
    const auto traces = file->Traces();
    ASSERT_TRUE(traces.has_value()) << traces.error().message;
    EXPECT_EQ(traces->size(), 2u);
    for (const OmaTrace& trace : *traces) {
      const Boxing boxing = MeasureContour(trace.contour_mm);
      for (const auto& [label, value] :
           {std::pair("HBOX", boxing.a_mm), std::pair("VBOX", boxing.b_mm),
            std::pair("CIRC", boxing.circumference_mm)}) {
        const auto stated = file->Numbers(label);
        ASSERT_TRUE(stated.has_value());
        const auto& one = trace.eye == Eye::kRight ? stated->right : stated->left;
        if (!one) continue;
        EXPECT_NEAR(value, *one, kTraceStep_mm) << name << " " << label;
        ++measured;
      }
    }
  }
  EXPECT_GE(measured, 10);
  const auto packed = OmaFile::Parse(*ReadFile(folder + "TRCFMT6.oma"), "TRCFMT6.oma");
  ASSERT_TRUE(packed.has_value());
  EXPECT_FALSE(packed->Traces().has_value());
  EXPECT_EQ(packed->Text(), *ReadFile(folder + "TRCFMT6.oma"));
}

}  // namespace
}  // namespace lorgnette
