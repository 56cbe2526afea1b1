// SPDX-License-Identifier: Apache-2.0
#include "optics/media.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lorgnette {
namespace {

using testing::HasSubstr;

// Cauchy's A and B (um^2) as the reference has them.
TEST(Media, HaveTheReferencesDispersion) {
  struct Row {
    const char* name;
    double a, b;
  };
  for (const Row& row : {Row{"CR-39", 1.484976, 0.004496}, Row{"crown glass", 1.509462, 0.004674},
                         Row{"polycarbonate", 1.556371, 0.010229}, Row{"1.60", 1.572024, 0.007587},
                         Row{"1.67", 1.628715, 0.010801}, Row{"1.74", 1.698353, 0.011616}}) {
    const Medium medium = FindMedium(row.name)->medium;
    for (const double nm : {450.0, 546.07, 587.56, 650.0}) {
      const double um = nm / 1000;
      // A and B are printed to 1e-6: at 450 nm that allows 0.5e-6 (1 + 1 / 0.2).
      EXPECT_NEAR(IndexAt(medium, nm), row.a + row.b / (um * um), 3e-6) << row.name << " " << nm;
    }
  }
}

TEST(Media, DefineTheAbbeNumberTheyState) {
  for (const MediumEntry& entry : StandardMedia()) {
    const Medium& m = entry.medium;
    const double v = (IndexAt(m, kLineD_nm) - 1) / (IndexAt(m, kLineF_nm) - IndexAt(m, kLineC_nm));
    EXPECT_NEAR(v, m.abbe, 1e-10);
    EXPECT_EQ(IndexAt(m, kLineD_nm), m.index_d);
  }
}

// The trade names are indices at the e line.
TEST(Media, TradeNamesAreIndicesAtTheELine) {
  EXPECT_NEAR(IndexAt(FindMedium("1.60")->medium, kLineE_nm), 1.60, 3e-3);
  EXPECT_NEAR(IndexAt(FindMedium("1.67")->medium, kLineE_nm), 1.67, 6e-3);
  EXPECT_NEAR(IndexAt(FindMedium("1.74")->medium, kLineE_nm), 1.74, 4e-3);
}

TEST(Media, AreFoundByAlias) {
  EXPECT_EQ(FindMedium("cr39")->medium.name, "CR-39");
  EXPECT_EQ(FindMedium("Poly")->medium.name, "polycarbonate");
  EXPECT_EQ(FindMedium("1.6")->medium.name, "1.60");
  EXPECT_EQ(FindMedium("MR-8")->medium.name, "1.60");
  EXPECT_THAT(FindMedium("diamond").error().message, HasSubstr("want one of CR-39, crown glass"));
}

TEST(MakeMedium, TakesEitherReferenceLine) {
  const Medium d = *MakeMedium("own", 1.6, 40, 1.3);
  const Medium e = *MakeMediumFromE("own", IndexAt(d, kLineE_nm), 40, 1.3);
  EXPECT_NEAR(e.index_d, 1.6, 1e-14);
  EXPECT_FALSE(MakeMedium("air", 1, 40, 1.3));
  EXPECT_FALSE(MakeMedium("odd", 1.5, 4, 1.3));
}

}  // namespace
}  // namespace lorgnette
