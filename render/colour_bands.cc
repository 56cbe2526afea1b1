// SPDX-License-Identifier: Apache-2.0
#include "render/colour_bands.h"

#include "base/check.h"

namespace lorgnette {

std::vector<ColourBand> ColourBands(int wavelengths) {
  LG_CHECK_EQ(wavelengths % 3, 0);
  constexpr double kBand_nm = 50;  // width of a channel's band when it takes several
  const int each = wavelengths / 3;
  std::vector<ColourBand> bands;
  for (int channel = 0; channel < 3; ++channel) {
    for (int k = 0; k < each; ++k) {
      bands.push_back({channel, kChannel_nm[channel] + kBand_nm * ((k + 0.5) / each - 0.5)});
    }
  }
  return bands;
}

}  // namespace lorgnette
